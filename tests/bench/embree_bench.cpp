// SPDX-License-Identifier: MIT
// Beside Embree on the same surface, cores and rays: a closed bumpy sphere of N x N quads. Each round runs
// Embree, then ours, on the same rays (A B A B ...); the median of the rounds' ratios is what counts. Embree
// is in the fastest of its ways: triangles, quads or grids; rtcIntersect1, 8 or 1M; refit or a low-quality
// build. embree_bench [--quads 128,256,512,1024] [--rounds N] [--devices cpu,llvmpipe] [--what
// primary,incoherent,update] [--traversal auto] [--embree triangles/1]
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>

#include "lodestone/test_support/bench_main.h"
#include "lodestone/test_support/contender.h"
#include "lodestone/test_support/embree_scene.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/rounds.h"

namespace lodestone::test {
namespace {

void print(const Rounds& rounds, const char* what, uint32_t quads, const std::string& device,
           const std::string& way, double work, const char* unit) {
  const bool rate = work > 0;
  fmt::print("{:<12} {:>5} {:<12} {:<18} {:>9.2f} {:>9.2f} {:<8} {:>7}\n", what, quads, device, way,
             rate ? work / median(rounds.theirs) / 1e6 : median(rounds.theirs) * 1e3,
             rate ? work / median(rounds.ours) / 1e6 : median(rounds.ours) * 1e3, unit, spread(rounds.ratio));
  std::fflush(stdout);
}

// One way of having Embree do something.
struct Way {
  std::string name;
  std::function<void()> work;
};

// The one that took least in the best of five turns, the first of which does not count.
const Way& fastest(const std::vector<Way>& ways) {
  std::vector<double> least(ways.size(), std::numeric_limits<double>::max());
  for (int turn = 0; turn < 5; ++turn) {
    for (size_t i = 0; i < ways.size(); ++i) {
      const double took = seconds(ways[i].work);
      if (turn > 0) least[i] = std::min(least[i], took);
    }
  }
  return ways[size_t(std::min_element(least.begin(), least.end()) - least.begin())];
}

// The `bounds` dispatches of one update.
double bounds_seconds(Contender& contender, const scene::Pose& pose) {
  contender.take_passes();
  contender.renderer().update(pose);
  return contender.take_passes().at("bounds");
}

struct Choice {
  std::vector<uint32_t> sizes{128, 256, 512, 1024};
  std::vector<std::string> devices{"cpu", "llvmpipe"};
  std::vector<std::string> what{"primary", "incoherent", "update"};
  std::string traversal = "auto", embree;
  int rounds = 11;
  bool wants(const std::string& name) const {
    return std::find(what.begin(), what.end(), name) != what.end();
  }
};

constexpr EmbreeShape shapes[] = {EmbreeShape::triangles, EmbreeShape::quads, EmbreeShape::grids};

// Those of the choice, or all.
std::vector<Way> chosen(const Choice& choice, std::vector<Way> ways) {
  if (choice.embree.empty()) return ways;
  std::erase_if(ways, [&](const Way& way) { return way.name != choice.embree; });
  return ways;
}

void bench_rays(const char* what, uint32_t quads, const Choice& choice, const Rays& rays,
                const std::vector<std::unique_ptr<EmbreeScene>>& scenes, std::vector<Contender>& contenders) {
  std::vector<EmbreeHit> hits;
  std::vector<Way> ways;
  for (const EmbreeShape shape : shapes) {
    for (const EmbreeCall call : {EmbreeCall::one, EmbreeCall::eight, EmbreeCall::stream}) {
      ways.push_back({fmt::format("{}/{}", to_string(shape), to_string(call)),
                      [&, shape, call] { scenes[size_t(shape)]->intersect(rays, hits, call); }});
    }
  }
  ways = chosen(choice, std::move(ways));
  if (ways.empty()) return;
  const Way& way = fastest(ways);
  for (Contender& contender : contenders) {
    contender.renderer().load_rays(rays);
    contender.renderer().trace_loaded();
    Rounds result;
    for (int round = 0; round < choice.rounds; ++round) {
      const double theirs = seconds(way.work);
      result.add(theirs, seconds([&] { contender.renderer().trace_loaded(); }));
    }
    print(result, what, quads, contender.device(), way.name, static_cast<double>(rays.size() / 2), "Mrays/s");
  }
}

void bench_update(uint32_t quads, const Choice& choice, const ReadyScene& ready,
                  const std::vector<glm::vec3>& texels, std::vector<Contender>& contenders) {
  std::vector<std::unique_ptr<EmbreeScene>> scenes;
  std::vector<Way> ways;
  for (const EmbreeShape shape : shapes) {
    for (const auto& [build, name] : {std::pair(EmbreeBuild::dynamic_refit, "refit"),
                                      std::pair(EmbreeBuild::dynamic_low_quality, "build")}) {
      scenes.push_back(std::make_unique<EmbreeScene>(texels, ready.atlas, shape, build));
      ways.push_back({fmt::format("{}/{}", to_string(shape), name),
                      [scene = scenes.back().get()] { scene->recommit(); }});
    }
  }
  ways = chosen(choice, std::move(ways));
  if (ways.empty()) return;
  const Way& way = fastest(ways);
  const scene::Pose pose = ready.pose(0);
  for (Contender& contender : contenders) {
    bounds_seconds(contender, pose);
    Rounds result;
    for (int round = 0; round < choice.rounds; ++round) {
      const double theirs = seconds(way.work);
      result.add(theirs, bounds_seconds(contender, pose));
    }
    print(result, "update", quads, contender.device(), way.name, 0, "ms");
  }
}

void bench(uint32_t quads, const Choice& choice) {
  const ReadyScene ready(grid_sphere(quads));
  const scene::Pose pose = ready.pose(0);
  const auto texels = ready.texels(pose);
  const QuadTriangles triangles = quad_triangles(ready.atlas);
  std::vector<Contender> contenders;
  for (const std::string& name : choice.devices) {
    contenders.emplace_back(ready, name, render::BackendOptions{}, choice.traversal);
    contenders.back().renderer().update(pose);
  }
  std::vector<std::unique_ptr<EmbreeScene>> scenes;
  for (const EmbreeShape shape : shapes)
    scenes.push_back(std::make_unique<EmbreeScene>(texels, ready.atlas, shape));
  if (choice.wants("primary")) {
    bench_rays("primary", quads, choice, primary_rays({1.2f, 0.9f, 2.6f}, {0, 0, 0}, 0.36f, 512), scenes,
               contenders);
  }
  if (choice.wants("incoherent")) {
    bench_rays("incoherent", quads, choice, surface_rays(texels, triangles.texels, 262144, 5), scenes,
               contenders);
  }
  if (choice.wants("update")) bench_update(quads, choice, ready, texels, contenders);
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  using namespace lodestone::test;
  Choice choice;
  CLI::App app("Beside Embree on the same triangles, cores and rays", "embree_bench");
  app.add_option("--quads", choice.sizes, "Spheres of N x N quads")
      ->delimiter(',')
      ->check(CLI::Range(4, 4096));
  app.add_option("--rounds", choice.rounds, "Turns of each")->check(CLI::Range(1, 10000));
  app.add_option("--devices", choice.devices, "cpu, or a part of a device's name")->delimiter(',');
  app.add_option("--what", choice.what, "What is measured")
      ->delimiter(',')
      ->check(CLI::IsMember({"primary", "incoherent", "update"}));
  app.add_option("--traversal", choice.traversal, "Ours")
      ->check(CLI::IsMember({"auto", "threaded", "octant", "wide", "tile"}));
  app.add_option("--embree", choice.embree, "Embree's way, as it is printed; otherwise the fastest");
  return bench_main(app, argc, argv, [&] {
    fmt::print("{:<12} {:>5} {:<12} {:<18} {:>9} {:>9} {:<8} {:>7}\n", "what", "quads", "device",
               "Embree's way", "Embree", "ours", "unit", "times as fast: median (range)");
    for (const uint32_t quads : choice.sizes) bench(quads, choice);
  });
}
