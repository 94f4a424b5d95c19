// SPDX-License-Identifier: MIT
// What relaxation sweeps gain and cost: the distance between the input and its geometry image in a strongly
// deformed pose, and the time of a sweep on the CPU, by the number of sweeps. relaxation_bench [NAME ...], of
// the names below; a file that is not in the shared data folder is left out.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/geometry_image/fidelity.h"
#include "lodestone/scene/load.h"
#include "lodestone/test_support/bulging_sphere.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

struct Subject {
  const char* name;
  uint32_t quads;    // of the bulging sphere ...
  const char* file;  // ... where this is null
  std::map<std::string, float> weights;
  const char* clip;  // null: none
  float time;
  uint64_t texels;  // budget; 0: that of the atlas
};

const std::vector<Subject> subjects = {
    {"sphere", 12, nullptr, {{"bulge", 1.0f}}, nullptr, 0, 16384},
    {"sphere-fine", 64, nullptr, {{"bulge", 1.0f}}, nullptr, 0, 16384},
    {"morph-stress",
     0,
     "MorphStressTest.glb",
     {{"Key 1", 1.0f}, {"Key 3", 1.0f}, {"Key 5", 1.0f}},
     nullptr,
     0,
     0},
    {"face", 0, "ict_face_sparse.glb", {{"jawOpen", 1.5f}, {"mouthFunnel", 1.0f}}, nullptr, 0, 65536},
    {"robot", 0, "RobotExpressive.glb", {}, "Dance", 0.6f, 0},
    {"fox", 0, "Fox.glb", {}, "Run", 0.3f, 0},
    {"man", 0, "CesiumMan.glb", {}, "", 0.9f, 0},
};

void bench(const Subject& subject) {
  scene::Scene scene;
  if (subject.file == nullptr) {
    scene = bulging_sphere(subject.quads);
  } else {
    const std::optional<std::string> file = data_file(subject.file);
    if (!file) return;
    scene = scene::load(*file);
  }
  geometry_image::AtlasSettings settings = geometry_image::AtlasKind::charts;
  settings.charts.texel_budget = subject.texels;
  settings.charts.keep_maps = true;
  const ReadyScene ready(std::move(scene), settings);
  const uint32_t animation =
      subject.clip == nullptr ? scene::none : scene::find_animation(ready.scene, subject.clip);
  scene::Pose pose = scene::evaluate(ready.scene, animation, subject.time);
  if (!subject.weights.empty()) scene::override_weights(ready.scene, subject.weights, pose);
  const uint64_t triangles = ready.assembly.triangles.size();
  fmt::print("{}: {} triangles, {} charts, {} texels, maps of {:.1f} bytes a triangle\n", subject.name,
             triangles, ready.atlas.charts.size(), ready.atlas.texel_map.size(),
             double(ready.atlas.maps.bytes()) / double(triangles));
  fmt::print("{:>8} {:>14} {:>14} {:>14} {:>12}\n", "sweeps", "mean %", "RMS %", "Hausdorff %", "ms a sweep");
  constexpr double percent = 100;
  const auto backend = open("cpu");
  for (const uint32_t sweeps : {0u, 1u, 2u, 4u, 8u, 16u}) {
    render::Settings frame;
    frame.width = frame.height = 8;
    frame.relaxation_sweeps = sweeps;
    render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, frame);
    std::vector<double> times;
    for (int round = 0; round < 5; ++round) {
      renderer.update(pose);
      double relax = 0;
      for (const render::PassRecord& record : backend->finish())
        relax += record.name == "relax" ? record.wall_ms : 0;
      times.push_back(relax);
    }
    geometry_image::Atlas relaxed = ready.atlas;
    relaxed.texel_map = renderer.texel_map();
    const auto fidelity = geometry_image::measure_fidelity(ready.scene, ready.assembly, relaxed, pose);
    if (!fidelity) fail(ExitCode::bad_input, subject.name, "has no chart that is resampled");
    fmt::print("{:>8} {:>14.5f} {:>14.5f} {:>14.5f} {:>12}\n", sweeps, percent * fidelity->mean,
               percent * fidelity->root_mean_square, percent * fidelity->hausdorff(),
               sweeps == 0 ? "-" : fmt::format("{:.3f}", median(times) / sweeps));
  }
}

int bench_all(const std::vector<std::string>& names) {
  for (const Subject& subject : subjects) {
    const bool wanted = names.empty() || std::find(names.begin(), names.end(), subject.name) != names.end();
    if (wanted) bench(subject);
  }
  return 0;
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  try {
    return lodestone::test::bench_all(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const std::exception& error) {
    fmt::print(stderr, "relaxation_bench: {}\n", error.what());
    return 3;
  }
}
