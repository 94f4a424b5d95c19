// SPDX-License-Identifier: MIT
#include "lodestone/app/common_options.h"

#include <fmt/format.h>
#include <CLI/App.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "lodestone/app/output_path.h"
#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/environment.h"
#include "lodestone/scene/load.h"

namespace lodestone::app {
namespace {

constexpr uint32_t max_spp = 65536;
constexpr uint32_t max_sweeps = 1024;
constexpr uint32_t max_bounces = 1024;
constexpr double most_pixels_of_error = 1000;
constexpr uint32_t max_threads = 4096;
constexpr uint32_t max_resolution = 32768;  // of all charts together: 2^30 texels

// An option for resampling that is given; null where none is.
const char* resampling_option(const SceneOptions& options) {
  const geometry_image::ChartSettings& charts = options.atlas.charts;
  return charts.texel_budget != 0                        ? options.budget_option
         : charts.signal != geometry_image::Signal::area ? "--signal"
         : charts.all_shapes                             ? "--all-shapes"
                                                         : nullptr;
}

// Throws Error(usage) where options for resampling are given with an atlas that resamples nothing.
void check_atlas_options(const SceneOptions& options) {
  using geometry_image::AtlasKind;
  const char* option = resampling_option(options);
  if (option == nullptr) return;
  if (options.atlas.kind == AtlasKind::grid || options.atlas.kind == AtlasKind::exact)
    fail(ExitCode::usage, option,
         "the atlases grid and exact take their texels from the triangles and have no resolution; use "
         "--atlas charts or auto, or leave it out");
}

// Throws Error(usage) where they are given with auto, which keeps the grids of all that is in this scene.
void check_resamples(const SceneOptions& options, const scene::Scene& scene) {
  const char* option = resampling_option(options);
  if (option == nullptr || options.atlas.kind != geometry_image::AtlasKind::automatic) return;
  const bool all_grids = std::all_of(scene.meshes.begin(), scene.meshes.end(), [](const scene::Mesh& mesh) {
    return !mesh.grids.empty() || mesh.triangles.empty();
  });
  if (all_grids)
    fail(ExitCode::usage, option,
         "all meshes of `{}` are grids of samples, which --atlas auto keeps; use --atlas charts, or leave it "
         "out",
         options.scene);
}

}  // namespace

CLI::Option* add_value(CLI::App& app, const std::string& names, const std::string& type,
                       const std::string& help, std::function<void(const std::string&)> parse) {
  return app.add_option_function<std::string>(names, parse, help)->type_name(type);
}

CLI::Option* add_path(CLI::App& app, const std::string& names, const std::string& type,
                      const std::string& help, std::string& path) {
  const std::string name = names.substr(names.rfind(',') + 1);
  return add_value(app, names, type, help,
                   [name, &path](const std::string& text) { path = parse_name(name, text); });
}

void add_scene_argument(CLI::App& app, SceneOptions& options) {
  add_path(
      app, "SCENE", "",
      "A .gltf .glb .obj .ply .stl, a grey .png .exr .tif as a height map, a .lode beside the scene that it "
      "was baked from, or builtin:NAME",
      options.scene)
      ->required();
  add_value(app, "--height", "SCALE",
            "Height of a height map's brightest sample, in widths of a sample (default: a quarter of its "
            "larger side)",
            [&](const std::string& text) {
              options.height_scale = float(parse_number("--height", text, 1e-6, 1e9));
            });
}

void add_environment_options(CLI::App& app, SceneOptions& options) {
  add_path(
      app, "--environment", "FILE",
      "Light and background from all directions instead of the scene's sky: an equirectangular .hdr or .exr, "
      "or a .png or .jpg",
      options.environment);
  add_value(app, "--environment-strength", "X", "What its radiance is multiplied by (default: 1)",
            [&](const std::string& text) {
              options.environment_strength = float(parse_number("--environment-strength", text, 0, 1e9));
            });
  add_value(app, "--environment-rotation", "DEGREES",
            "Turns it about +Y, from +X towards -Z; its centre is at +X (default: 0)",
            [&](const std::string& text) {
              options.environment_rotation = float(parse_number("--environment-rotation", text, -3600, 3600));
            });
}

std::optional<scene::Environment> load_environment(const SceneOptions& options) {
  if (options.environment.empty()) {
    const char* without = options.environment_strength   ? "--environment-strength"
                          : options.environment_rotation ? "--environment-rotation"
                                                         : nullptr;
    if (without != nullptr)
      fail(ExitCode::usage, without, "there is no environment map; name one with --environment FILE");
    return std::nullopt;
  }
  scene::Environment environment = scene::load_environment(options.environment);
  environment.strength = options.environment_strength.value_or(1.0f);
  environment.rotation = options.environment_rotation.value_or(0.0f);
  return environment;
}

scene::Scene load_scene(const SceneOptions& options) {
  constexpr std::string_view meshes[] = {".gltf", ".glb", ".obj", ".ply", ".stl"};
  const std::string extension = lower_extension(options.scene);
  check_atlas_options(options);
  const bool is_mesh = std::find(std::begin(meshes), std::end(meshes), extension) != std::end(meshes);
  if (options.height_scale != 0 && (is_mesh || options.scene.starts_with("builtin:")))
    fail(ExitCode::usage, "--height", "`{}` is no height map; leave the option out", options.scene);
  scene::Scene scene = scene::load(options.scene, {options.height_scale});
  check_resamples(options, scene);
  return scene;
}

void add_atlas_options(CLI::App& app, SceneOptions& options) {
  using geometry_image::AtlasKind;
  using geometry_image::Signal;
  static const std::map<std::string, AtlasKind> kinds = {{"auto", AtlasKind::automatic},
                                                         {"grid", AtlasKind::grid},
                                                         {"exact", AtlasKind::exact},
                                                         {"charts", AtlasKind::charts}};
  add_value(
      app, "--atlas", "NAME",
      "Charts of the geometry image: grid (meshes made of grids), charts (any mesh, resampled), exact (a "
      "chart a triangle) or auto (grid where it can be, else charts; default)",
      [&](const std::string& text) {
        parse_choice("--atlas", text, {"auto", "grid", "exact", "charts"});
        options.atlas.kind = kinds.at(text);
      });
  CLI::Option* resolution =
      add_value(app, "--resolution", "N", "With --atlas charts or auto: N x N texels in all",
                [&](const std::string& text) {
                  const uint64_t side = parse_count("--resolution", text, 2, max_resolution);
                  options.atlas.charts.texel_budget = side * side;
                  options.budget_option = "--resolution";
                });
  add_value(app, "--texel-budget", "N",
            "With --atlas charts or auto: N texels in all (default: about one a triangle)",
            [&](const std::string& text) {
              options.atlas.charts.texel_budget =
                  parse_count("--texel-budget", text, 4, uint64_t(max_resolution) * max_resolution);
              options.budget_option = "--texel-budget";
            })
      ->excludes(resolution);
  add_value(app, "--signal", "NAME",
            "With --atlas charts or auto: what gets more texels, area (even spacing, default), curvature "
            "(what bends) or screen (what looks larger from the scene's cameras in the rest pose)",
            [&](const std::string& text) {
              parse_choice("--signal", text, {"area", "curvature", "screen"});
              options.atlas.charts.signal = text == "area"        ? Signal::area
                                            : text == "curvature" ? Signal::curvature
                                                                  : Signal::screen;
            });
  app.add_flag("--all-shapes", options.atlas.charts.all_shapes,
               "With --atlas charts or auto: resample for what every morph target stretches, not for the "
               "rest pose alone");
  add_value(
      app, "--instancing", "MODE",
      "Keep a mesh that many nodes place once, with a hierarchy of its own, below one over its places: "
      "auto (where that at least halves the triangles, default), on (also what a node's animation moves "
      "as a whole), off",
      [&](const std::string& text) {
        parse_choice("--instancing", text, {"auto", "on", "off"});
        options.instancing = text == "auto" ? scene::Instancing::automatic
                             : text == "on" ? scene::Instancing::on
                                            : scene::Instancing::off;
      });
}

scene::Instancing instancing_of(const SceneOptions& options) {
  const geometry_image::ChartSettings& charts = options.atlas.charts;
  const char* needs_one = charts.keep_maps ? "the maps of charts, for relaxation,"
                          : charts.signal == geometry_image::Signal::screen ? "--signal screen"
                                                                            : options.one_object;
  if (needs_one == nullptr) return options.instancing;
  if (options.instancing == scene::Instancing::on)
    fail(ExitCode::usage, "--instancing", "{} needs all meshes where they are in the world; use off",
         needs_one);
  return scene::Instancing::off;
}

std::vector<std::string> tracer_names() {
  return {"geometry-image"};
}

void add_tracer_option(CLI::App& app) {
  add_value(app, "--tracer", "NAME", fmt::format("Tracer: {} (default)", join_names(tracer_names())),
            [](const std::string& text) { parse_choice("--tracer", text, tracer_names()); });
}

void add_pose_options(CLI::App& app, PoseOptions& options) {
  add_value(app, "--clip", "NAME", "Animation clip, by name or number (default: the first)",
            [&](const std::string& text) { options.clip = parse_name("--clip", text); });
  add_value(app, "--weights", "NAME=X,...",
            "Morph weights that override the animation, by target name or number",
            [&](const std::string& text) { options.weights = parse_weights("--weights", text); });
}

void add_frame_options(CLI::App& app, FrameOptions& options) {
  add_value(app, "--frames", "A-B", "Frames to render, both included (default: 0)",
            [&](const std::string& text) { options.frames = parse_frames("--frames", text); });
  add_value(app, "--fps", "N", "Frames a second: frame F shows the time F / N; a clip loops (default: 24)",
            [&](const std::string& text) { options.fps = parse_number("--fps", text, 1e-3, 1e6); });
  add_value(app, "--time", "S", "Time of the one frame in seconds instead; past the end of the clip it loops",
            [&](const std::string& text) { options.time = parse_number("--time", text, 0, 1e9); });
}

void check_frames(const FrameOptions& options) {
  if (options.time && options.range().count() > 1)
    fail(ExitCode::usage, "--time",
         "gives one moment, but --frames gives {} of them; leave one of the two out",
         options.range().count());
}

render::Traversal parse_traversal(const std::string& option, const std::string& text) {
  using render::Traversal;
  parse_choice(option, text, {"auto", "threaded", "octant", "wide", "tile"});
  return text == "threaded" ? Traversal::threaded
         : text == "octant" ? Traversal::octant
         : text == "wide"   ? Traversal::wide
         : text == "tile"   ? Traversal::tile
                            : Traversal::automatic;
}

void add_size_option(CLI::App& app, Size& size) {
  add_value(app, "--size", "WxH", fmt::format("Pixels (default: {}x{})", size.width, size.height),
            [&](const std::string& text) { size = parse_size("--size", text); });
}

void add_seed_option(CLI::App& app, uint32_t& seed) {
  add_value(app, "--seed", "N", "Seed of the random numbers (default: 0)", [&](const std::string& text) {
    seed = uint32_t(parse_count("--seed", text, 0, std::numeric_limits<uint32_t>::max()));
  });
}

namespace {

// N numbers, with commas between them.
template <size_t count>
std::array<double, count> parse_numbers(const std::string& option, const std::string& text, double reach) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  if (parts.size() != count)
    fail(ExitCode::usage, option, "`{}` is not {} numbers with commas between them", text, count);
  std::array<double, count> numbers;
  for (size_t i = 0; i < count; ++i) numbers[i] = parse_number(option, parts[i], -reach, reach);
  return numbers;
}

void add_place(CLI::App& app, const std::string& option, const std::string& help,
               std::optional<glm::vec3>& place) {
  add_value(app, option, "X,Y,Z", help, [&place, option](const std::string& text) {
    const auto [x, y, z] = parse_numbers<3>(option, text, 1e9);
    place = glm::vec3(x, y, z);
  });
}

}  // namespace

void add_camera_options(CLI::App& app, render::CameraChoice& camera) {
  add_value(
      app, "--camera", "NAME",
      "Camera of the scene, by name or number, or auto: one that sees the whole animation (default: the "
      "first, else auto)",
      [&](const std::string& text) { camera.name = parse_name("--camera", text); });
  add_value(
      app, "--orbit", "AZIMUTH,ELEVATION",
      "The auto camera from another side, in degrees: 0,0 is the front (from +Z), 90,0 from +X, 180,0 the "
      "back, 0,90 from above",
      [&](const std::string& text) {
        const auto [azimuth, elevation] = parse_numbers<2>("--orbit", text, 360);
        if (std::abs(elevation) > 90)
          fail(ExitCode::usage, "--orbit", "an elevation is between -90 and 90 degrees");
        camera.orbit = glm::vec2(azimuth, elevation);
      });
  add_value(
      app, "--fov", "DEGREES", "The camera's angle of view from bottom to top (default: its own; auto: 34.4)",
      [&](const std::string& text) { camera.field_of_view = float(parse_number("--fov", text, 0.01, 179)); });
  add_place(app, "--camera-from", "Where the camera stands, upright, in scene units", camera.from);
  add_place(app, "--camera-at",
            "What it looks at (default with --camera-from: the middle of all that the animation reaches)",
            camera.at);
}

void add_detail_option(CLI::App& app, SceneOptions& scene, float& pixels_of_error) {
  add_value(app, "--pixels-of-error", "X",
            fmt::format("Levels of detail: rays may see a coarser surface, one that looks at most so many "
                        "pixels away from the finest (0 to {}, default: 0, always the finest)",
                        most_pixels_of_error),
            [&](const std::string& text) {
              pixels_of_error = float(parse_number("--pixels-of-error", text, 0, most_pixels_of_error));
              if (pixels_of_error > 0) scene.one_object = "--pixels-of-error";
            });
}

void add_relaxation_option(CLI::App& app, SceneOptions& scene, uint32_t& sweeps) {
  add_value(
      app, "--relaxation-sweeps", "N",
      "Let the texels of resampled charts move N times a frame to where the pose bends and stretches the "
      "surface (default: 0; a .lode must have been baked with --keep-maps)",
      [&](const std::string& text) {
        sweeps = uint32_t(parse_count("--relaxation-sweeps", text, 0, max_sweeps));
        scene.atlas.charts.keep_maps = sweeps > 0;
      });
}

namespace {

void add_integrator_options(CLI::App& app, PictureOptions& options) {
  using render::Integrator;
  static const std::map<std::string, Integrator> integrators = {
      {"eye", Integrator::eye},           {"dof", Integrator::dof},       {"ao", Integrator::ao},
      {"specular", Integrator::specular}, {"glossy", Integrator::glossy}, {"path", Integrator::path}};
  add_value(app, "--integrator", "NAME",
            "eye (direct light where the camera's rays end; default), dof (the same through a lens), ao "
            "(ambient occlusion), specular (and what smooth surfaces mirror and refract), glossy (and what "
            "rough ones do) or path (all light, by path tracing). dof, ao, glossy and path want many --spp",
            [&](const std::string& text) {
              parse_choice("--integrator", text, {"eye", "dof", "ao", "specular", "glossy", "path"});
              options.integrator = integrators.at(text);
            });
  add_value(app, "--max-bounces", "N",
            "With specular, glossy and path: surfaces that a ray may go on from (default: 8)",
            [&](const std::string& text) {
              options.max_bounces = uint32_t(parse_count("--max-bounces", text, 0, max_bounces));
            });
  add_value(app, "--ao-distance", "X",
            "With --integrator ao: what is farther than X scene units does not occlude (default: all does)",
            [&](const std::string& text) {
              options.ao_distance = float(parse_number("--ao-distance", text, 1e-9, 1e30));
            });
  add_value(app, "--lens-radius", "X",
            "Radius of the camera's lens in scene units, with any integrator (default: 0, all is sharp; with "
            "dof a 40th of the focus distance)",
            [&](const std::string& text) {
              options.lens_radius = float(parse_number("--lens-radius", text, 1e-9, 1e9));
            });
  add_value(app, "--focus-distance", "X",
            "How far along the view direction things are sharp (default: where the nearest thing in the "
            "picture's middle is)",
            [&](const std::string& text) {
              options.focus_distance = float(parse_number("--focus-distance", text, 1e-9, 1e9));
            });
}

}  // namespace

void add_picture_options(CLI::App& app, PictureOptions& options) {
  add_size_option(app, options.size);
  add_value(app, "--spp", "N", "Samples a pixel (default: 1)",
            [&](const std::string& text) { options.spp = uint32_t(parse_count("--spp", text, 1, max_spp)); });
  add_seed_option(app, options.seed);
  add_camera_options(app, options.camera);
  add_value(app, "--traversal", "NAME",
            "threaded, octant, wide, tile, or auto: the fastest of the device (default). All give the "
            "same hits",
            [&](const std::string& text) { options.traversal = parse_traversal("--traversal", text); });
  add_integrator_options(app, options);
  app.add_flag(
      "--denoise", options.denoise,
      "Filter the noise out of the finished picture, guided by what surfaces are where and by how much "
      "samples differ (default: off). What the samples did not resolve (small shadows, reflections, "
      "refractions) is blurred: it looks cleaner than it is right. Wants --spp 2 or more");
}

namespace {

void warn_of_idle_options(const PictureOptions& options) {
  using render::Integrator;
  const Integrator integrator = options.integrator;
  const auto warn = [&](const char* option, const char* wants) {
    log::warn(fmt::format("{} has no effect on --integrator {}: it is for {}", option, to_string(integrator),
                          wants));
  };
  if (options.max_bounces &&
      (integrator == Integrator::eye || integrator == Integrator::dof || integrator == Integrator::ao))
    warn("--max-bounces", "specular, glossy and path");
  if (options.ao_distance && integrator != Integrator::ao) warn("--ao-distance", "ao");
  if (options.focus_distance > 0 && options.lens_radius == 0 && integrator != Integrator::dof)
    warn("--focus-distance", "dof, or any other with --lens-radius");
}

}  // namespace

render::Settings picture_settings(const PictureOptions& options) {
  warn_of_idle_options(options);
  render::Settings settings;
  settings.width = options.size.width;
  settings.height = options.size.height;
  settings.spp = options.spp;
  settings.seed = options.seed;
  settings.traversal = options.traversal;
  settings.integrator = options.integrator;
  settings.max_bounces = options.max_bounces.value_or(settings.max_bounces);
  settings.ao_distance = options.ao_distance.value_or(settings.ao_distance);
  settings.lens_radius = options.lens_radius;
  settings.focus_distance = options.focus_distance;
  settings.denoise = options.denoise;
  return settings;
}

std::vector<std::string> aov_names() {
  return {"depth", "normal", "albedo", "uv", "id", "lod", "steps"};
}

void add_threads_option(CLI::App& app, uint32_t& threads) {
  add_value(app, "--threads", "N", "CPU threads (default: all)", [&](const std::string& text) {
    threads = uint32_t(parse_count("--threads", text, 1, max_threads));
  });
}

void add_device_options(CLI::App& app, DeviceOptions& options) {
  add_value(
      app, "--device", "DEVICE",
      "cpu; gpu: the first Vulkan device; its INDEX or part of its NAME as `lodestone devices` lists them; "
      "auto: a GPU, else any Vulkan device, else the CPU (default)",
      [&](const std::string& text) { options.device = parse_name("--device", text); });
  add_value(app, "--device-memory", "SIZE",
            "Bytes that may be in use on the device, as in 800M or 2G (default: all there are); a scene that "
            "does not fit goes through it in portions, and the picture is the same",
            [&](const std::string& text) { options.memory = parse_bytes("--device-memory", text); });
  add_threads_option(app, options.backend.threads);
  app.add_flag("--validate", options.backend.validate,
               "Run the Vulkan validation layers; any message is an error");
}

void add_log_options(CLI::App& app) {
  auto* verbose = app.add_flag_callback(
      "-v,--verbose", [] { log::set_level(log::Level::verbose); }, "Say more, on standard error");
  auto* quiet = app.add_flag_callback(
      "-q,--quiet", [] { log::set_level(log::Level::quiet); }, "Say nothing but errors");
  verbose->excludes(quiet);
}

}  // namespace lodestone::app
