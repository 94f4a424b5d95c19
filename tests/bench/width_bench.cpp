// SPDX-License-Identifier: MIT
// What vectors are worth on the CPU, pass by pass: the same frames with the widest vectors of this processor
// and with none, in turn (A B A B ...). width_bench [SCENE] [ROUNDS], e.g. width_bench builtin:head 7.
#include <fmt/format.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "lodestone/base/error.h"
#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/rounds.h"

namespace lodestone::test {
namespace {

using PassTimes = std::map<std::string, double>;  // milliseconds a frame

PassTimes frame_times(const ReadyScene& ready, int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  const auto backend = cpu_fallback::make_cpu_backend({});
  render::Settings settings;
  settings.width = settings.height = 512;
  settings.aovs = {"normal", "albedo"};
  render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
  const scene::Pose pose = ready.pose(0.4f);
  const auto view = render::find_view(ready.scene, pose, "", scene::pose_bounds(ready.scene, pose),
                                      settings.width, settings.height);
  renderer.render(pose, view);  // the first touch of all memory
  const auto frame = renderer.render(pose, view);
  PassTimes times;
  for (const render::PassRecord& pass : frame->passes) times[pass.name] += pass.wall_ms;
  return times;
}

int bench(const std::string& name, int rounds) {
  const ReadyScene ready(name);
  const int64_t all = hwy::SupportedTargets();
  std::map<std::string, std::vector<double>> wide, scalar, ratio;
  for (int round = 0; round < rounds; ++round) {
    const PassTimes a = frame_times(ready, all), b = frame_times(ready, HWY_SCALAR);
    for (const auto& [pass, ms] : a) {
      wide[pass].push_back(ms);
      scalar[pass].push_back(b.at(pass));
      ratio[pass].push_back(b.at(pass) / ms);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  fmt::print("{}, 512 x 512, {} against SCALAR\n{:<12} {:>10} {:>10}   times as fast: median (range)\n", name,
             cpu_fallback::simd_target(), "pass", "ms", "SCALAR ms");
  for (const auto& [pass, ratios] : ratio) {
    fmt::print("{:<12} {:>10.2f} {:>10.2f} {:>7}\n", pass, median(wide[pass]), median(scalar[pass]),
               spread(ratios));
  }
  return 0;
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  try {
    return lodestone::test::bench(argc > 1 ? argv[1] : "builtin:head",
                                  argc > 2 ? std::max(std::atoi(argv[2]), 1) : 7);
  } catch (const std::exception& error) {
    fmt::print(stderr, "width_bench: {}\n", error.what());
    return 3;
  }
}
