// SPDX-License-Identifier: MIT
// Beside Embree on the same triangles, cores and rays: a closed bumpy sphere of N x N quads. Each round runs
// Embree, then ours, on the same rays (A B A B ...); the median of the rounds' ratios is what counts.
// embree_bench [--quads 128,256,512,1024] [--rounds N] [--devices cpu,llvmpipe] [--what
// primary,incoherent,rebuild]
#include <fmt/format.h>

#include <algorithm>

#include "lodestone/test_support/bench_main.h"
#include "lodestone/test_support/contender.h"
#include "lodestone/test_support/embree_scene.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/rounds.h"

namespace lodestone::test {
namespace {

void print(const Rounds& rounds, const char* what, uint32_t quads, const std::string& device, double work,
           const char* unit) {
  const bool rate = work > 0;
  fmt::print("{:<12} {:>5} {:<12} {:>9.2f} {:>9.2f} {:<8} {:>7}\n", what, quads, device,
             rate ? work / median(rounds.theirs) / 1e6 : median(rounds.theirs) * 1e3,
             rate ? work / median(rounds.ours) / 1e6 : median(rounds.ours) * 1e3, unit, spread(rounds.ratio));
  std::fflush(stdout);
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
  std::vector<std::string> what{"primary", "incoherent", "rebuild"};
  int rounds = 11;
  bool wants(const std::string& name) const {
    return std::find(what.begin(), what.end(), name) != what.end();
  }
};

void bench(uint32_t quads, const Choice& choice) {
  const int rounds = choice.rounds;
  const ReadyScene ready(grid_sphere(quads));
  const scene::Pose pose = ready.pose(0);
  const auto texels = ready.texels(pose);
  const QuadTriangles triangles = quad_triangles(ready.atlas);
  std::vector<Contender> contenders;
  for (const std::string& name : choice.devices) contenders.emplace_back(ready, name);
  const EmbreeScene embree(texels, triangles.texels, false);
  const Rays primary = primary_rays({1.2f, 0.9f, 2.6f}, {0, 0, 0}, 0.36f, 512);
  const Rays incoherent = surface_rays(texels, triangles.texels, 262144, 5);
  const std::pair<const char*, const Rays*> kinds[] = {{"primary", &primary}, {"incoherent", &incoherent}};
  std::vector<EmbreeHit> hits;
  for (Contender& contender : contenders) {
    contender.renderer().update(pose);
    for (const auto& [what, rays] : kinds) {
      if (!choice.wants(what)) continue;
      contender.renderer().load_rays(*rays);
      contender.renderer().trace_loaded();
      embree.intersect(*rays, hits);
      Rounds result;
      for (int round = 0; round < rounds; ++round) {
        const double theirs = seconds([&] { embree.intersect(*rays, hits); });
        result.add(theirs, seconds([&] { contender.renderer().trace_loaded(); }));
      }
      print(result, what, quads, contender.device(), static_cast<double>(rays->size() / 2), "Mrays/s");
    }
    if (!choice.wants("rebuild")) continue;
    EmbreeScene rebuilt(texels, triangles.texels, false, EmbreeBuild::dynamic_low_quality);
    bounds_seconds(contender, pose);
    Rounds result;
    for (int round = 0; round < rounds; ++round) {
      const double theirs = seconds([&] { rebuilt.recommit(); });
      result.add(theirs, bounds_seconds(contender, pose));
    }
    print(result, "rebuild", quads, contender.device(), 0, "ms");
  }
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
      ->check(CLI::IsMember({"primary", "incoherent", "rebuild"}));
  return bench_main(app, argc, argv, [&] {
    fmt::print("{:<12} {:>5} {:<12} {:>9} {:>9} {:<8} {:>7}\n", "what", "quads", "device", "Embree", "ours",
               "unit", "times as fast: median (range)");
    for (const uint32_t quads : choice.sizes) bench(quads, choice);
  });
}
