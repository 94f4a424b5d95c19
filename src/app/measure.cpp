// SPDX-License-Identifier: MIT
#include "lodestone/app/measure.h"

#include <cmath>

#include "lodestone/app/version.h"
#include "lodestone/render/denoiser.h"

namespace lodestone::app {
namespace {

report::Counters to_counters(const render::Counters& counters) {
  return {.bytes_read = counters.bytes_read,
          .bytes_written = counters.bytes_written,
          .rays = counters.rays,
          .node_visits = counters.node_visits,
          .box_tests = counters.box_tests,
          .triangle_tests = counters.triangle_tests,
          .lane_steps = counters.lane_steps,
          .subgroup_steps = counters.subgroup_steps};
}

}  // namespace

std::vector<report::Dispatch> to_dispatches(const std::vector<render::PassRecord>& records,
                                            double origin_ms) {
  std::vector<report::Dispatch> dispatches;
  dispatches.reserve(records.size());
  for (const render::PassRecord& record : records) {
    report::Dispatch& dispatch = dispatches.emplace_back();
    dispatch.name = record.name;
    dispatch.start_ms = origin_ms + record.wall_start_ms;
    dispatch.wall_ms = record.wall_ms;
    if (!record.first && !std::isnan(record.device_ms)) dispatch.device_ms = record.device_ms;
    dispatch.invocations = record.invocations;
    if (record.counted) dispatch.counters = to_counters(record.counters);
  }
  return dispatches;
}

report::RunRecord describe_run(const std::string& command, const std::string& scene_name,
                               const PreparedScene& prepared, const PictureOptions& picture,
                               const render::DeviceInfo& device) {
  report::RunRecord run;
  run.version = version();
  run.command = command;
  run.tracer = tracer_names().front();
  run.device = {device.kind, device.name, device.driver, device.api};
  run.scene.file = scene_name;
  run.scene.triangles = prepared.assembly.triangles.size();
  run.scene.vertices = prepared.assembly.positions.size();
  for (const scene::Mesh& mesh : prepared.scene.meshes) run.scene.morph_targets += mesh.targets.size();
  for (const scene::Skin& skin : prepared.scene.skins) run.scene.joints += skin.joints.size();
  run.atlas = {prepared.atlas.charts.size(), prepared.atlas.report.quads, prepared.atlas.texel_map.size()};
  run.settings.integrator = to_string(picture.integrator);
  run.settings.seed = picture.seed;
  run.settings.clip = prepared.clip_name();
  run.image = {picture.size.width, picture.size.height, picture.spp,
               picture.denoise ? render::denoise_description() : ""};
  run.precompute = prepared.stages;
  return run;
}

}  // namespace lodestone::app
