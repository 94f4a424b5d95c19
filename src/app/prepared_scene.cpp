// SPDX-License-Identifier: MIT
#include "lodestone/app/prepared_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lodestone/app/baked_scene.h"
#include "lodestone/app/clock.h"
#include "lodestone/app/stage_clock.h"
#include "lodestone/base/error.h"
#include "lodestone/base/log.h"

namespace lodestone::app {
namespace {

// Of the animation, for a camera that sees all of it: an eighth of a second is less than a stride or a blow.
constexpr double samples_per_second = 8;
constexpr uint32_t fewest_samples = 8, most_samples = 256;

// Runs one step of the preparation and notes how long it took.
template <class Step>
auto timed(std::vector<report::Stage>& stages, const char* name, Step step) {
  const double start = now_ms();
  auto result = step();
  stages.push_back({name, start, now_ms() - start});
  return result;
}

}  // namespace

double PreparedScene::wrap(double seconds) const {
  if (animation == scene::none) return 0;
  const double duration = scene.animations[animation].duration();
  if (seconds <= duration) return seconds;
  return duration > 0 ? std::fmod(seconds, duration) : 0;
}

scene::Pose PreparedScene::pose_at(double seconds) const {
  scene::Pose result = scene::evaluate(scene, animation, float(seconds));
  if (!pose.weights.empty()) scene::override_weights(scene, pose.weights, result);
  return result;
}

scene::Bounds PreparedScene::bounds() const {
  // Weights of the command line may reach further than any that the clip has.
  const double duration = animation == scene::none ? 0 : scene.animations[animation].duration();
  const auto steps = duration > 0 ? uint32_t(std::clamp(std::ceil(samples_per_second * duration),
                                                        double(fewest_samples), double(most_samples)))
                                  : 0;
  scene::Bounds all = scene::pose_bounds(scene, pose_at(0));
  for (uint32_t step = 1; step <= steps; ++step)
    all.include(scene::pose_bounds(scene, pose_at(duration * step / steps)));
  return all;
}

std::string PreparedScene::clip_name() const {
  if (animation == scene::none) return "";
  const std::string& name = scene.animations[animation].name;
  return name.empty() ? std::to_string(animation) : name;
}

PreparedScene prepare_scene(const SceneOptions& options, const PoseOptions& pose, bool show_stages) {
  PreparedScene prepared;
  prepared.pose = pose;
  std::optional<BakedScene> baked;
  prepared.scene = timed(prepared.stages, "load", [&] {
    if (!is_baked(options.scene)) return load_scene(options);
    return baked.emplace(options).load();
  });
  if (std::optional<scene::Environment> environment = load_environment(options)) {
    prepared.scene.environment = std::move(environment);
    scene::validate(prepared.scene);
  }
  prepared.animation = scene::find_animation(prepared.scene, pose.clip);
  prepared.pose_at(0);  // finds unknown weight names before the costly part
  const scene::Instancing instancing = baked ? baked->instancing() : instancing_of(options);
  prepared.assembly =
      timed(prepared.stages, "assemble", [&] { return scene::assemble(prepared.scene, instancing); });
  if (options.one_object != nullptr && prepared.assembly.has_instances()) {
    fail(ExitCode::usage, options.one_object,
         "`{}` was baked with instances, and this cannot do with them; bake it again with --instancing off",
         options.scene);
  }
  bool cached = false;
  prepared.atlas = timed(prepared.stages, "charts", [&] {
    if (baked) return baked->take_atlas(prepared.scene, prepared.assembly);
    StageClock clock(options.scene, show_stages);
    return geometry_image::cached_atlas(prepared.scene, prepared.assembly, options.atlas, &cached,
                                        [&](const char* stage) { clock.begin(stage); });
  });
  const geometry_image::AtlasReport& report = prepared.atlas.report;
  log::note(fmt::format("{}: {} triangles, {} charts, {} quads, {} texels{}", options.scene, report.triangles,
                        prepared.atlas.charts.size(), report.quads, report.texels,
                        cached  ? ", atlas from the cache"
                        : baked ? ", atlas as baked"
                                : ""));
  if (prepared.assembly.has_instances()) {
    log::note(fmt::format("{}: {} instances of {} objects", options.scene, prepared.assembly.instances.size(),
                          prepared.assembly.objects.size()));
  }
  for (const std::string& note : report.notes) log::note(options.scene + ": " + note);
  if (options.atlas.charts.keep_maps && report.mapped_charts == 0)
    log::note(options.scene +
              ": no chart is resampled, so --relaxation-sweeps moves nothing; use --atlas charts");
  return prepared;
}

render::View view_of(const PreparedScene& prepared, const scene::Pose& pose, const PictureOptions& picture,
                     const scene::Bounds& bounds) {
  return render::find_view(prepared.scene, pose, picture.camera, bounds, picture.size.width,
                           picture.size.height);
}

}  // namespace lodestone::app
