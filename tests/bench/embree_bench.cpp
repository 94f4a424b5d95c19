// SPDX-License-Identifier: MIT
// Beside Embree on the same triangles, cores and rays: a closed bumpy sphere of N x N quads. Each round runs
// Embree, then ours, on the same rays (A B A B ...); the median of the rounds' ratios is what counts.
// embree_bench [--quads 128,256,512,1024] [--rounds N] [--devices cpu,llvmpipe] [--what
// primary,incoherent,rebuild]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <sstream>

#include "lodestone/base/error.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/embree_scene.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Rounds {
  std::vector<double> embree, ours, ratio;  // seconds, seconds, embree / ours
  void add(double embree_s, double ours_s) {
    embree.push_back(embree_s);
    ours.push_back(ours_s);
    ratio.push_back(embree_s / ours_s);
  }
  void print(const char* what, uint32_t quads, const std::string& device, double work,
             const char* unit) const {
    const auto [lo, hi] = std::minmax_element(ratio.begin(), ratio.end());
    const bool rate = work > 0;
    fmt::print("{:<12} {:>5} {:<12} {:>9.2f} {:>9.2f} {:<8} {:>7.2f} ({:.2f} to {:.2f})\n", what, quads,
               device, rate ? work / median(embree) / 1e6 : median(embree) * 1e3,
               rate ? work / median(ours) / 1e6 : median(ours) * 1e3, unit, median(ratio), *lo, *hi);
    std::fflush(stdout);
  }
};

struct Contender {
  std::string name;
  std::unique_ptr<render::Backend> backend;
  std::unique_ptr<render::Renderer> renderer;
};

// The sum of the `bounds` dispatches of one update: device time where there is one.
double bounds_seconds(Contender& contender, const scene::Pose& pose) {
  contender.backend->finish();
  contender.renderer->update(pose);
  double ms = 0;
  for (const render::PassRecord& pass : contender.backend->finish()) {
    if (pass.name == "bounds") ms += std::isnan(pass.device_ms) ? pass.wall_ms : pass.device_ms;
  }
  return ms / 1e3;
}

struct Choice {
  std::vector<std::string> sizes{"128", "256", "512", "1024"}, devices{"cpu", "llvmpipe"};
  std::vector<std::string> what{"primary", "incoherent", "rebuild"};
  int rounds = 11;
  bool wants(const std::string& name) const {
    return std::find(what.begin(), what.end(), name) != what.end();
  }
};

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> items;
  std::stringstream stream(list);
  for (std::string item; std::getline(stream, item, ',');) items.push_back(item);
  return items;
}

void bench(uint32_t quads, const Choice& choice) {
  const int rounds = choice.rounds;
  const ReadyScene ready(grid_sphere(quads));
  const scene::Pose pose = ready.pose(0);
  const auto texels = ready.texels(pose);
  const QuadTriangles triangles = quad_triangles(ready.atlas);
  std::vector<Contender> contenders;
  for (const std::string& name : choice.devices) {
    Contender contender{name, open(name), nullptr};
    render::Settings settings;
    settings.width = settings.height = 8;
    contender.renderer = std::make_unique<render::Renderer>(*contender.backend, ready.scene, ready.assembly,
                                                            ready.atlas, settings);
    contenders.push_back(std::move(contender));
  }
  const EmbreeScene embree(texels, triangles.texels, false);
  const Rays primary = primary_rays({1.2f, 0.9f, 2.6f}, {0, 0, 0}, 0.36f, 512);
  const Rays incoherent = surface_rays(texels, triangles.texels, 262144, 5);
  const std::pair<const char*, const Rays*> kinds[] = {{"primary", &primary}, {"incoherent", &incoherent}};
  std::vector<EmbreeHit> hits;
  for (Contender& contender : contenders) {
    contender.renderer->update(pose);
    for (const auto& [what, rays] : kinds) {
      if (!choice.wants(what)) continue;
      contender.renderer->load_rays(*rays);
      contender.renderer->trace_loaded();
      embree.intersect(*rays, hits);
      Rounds result;
      for (int round = 0; round < rounds; ++round) {
        const double theirs = seconds([&] { embree.intersect(*rays, hits); });
        result.add(theirs, seconds([&] { contender.renderer->trace_loaded(); }));
      }
      result.print(what, quads, contender.name, static_cast<double>(rays->size() / 2), "Mrays/s");
    }
    if (!choice.wants("rebuild")) continue;
    EmbreeScene rebuilt(texels, triangles.texels, false, EmbreeBuild::dynamic_low_quality);
    bounds_seconds(contender, pose);
    Rounds result;
    for (int round = 0; round < rounds; ++round) {
      const double theirs = seconds([&] { rebuilt.recommit(); });
      result.add(theirs, bounds_seconds(contender, pose));
    }
    result.print("rebuild", quads, contender.name, 0, "ms");
  }
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) try {
  lodestone::test::Choice choice;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option == "--rounds") choice.rounds = std::max(1, std::atoi(argv[i + 1]));
    if (option == "--quads") choice.sizes = lodestone::test::split(argv[i + 1]);
    if (option == "--devices") choice.devices = lodestone::test::split(argv[i + 1]);
    if (option == "--what") choice.what = lodestone::test::split(argv[i + 1]);
  }
  fmt::print("{:<12} {:>5} {:<12} {:>9} {:>9} {:<8} {:>7}\n", "what", "quads", "device", "Embree", "ours",
             "unit", "times as fast: median (range)");
  for (const std::string& size : choice.sizes) {
    lodestone::test::bench(static_cast<uint32_t>(std::atoi(size.c_str())), choice);
  }
} catch (const lodestone::Error& error) {
  fmt::print(stderr, "{}\n", error.what());
  return static_cast<int>(error.code());
}
