// SPDX-License-Identifier: MIT
#include "lodestone/app/parity_command.h"

#include <fmt/format.h>
#include <CLI/App.hpp>

#include <algorithm>
#include <bit>
#include <memory>
#include <optional>

#include "lodestone/app/common_options.h"
#include "lodestone/app/interrupt.h"
#include "lodestone/app/open_device.h"
#include "lodestone/app/output_path.h"
#include "lodestone/app/prepared_scene.h"
#include "lodestone/app/shutter.h"
#include "lodestone/app/thread_limit.h"
#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"
#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/render/renderer.h"

namespace lodestone::app {
namespace {

using render::PassDifference;

PictureOptions small_picture() {
  PictureOptions picture;
  picture.size = {128, 128};
  return picture;
}

struct ParityOptions {
  SceneOptions scene;
  PoseOptions pose;
  FrameOptions frames;
  PictureOptions picture = small_picture();
  uint32_t relaxation_sweeps = 0;
  float pixels_of_error = 0;
  ShutterOptions shutter;
  DeviceOptions device;
  std::optional<render::Fault> fault;
  std::string log;
};

render::Fault parse_fault(const std::string& text) {
  const size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0)
    fail(ExitCode::usage, "--fault", "`{}` is not PASS:BIT, e.g. bounds:7", text);
  constexpr uint64_t last_bit = (uint64_t(1) << 32) - 1;
  return {text.substr(0, colon), uint32_t(parse_count("--fault", text.substr(colon + 1), 0, last_bit))};
}

// A word as the bits it is and the number they may stand for.
std::string word_text(uint32_t word) {
  return fmt::format("{:08x} ({:.9g})", word, std::bit_cast<float>(word));
}

std::string table(const std::vector<PassDifference>& differences) {
  constexpr const char* row = "{:<14} {:<18} {:>10} {:>14} {:>12}  {}\n";
  std::string text = fmt::format(fmt::runtime(row), "pass", "buffer", "dispatches", "words", "different",
                                 "first difference: device, CPU");
  for (const PassDifference& difference : differences) {
    const std::string first = difference.different == 0 ? "-"
                                                        : fmt::format("word {}: {}, {}", difference.first,
                                                                      word_text(difference.device_value),
                                                                      word_text(difference.reference_value));
    text += fmt::format(fmt::runtime(row), difference.pass, difference.buffer, difference.dispatches,
                        difference.words, difference.different, first);
  }
  return text;
}

// The passes that ran, each once.
std::vector<std::string> pass_names(const std::vector<PassDifference>& differences) {
  std::vector<std::string> names;
  for (const PassDifference& difference : differences) {
    if (std::find(names.begin(), names.end(), difference.pass) == names.end())
      names.push_back(difference.pass);
  }
  return names;
}

// Every frame, all its channels. Throws Error(interrupted).
void render_frames(const ParityOptions& options, const PreparedScene& prepared, render::Backend& backend) {
  render::Settings settings = picture_settings(options.picture);
  settings.relaxation_sweeps = options.relaxation_sweeps;
  settings.pixels_of_error = options.pixels_of_error;
  settings.shutter_segments = options.shutter.settled_segments();
  settings.device_memory = options.device.memory;
  settings.aovs = aov_names();
  scene::Bounds bounds;
  if (options.picture.camera.needs_bounds(prepared.scene)) bounds = prepared.bounds();
  render::Renderer renderer(backend, prepared.scene, prepared.assembly, prepared.atlas, settings);
  const FrameRange range = options.frames.range();
  for (uint32_t frame = range.first; frame <= range.last; ++frame) {
    const double seconds = prepared.wrap(options.frames.seconds(frame));
    const scene::Pose pose = prepared.pose_at(seconds);
    const render::View view = view_of(prepared, pose, options.picture, bounds);
    if (!renderer.render(
            pose, view, interrupted,
            shutter_moments(options.shutter, prepared, options.picture, bounds, seconds, options.frames.fps)))
      fail(ExitCode::interrupted, "parity", "interrupted");
  }
}

// Prints the table, and the summary where all is equal. Throws Error(different) naming the first pass that is
// not.
int report(const ParityOptions& options, const render::ParityBackend& parity) {
  const std::vector<PassDifference>& differences = parity.differences();
  const std::vector<std::string> passes = pass_names(differences);
  if (options.fault && std::find(passes.begin(), passes.end(), options.fault->pass) == passes.end())
    fail(ExitCode::usage, "--fault", "no pass `{}` ran; there is {}", options.fault->pass,
         join_names(passes));
  const std::string device = parity.info().name;
  const auto different = std::find_if(differences.begin(), differences.end(),
                                      [](const PassDifference& row) { return row.different > 0; });
  uint64_t words = 0;
  for (const PassDifference& difference : differences) words += difference.words;
  std::string text = table(differences);
  if (different == differences.end())
    text += fmt::format("parity: equal, {} passes, {} words on {} against the CPU\n", passes.size(), words,
                        device);
  if (!options.log.empty()) write_file(options.log, text);
  if (log::level() != log::Level::quiet) fmt::print("{}", text);
  if (different == differences.end()) return int(ExitCode::done);
  fail(ExitCode::different, options.scene.scene,
       "the pass `{}` is the first that differs on {}: {} of {} words of its buffer `{}`, first word {}: {} "
       "there, "
       "{} on the CPU",
       different->pass, device, different->different, different->words, different->buffer, different->first,
       word_text(different->device_value), word_text(different->reference_value));
}

int run_parity(const ParityOptions& options) {
  if (options.device.device == "cpu")
    fail(ExitCode::usage, "--device cpu",
         "would compare the CPU with itself; give gpu, or a device as `lodestone devices` lists it");
  check_frames(options.frames);
  check_distinct({{"--log", options.log}},
                 {{"the scene", options.scene.scene}, {"the environment map", options.scene.environment}});
  if (!options.log.empty()) check_writable(options.log);
  const ThreadLimit threads(options.device.backend.threads);
  // Without a Vulkan device there is nothing to compare: `auto` must not become the CPU.
  DeviceOptions wanted = options.device;
  if (wanted.device == "auto") wanted.device = "gpu";
  OpenDevice device = open_device(wanted);
  const PreparedScene prepared = prepare_scene(options.scene, options.pose);
  check_distinct({{"--log", options.log}}, {{"the scene", prepared.scene.name}});  // which a .lode has named
  const auto cpu = cpu_fallback::make_cpu_backend(options.device.backend);
  render::ParityBackend parity(*device.backend, *cpu, options.fault);
  const KeepResults keep;
  render_frames(options, prepared, parity);
  return report(options, parity);
}

}  // namespace

void add_parity_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* command =
      app.add_subcommand("parity", "Run every pass on a device and on the CPU and compare the bits");
  auto options = std::make_shared<ParityOptions>();
  add_scene_argument(*command, options->scene);
  add_environment_options(*command, options->scene);
  add_tracer_option(*command);
  add_atlas_options(*command, options->scene);
  add_relaxation_option(*command, options->scene, options->relaxation_sweeps);
  add_detail_option(*command, options->scene, options->pixels_of_error);
  add_picture_options(*command, options->picture);
  add_frame_options(*command, options->frames);
  add_shutter_options(*command, options->shutter);
  add_pose_options(*command, options->pose);
  add_device_options(*command, options->device);
  add_value(*command, "--fault", "PASS:BIT",
            "Flip one bit of what a pass wrote on the device: it must be found",
            [options = options.get()](const std::string& text) { options->fault = parse_fault(text); });
  add_path(*command, "--log", "FILE", "Write the table to a file too", options->log);
  add_log_options(*command);
  command->footer("Example: lodestone parity Fox.glb --device gpu --frames 0-3");
  command->callback([options, &run] {
    run = [options] {
      settle_shutter(options->shutter, options->scene);
      return run_parity(*options);
    };
  });
}

}  // namespace lodestone::app
