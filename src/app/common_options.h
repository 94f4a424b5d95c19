// SPDX-License-Identifier: MIT
// Options that several commands take, each declared once. Values are checked while they are parsed: what
// stands in these structs is valid. The functions add options to a command's parser; the structs must outlive
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/app/cli.h"
#include "lodestone/app/parse_values.h"
#include "lodestone/geometry_image/atlas.h"
#include "lodestone/render/backend.h"
#include "lodestone/render/renderer.h"
#include "lodestone/scene/scene.h"

namespace lodestone::app {

// An option of one value, which `parse` checks and stores.
CLI::Option* add_value(CLI::App& app, const std::string& names, const std::string& type,
                       const std::string& help, std::function<void(const std::string&)> parse);

// An option that names a file or a folder; an empty name is refused, for it would be taken for none.
CLI::Option* add_path(CLI::App& app, const std::string& names, const std::string& type,
                      const std::string& help, std::string& path);

struct SceneOptions {
  std::string scene;
  geometry_image::AtlasSettings atlas;
  const char* budget_option = "";  // that gave the texel budget, for messages
  scene::Instancing instancing = scene::Instancing::automatic;
  const char* one_object = nullptr;  // the option, if any, that cannot do with instances
  float height_scale = 0;
  // What stands in for the scene's own sky; empty: nothing.
  std::string environment;
  std::optional<float> environment_strength, environment_rotation;
};
void add_scene_argument(CLI::App& app, SceneOptions& options);  // SCENE --height
void add_atlas_options(
    CLI::App& app,
    SceneOptions& options);  // --atlas --resolution --texel-budget --signal --all-shapes --instancing
// What they say of it together. Throws Error(usage) where --instancing on meets what needs a single object.
scene::Instancing instancing_of(const SceneOptions& options);
// --environment --environment-strength --environment-rotation, for commands that make pictures
void add_environment_options(CLI::App& app, SceneOptions& options);
// The environment of these options, read; none where none is given. Throws Error(usage) where the others are
// given without it.
std::optional<scene::Environment> load_environment(const SceneOptions& options);
// The scene, read. Throws Error(usage) where --height is given and the scene is no height map, or options for
// resampling are and nothing would be resampled.
scene::Scene load_scene(const SceneOptions& options);

// The tracers of this build: the names that --tracer takes.
std::vector<std::string> tracer_names();
void add_tracer_option(CLI::App& app);

struct PoseOptions {
  std::string clip;  // empty: the first
  std::map<std::string, float> weights;
};
void add_pose_options(CLI::App& app, PoseOptions& options);  // --clip --weights

struct FrameOptions {
  std::optional<FrameRange> frames;
  double fps = 24;
  std::optional<double> time;

  FrameRange range() const { return frames.value_or(FrameRange{}); }
  // Seconds of a frame, before they wrap at the end of the clip.
  double seconds(uint32_t frame) const { return time.value_or(frame / fps); }
};
void add_frame_options(CLI::App& app, FrameOptions& options);  // --frames --fps --time
// Throws Error(usage) where --time is given and several frames are.
void check_frames(const FrameOptions& options);

struct PictureOptions {
  Size size;
  uint32_t spp = 1;
  uint32_t seed = 0;
  render::CameraChoice camera;
  render::Traversal traversal = render::Traversal::automatic;
  render::Integrator integrator = render::Integrator::eye;
  std::optional<uint32_t> max_bounces;
  std::optional<float> ao_distance;
  bool denoise = false;
  float lens_radius = 0, focus_distance = 0;  // 0: see render::Settings
};
// --relaxation-sweeps; where there are some, the atlas is to have the maps that they need.
void add_relaxation_option(CLI::App& app, SceneOptions& scene, uint32_t& sweeps);
// --pixels-of-error; where there are some, the scene is to be one object.
void add_detail_option(CLI::App& app, SceneOptions& scene, float& pixels_of_error);
void add_size_option(CLI::App& app, Size& size);
void add_seed_option(CLI::App& app, uint32_t& seed);
// --camera --orbit --fov --camera-from --camera-at
void add_camera_options(CLI::App& app, render::CameraChoice& camera);
// Those three, --spp, --traversal, and the integrator with all that it takes.
void add_picture_options(CLI::App& app, PictureOptions& options);
// What they say of a picture. Warns of those that have no effect on it.
render::Settings picture_settings(const PictureOptions& options);
render::Traversal parse_traversal(const std::string& option, const std::string& text);

std::vector<std::string> aov_names();

struct DeviceOptions {
  std::string device = "auto";
  render::BackendOptions backend;
  uint64_t memory = 0;  // render::Settings::device_memory
};
void add_device_options(CLI::App& app,
                        DeviceOptions& options);            // --device --device-memory --threads --validate
void add_threads_option(CLI::App& app, uint32_t& threads);  // 0: all

void add_log_options(CLI::App& app);  // -v -q, which take effect while they are parsed

}  // namespace lodestone::app
