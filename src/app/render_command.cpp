// SPDX-License-Identifier: MIT
#include "lodestone/app/render_command.h"

#include <fmt/format.h>
#include <CLI/App.hpp>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "lodestone/app/camera_metadata.h"
#include "lodestone/app/clock.h"
#include "lodestone/app/common_options.h"
#include "lodestone/app/contact_sheet_file.h"
#include "lodestone/app/frame_writer.h"
#include "lodestone/app/interrupt.h"
#include "lodestone/app/measure.h"
#include "lodestone/app/open_device.h"
#include "lodestone/app/output_path.h"
#include "lodestone/app/prepared_scene.h"
#include "lodestone/app/shutter.h"
#include "lodestone/app/thread_limit.h"
#include "lodestone/app/version.h"
#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"
#include "lodestone/render/denoiser.h"
#include "lodestone/report/chrome_trace.h"
#include "lodestone/report/pass_table.h"
#include "lodestone/report/progress.h"
#include "lodestone/report/statistics.h"

namespace lodestone::app {
namespace {

struct RenderOptions {
  SceneOptions scene;
  PoseOptions pose;
  FrameOptions frames;
  uint32_t relaxation_sweeps = 0;
  float pixels_of_error = 0;
  ShutterOptions shutter;
  PictureOptions picture;
  DeviceOptions device;
  std::vector<std::string> aovs;
  bool noisy = false;  // is asked for like them
  bool progressive = false;
  float exposure = 0;
  render::ViewTransform view = render::ViewTransform::filmic;
  std::string output, contact_sheet, statistics, profile;
  report::ProgressMode progress = report::ProgressMode::automatic;
};

std::vector<NamedFile> reports_of(const RenderOptions& options) {
  return {{"--contact-sheet", options.contact_sheet},
          {"--stats", options.statistics},
          {"--profile", options.profile}};
}

// Throws Error(usage) where something that is written would replace the scene or its environment map.
void check_keeps(const RenderOptions& options, const OutputPattern& output, const std::string& scene) {
  const std::vector<NamedFile> kept = {{"the scene", scene},
                                       {"the environment map", options.scene.environment}};
  check_distinct(reports_of(options), kept);
  for (const NamedFile& file : kept) {
    if (!file.path.empty() && output.writes(file.path, options.frames.range()))
      fail(ExitCode::usage, "-o", "`{}` is {}, which would be overwritten; name another file",
           file.path.string(), file.option);
  }
}

// Checks what no single option can say, and that everything asked for can be written.
OutputPattern check(const RenderOptions& options) {
  const OutputPattern output("-o", options.output);
  check_frames(options.frames);
  if (options.frames.range().count() > 1 && !output.numbered())
    fail(ExitCode::usage, "-o", "`{}` names one file for {} frames; put #### where the frame number goes",
         options.output, options.frames.range().count());
  if (output.is_png() && (!options.aovs.empty() || options.noisy))
    fail(ExitCode::usage, "--aov", "a PNG holds the picture alone; write an .exr with -o");
  if (options.noisy && !options.picture.denoise)
    fail(ExitCode::usage, "--aov", "`noisy` is the picture before --denoise, which is not given");
  const std::vector<NamedFile> reports = reports_of(options);
  check_keeps(options, output, options.scene.scene);
  for (const NamedFile& report : reports) {
    if (!report.path.empty() && output.writes(report.path, options.frames.range()))
      fail(ExitCode::usage, report.option, "`{}` is what -o writes already; give each a file of its own",
           report.path.string());
  }
  check_writable(output.path(options.frames.range().first));
  for (const NamedFile& report : reports) {
    if (!report.path.empty()) check_writable(report.path);
  }
  return output;
}

render::Settings settings_of(const RenderOptions& options) {
  render::Settings settings = picture_settings(options.picture);
  settings.relaxation_sweeps = options.relaxation_sweeps;
  settings.pixels_of_error = options.pixels_of_error;
  settings.shutter_segments = options.shutter.settled_segments();
  settings.device_memory = options.device.memory;
  settings.view = options.view;
  settings.exposure = options.exposure;
  settings.aovs = options.aovs;
  settings.noisy = options.noisy;
  settings.progressive = options.progressive;
  return settings;
}

// As --weights takes them.
std::string weights_text(const std::map<std::string, float>& weights) {
  std::string text;
  for (const auto& [name, weight] : weights)
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", name, weight);
  return text;
}

// Of a scene that goes through the device, from how many on it takes very long.
constexpr uint32_t many_portions = 500;

// One run of `lodestone render`.
class RenderRun {
 public:
  explicit RenderRun(const RenderOptions& options);
  int run();

 private:
  // Renders until done or interrupted.
  void render_frames();
  bool render_frame(uint32_t frame);
  std::map<std::string, std::string> provenance(const report::Frame& frame, const render::View& view,
                                                uint32_t samples) const;
  // As far as it has got.
  void write_picture(const report::Frame& frame, const render::View& view, render::FrameResult& result);
  void write_reports() const;

  const RenderOptions& options_;
  OutputPattern output_;
  ThreadLimit threads_;
  OpenDevice device_;
  PreparedScene prepared_;
  std::optional<render::Renderer> renderer_;
  scene::Bounds bounds_;
  report::RunRecord measured_;
  FrameWriter writer_;
  ContactSheetFile sheet_;
  report::Progress progress_;
};

RenderRun::RenderRun(const RenderOptions& options)
    : options_(options),
      output_(check(options)),
      threads_(options.device.backend.threads),
      device_(open_device(options.device)),
      prepared_(
          prepare_scene(options.scene, options.pose, options.progress == report::ProgressMode::automatic)),
      sheet_(options.contact_sheet, options.frames.range().count()),
      progress_(log::level() == log::Level::quiet && options.progress == report::ProgressMode::automatic
                    ? report::ProgressMode::off
                    : options.progress,
                options.frames.range().count()) {
  check_keeps(options, output_, prepared_.scene.name);  // which a .lode file has named
  measured_ =
      describe_run("render", options.scene.scene, prepared_, options.picture, device_.backend->info());
  if (options.picture.camera.needs_bounds(prepared_.scene)) bounds_ = prepared_.bounds();
  const double start = now_ms();
  renderer_.emplace(*device_.backend, prepared_.scene, prepared_.assembly, prepared_.atlas,
                    settings_of(options));
  measured_.settings.traversal = to_string(renderer_->traversal());
  measured_.setup = to_dispatches(renderer_->setup_passes(), device_.origin_ms);
  measured_.precompute.push_back({"links", start, now_ms() - start});
  if (const auto streaming = renderer_->streaming(); streaming && streaming->portions > many_portions) {
    log::warn(
        fmt::format("--device-memory leaves so little for the scene that it comes in {} portions, each for "
                    "every kind of ray: "
                    "more memory, or a smaller picture, is much faster",
                    streaming->portions));
  }
  if (options_.picture.denoise) log::note("denoise: " + render::denoise_description());
  log::note(fmt::format("{}: {} traversal", device_.backend->info().name, to_string(renderer_->traversal())));
}

std::map<std::string, std::string> RenderRun::provenance(const report::Frame& frame, const render::View& view,
                                                         uint32_t samples) const {
  const render::DeviceInfo& device = device_.backend->info();
  // As in the statistics: device times, null where a kernel was only compiled; wall times on the CPU.
  nlohmann::ordered_json times = nlohmann::ordered_json::object();
  for (const report::PassSum& pass : report::sum_by_name(frame.dispatches)) {
    if (device.kind == "cpu")
      times[pass.name] = pass.wall_ms;
    else
      times[pass.name] = pass.device_ms ? nlohmann::ordered_json(*pass.device_ms) : nullptr;
  }
  std::map<std::string, std::string> text = {
      {"version", version()},
      {"commit", commit()},
      {"device", device.name},
      {"driver", device.driver},
      {"scene", options_.scene.scene},
      {"tracer", measured_.tracer},
      {"traversal", to_string(renderer_->traversal())},
      {"integrator", to_string(options_.picture.integrator)},
      {"seed", std::to_string(options_.picture.seed)},
      {"spp", std::to_string(samples)},
      {"frame", std::to_string(frame.frame)},
      {"time", fmt::format("{}", frame.time_s)},
      {"camera", view.name},
      {"clip", prepared_.clip_name()},
      {"weights", weights_text(options_.pose.weights)},
      {"wall_ms", fmt::format("{}", frame.wall_ms)},  // the only ones that differ between two runs
      {"pass_ms", times.dump()},
  };
  if (const uint32_t segments = options_.shutter.settled_segments(); segments > 0) {
    text["shutter"] = fmt::format("{}", options_.shutter.open / options_.frames.fps);  // seconds
    text["shutter_segments"] = std::to_string(segments);
  }
  if (options_.pixels_of_error > 0) text["pixels_of_error"] = fmt::format("{}", options_.pixels_of_error);
  if (options_.picture.denoise) text["denoise"] = render::denoise_description();
  if (const std::optional<scene::Environment>& environment = prepared_.scene.environment) {
    text["environment"] = environment->file;
    text["environment_strength"] = fmt::format("{}", environment->strength);
    text["environment_rotation"] = fmt::format("{}", environment->rotation);
  }
  if (output_.is_png()) {
    text["exposure"] = fmt::format("{}", options_.exposure);
    text["view"] = options_.view == render::ViewTransform::linear ? "linear" : "filmic";
  }
  std::map<std::string, std::string> metadata;
  for (auto& [name, value] : text) {
    if (!value.empty()) metadata["lodestone:" + name] = std::move(value);
  }
  return metadata;
}

bool RenderRun::render_frame(uint32_t frame) {
  report::Frame measured;
  measured.frame = frame;
  measured.time_s = prepared_.wrap(options_.frames.seconds(frame));
  measured.start_ms = now_ms();
  const scene::Pose pose = prepared_.pose_at(measured.time_s);
  const render::View view = view_of(prepared_, pose, options_.picture, bounds_);
  measured_.settings.camera = view.name;
  const auto stop = [this] {
    progress_.tick();
    return interrupted();
  };
  const auto on_samples = [&](uint32_t, const std::function<render::FrameResult()>& picture) {
    render::FrameResult so_far = picture();
    measured.wall_ms = now_ms() - measured.start_ms;
    write_picture(measured, view, so_far);
  };
  std::optional<render::FrameResult> result =
      renderer_->render(pose, view, stop,
                        shutter_moments(options_.shutter, prepared_, options_.picture, bounds_,
                                        measured.time_s, options_.frames.fps),
                        on_samples);
  if (!result) return false;
  measured.wall_ms = result->wall_ms;
  measured.dispatches = to_dispatches(result->passes, device_.origin_ms);
  sheet_.add(static_cast<uint32_t>(measured_.frames.size()), frame, result->display);
  write_picture(measured, view, *result);
  if (result->samples < options_.picture.spp) {
    log::warn(fmt::format("interrupted: frame {} has at least {} of {} samples a pixel", frame,
                          result->samples, options_.picture.spp));
    return false;
  }
  // Nobody reads them, and a long sequence has many.
  if (options_.statistics.empty() && options_.profile.empty() && log::level() != log::Level::verbose)
    measured.dispatches = {};
  measured_.frames.push_back(std::move(measured));
  progress_.frame_done();
  return true;
}

void RenderRun::write_picture(const report::Frame& frame, const render::View& view,
                              render::FrameResult& result) {
  image::Image image = std::move(output_.is_png() ? result.display : result.linear);
  image.metadata = provenance(frame, view, result.samples);
  add_camera(view, image);
  writer_.push(output_.path(frame.frame), std::move(image));
}

void RenderRun::render_frames() {
  const FrameRange range = options_.frames.range();
  try {
    for (uint32_t frame = range.first; frame <= range.last && !interrupted(); ++frame) {
      if (!render_frame(frame)) break;
    }
  } catch (...) {
    writer_.finish();  // what went wrong with an earlier frame comes first
    throw;
  }
  writer_.finish();
}

void RenderRun::write_reports() const {
  if (!options_.statistics.empty()) write_file(options_.statistics, report::statistics_json(measured_));
  if (!options_.profile.empty()) write_file(options_.profile, report::chrome_trace(measured_));
  if (log::level() == log::Level::verbose)
    fmt::print(stderr, "{}", report::pass_table(report::sum_by_name(report::frame_dispatches(measured_))));
}

int RenderRun::run() {
  const KeepResults keep;
  render_frames();
  progress_.clear();
  measured_.device_bytes = device_.backend->allocated_bytes();
  if (const auto streaming = renderer_->streaming()) {
    measured_.streaming = {streaming->portions, streaming->loads, streaming->peak_bytes};
    log::note(fmt::format("{} portions of the scene went through {:.0f} MB on the device, {} loads",
                          streaming->portions, double(streaming->peak_bytes) / 1e6, streaming->loads));
  }
  sheet_.write();
  write_reports();
  const uint32_t wanted = options_.frames.range().count();
  if (measured_.frames.size() == wanted) return int(ExitCode::done);
  log::warn(fmt::format("interrupted: {} of {} frames are written", measured_.frames.size(), wanted));
  return int(ExitCode::interrupted);
}

void add_output_options(CLI::App& app, RenderOptions& options) {
  add_path(app, "-o,--output", "OUT",
           "An .exr (linear, with AOVs) or .png (for display); #### in its name becomes the frame number",
           options.output)
      ->required();
  add_path(app, "--contact-sheet", "FILE.png",
           "Also write up to 24 frames of the sequence, as displayed, on one sheet", options.contact_sheet);
  app.add_flag(
      "--progressive", options.progressive,
      "Write each picture after 1, 2, 4, ... samples a pixel too, over the one before; Ctrl-C keeps what "
      "there is of it");
  add_value(app, "--aov", "LIST",
            fmt::format("More channels of an .exr: {}, and with --denoise noisy, the picture before it",
                        join_names(aov_names())),
            [&](const std::string& text) {
              std::vector<std::string> names = aov_names();
              names.push_back("noisy");
              options.aovs = parse_list("--aov", text);
              for (const std::string& name : options.aovs) parse_choice("--aov", name, names);
              options.noisy = std::erase(options.aovs, "noisy") > 0;
            });
  add_value(
      app, "--exposure", "EV", "Stops brighter or darker, of a .png and a contact sheet (default: 0)",
      [&](const std::string& text) { options.exposure = float(parse_number("--exposure", text, -64, 64)); });
  add_value(app, "--view", "NAME", "Tone curve of a .png and a contact sheet: filmic (default) or linear",
            [&](const std::string& text) {
              options.view = parse_choice("--view", text, {"filmic", "linear"}) == "linear"
                                 ? render::ViewTransform::linear
                                 : render::ViewTransform::filmic;
            });
}

void add_report_options(CLI::App& app, RenderOptions& options) {
  add_path(app, "--stats", "FILE.json", "Write times and counters as JSON", options.statistics);
  add_path(app, "--profile", "FILE.json", "Write a Chrome trace, for Perfetto", options.profile);
  app.add_flag("--counters", options.device.backend.counters,
               "Count rays, visits, tests and memory traffic (slower)");
  add_value(app, "--progress", "MODE", "auto (default), off, or json: a line a frame, all on standard error",
            [&](const std::string& text) {
              parse_choice("--progress", text, {"auto", "off", "json"});
              options.progress = text == "off"    ? report::ProgressMode::off
                                 : text == "json" ? report::ProgressMode::json
                                                  : report::ProgressMode::automatic;
            });
}

}  // namespace

void add_render_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* command = app.add_subcommand("render", "Render one image, or a sequence of them");
  auto options = std::make_shared<RenderOptions>();
  add_scene_argument(*command, options->scene);
  add_output_options(*command, *options);
  add_tracer_option(*command);
  add_atlas_options(*command, options->scene);
  add_relaxation_option(*command, options->scene, options->relaxation_sweeps);
  add_detail_option(*command, options->scene, options->pixels_of_error);
  add_environment_options(*command, options->scene);
  add_picture_options(*command, options->picture);
  add_frame_options(*command, options->frames);
  add_shutter_options(*command, options->shutter);
  add_pose_options(*command, options->pose);
  add_device_options(*command, options->device);
  add_report_options(*command, *options);
  add_log_options(*command);
  command->footer(
      "A clip loops: frame F shows the time F / fps, wrapped into the clip.\n"
      "Example: lodestone render Fox.glb -o fox.####.exr --frames 0-47 --clip Run --aov depth,normal");
  command->callback([options, &run] {
    run = [options] {
      settle_shutter(options->shutter, options->scene);
      return RenderRun(*options).run();
    };
  });
}

}  // namespace lodestone::app
