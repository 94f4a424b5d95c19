// SPDX-License-Identifier: MIT
// Whether it pays to put the rays of a bounce in another order, or those that go on side by side. Rays of the
// first bounces of a path from each pixel, in the order of pixels; sorted in several ways by the host, which
// is not timed; and with all but a share of them ended, as they lie and side by side. Every round runs every
// order in turn. ray_order_bench [--scenes builtin:room,...] [--devices cpu,llvmpipe] [--size 512] [--rounds
// N]
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>
#include <random>

#include "lodestone/layout/objects.h"
#include "lodestone/test_support/bench_main.h"
#include "lodestone/test_support/contender.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/rounds.h"
#include "lodestone/test_support/secondary_rays.h"

namespace lodestone::test {
namespace {

constexpr int bounces = 2;

struct Choice {
  std::vector<std::string> scenes{"builtin:room", "builtin:head", "builtin:teapots"};
  std::vector<std::string> devices{"cpu", "llvmpipe"};
  uint32_t size = 512;
  int rounds = 7;
};

using Key = std::function<uint64_t(const glm::vec4& from, const glm::vec4& to)>;

uint64_t octant(const glm::vec4& to) {
  return uint64_t(to.x < 0) | uint64_t(to.y < 0) << 1 | uint64_t(to.z < 0) << 2;
}

// Where a point is along a Hilbert curve through 1024^3 cells (Skilling 2004, "Programming the Hilbert
// curve").
uint64_t hilbert(glm::uvec3 x) {
  constexpr uint32_t top = 512;
  for (uint32_t q = top; q > 1; q >>= 1) {
    for (int i = 0; i < 3; ++i) {
      if ((x[i] & q) != 0) {
        x[0] ^= q - 1;
      } else {
        const uint32_t t = (x[0] ^ x[i]) & (q - 1);
        x[0] ^= t;
        x[i] ^= t;
      }
    }
  }
  for (int i = 1; i < 3; ++i) x[i] ^= x[i - 1];
  uint32_t t = 0;
  for (uint32_t q = top; q > 1; q >>= 1) {
    if ((x[2] & q) != 0) t ^= q - 1;
  }
  for (int i = 0; i < 3; ++i) x[i] ^= t;
  uint64_t place = 0;
  for (int bit = 9; bit >= 0; --bit) {
    for (int i = 0; i < 3; ++i) place = place << 1 | (x[i] >> bit & 1);
  }
  return place;
}

struct Order {
  std::string name;
  Rays rays;
  double alive;  // of them
  std::vector<double> seconds;
};

Order sorted(const std::string& name, const Rays& rays, const Key& key) {
  const size_t count = rays.size() / 2;
  std::vector<uint64_t> keys(count);
  for (size_t i = 0; i < count; ++i) keys[i] = key(rays[2 * i], rays[2 * i + 1]);
  std::vector<size_t> order(count);
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return keys[a] < keys[b]; });
  Rays result;
  for (const size_t i : order) result.insert(result.end(), {rays[2 * i], rays[2 * i + 1]});
  return {name, result, double(count), {}};
}

std::vector<Order> make_orders(const Rays& rays) {
  const size_t count = rays.size() / 2;
  glm::vec3 lo(rays[0]), hi(rays[0]);
  for (size_t i = 0; i < count; ++i) {
    lo = glm::min(lo, glm::vec3(rays[2 * i]));
    hi = glm::max(hi, glm::vec3(rays[2 * i]));
  }
  const glm::vec3 per_step = 1023.0f / glm::max(hi - lo, glm::vec3(1e-20f));
  const auto morton = [=](const glm::vec4& from) {
    return uint64_t(layout::morton_key(glm::vec3(from), lo, per_step));
  };
  const auto along_hilbert = [=](const glm::vec4& from) {
    return hilbert(glm::uvec3((glm::vec3(from) - lo) * per_step));
  };
  std::vector<Order> orders;
  orders.push_back({"as pixels are", rays, double(count), {}});
  size_t number = 0;
  orders.push_back(sorted("octants in blocks of 1,024", rays, [&](const glm::vec4&, const glm::vec4& to) {
    return number++ / 1024 << 3 | octant(to);
  }));
  orders.push_back(sorted("octants", rays, [](const glm::vec4&, const glm::vec4& to) { return octant(to); }));
  orders.push_back(sorted("octants, then Morton", rays, [&](const glm::vec4& from, const glm::vec4& to) {
    return octant(to) << 30 | morton(from);
  }));
  orders.push_back(sorted("octants, then Hilbert", rays, [&](const glm::vec4& from, const glm::vec4& to) {
    return octant(to) << 30 | along_hilbert(from);
  }));
  orders.push_back(
      sorted("Hilbert", rays, [&](const glm::vec4& from, const glm::vec4&) { return along_hilbert(from); }));
  std::mt19937 random(3);
  for (const int share : {2, 4, 8}) {
    Rays holes = rays, dense;
    for (size_t i = 0; i < count; ++i) {
      if (random() % uint32_t(share) != 0) {
        holes[2 * i + 1].w = -1;
      } else {
        dense.insert(dense.end(), {rays[2 * i], rays[2 * i + 1]});
      }
    }
    const double alive = double(dense.size() / 2);
    orders.push_back({fmt::format("a {} of them, as they lie", share == 2   ? "half"
                                                               : share == 4 ? "quarter"
                                                                            : "eighth"),
                      holes,
                      alive,
                      {}});
    orders.push_back({"  side by side", dense, alive, {}});
  }
  return orders;
}

void bench(const std::string& scene, const Choice& choice) {
  const ReadyScene ready(scene);
  const scene::Pose pose = ready.pose(0);
  const render::View view = render::find_view(ready.scene, pose, "", scene::pose_bounds(ready.scene, pose),
                                              choice.size, choice.size);
  Contender first(ready, choice.devices.front());
  first.renderer().update(pose);
  Rays rays = primary_rays(view, choice.size);
  for (int bounce = 1; bounce <= bounces; ++bounce) {
    first.renderer().load_rays(rays);
    first.renderer().trace_loaded();
    rays = glossy_rays(rays, first.renderer().hits(), ready, pose, 1, uint32_t(bounce));
    for (const std::string& device : choice.devices) {
      Contender contender(ready, device);
      contender.renderer().update(pose);
      std::vector<Order> orders = make_orders(rays);
      for (int round = 0; round < choice.rounds; ++round) {
        for (Order& order : orders) {
          contender.renderer().load_rays(order.rays);
          contender.renderer().trace_loaded();  // buffers are new ones
          order.seconds.push_back(seconds([&] { contender.renderer().trace_loaded(); }));
        }
      }
      for (size_t i = 0; i < orders.size(); ++i) {
        const Order& order = orders[i];
        const bool shared = i >= 6 && i % 2 == 1;  // compared with the line before
        const Order& other = shared ? orders[i - 1] : orders[0];
        std::vector<double> ratios;
        for (size_t r = 0; r < order.seconds.size(); ++r)
          ratios.push_back(other.seconds[r] / order.seconds[r] * order.alive / other.alive);
        fmt::print("{:<16} {} {:<10} {:<28} {:>8.0f} {:>7.2f} Mrays/s  {}\n", scene, bounce, device,
                   order.name, order.alive, order.alive / median(order.seconds) / 1e6, spread(ratios));
      }
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  using namespace lodestone::test;
  Choice choice;
  CLI::App app("Rays of a bounce in several orders", "ray_order_bench");
  app.add_option("--scenes", choice.scenes, "Files or builtin:NAME")->delimiter(',');
  app.add_option("--devices", choice.devices, "cpu, or a part of a device's name")->delimiter(',');
  app.add_option("--size", choice.size, "Side of the picture in pixels")->check(CLI::Range(8, 4096));
  app.add_option("--rounds", choice.rounds, "Turns of each")->check(CLI::Range(1, 10000));
  return bench_main(app, argc, argv, [&] {
    fmt::print("{:<16} b {:<10} {:<28} {:>8} {:>7}          times as fast: median (range)\n", "scene",
               "device", "order", "rays", "rate");
    for (const std::string& scene : choice.scenes) bench(scene, choice);
  });
}
