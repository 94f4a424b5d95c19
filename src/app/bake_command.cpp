// SPDX-License-Identifier: MIT
#include "lodestone/app/bake_command.h"

#include <fmt/format.h>
#include <CLI/App.hpp>

#include <memory>
#include <optional>

#include "lodestone/app/atlas_image.h"
#include "lodestone/app/atlas_text.h"
#include "lodestone/app/baked_scene.h"
#include "lodestone/app/common_options.h"
#include "lodestone/app/output_path.h"
#include "lodestone/app/stage_clock.h"
#include "lodestone/app/thread_limit.h"
#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/geometry_image/atlas.h"
#include "lodestone/geometry_image/fidelity.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::app {
namespace {

struct BakeOptions {
  SceneOptions scene;
  std::string output, atlas_image;
  uint32_t threads = 0;
};

int run_bake(const BakeOptions& options) {
  const std::filesystem::path output = options.output;
  if (lower_extension(output) != ".lode")
    fail(ExitCode::usage, "-o", "`{}` does not end in .lode, as baked files do", options.output);
  check_writable(output);
  if (is_baked(options.scene.scene))
    fail(ExitCode::usage, options.scene.scene, "is baked already; give the scene that it was baked from");
  const AtlasImageFiles pictures(options.atlas_image);
  pictures.check(options.scene.scene);
  const ThreadLimit threads(options.threads);
  const scene::Scene scene = load_scene(options.scene);
  const scene::Assembly assembly = scene::assemble(scene, instancing_of(options.scene));
  StageClock clock(options.scene.scene);
  const geometry_image::Atlas atlas = geometry_image::build_atlas(
      scene, assembly, options.scene.atlas, [&](const char* stage) { clock.begin(stage); });
  clock.begin("distance");
  const std::optional<geometry_image::Fidelity> fidelity =
      geometry_image::measure_fidelity(scene, assembly, atlas, scene::evaluate(scene, scene::none, 0));
  const std::string hash = geometry_image::atlas_hash(scene, assembly, options.scene.atlas);
  geometry_image::save_atlas(output, atlas, record_of(options.scene, output, hash));
  std::string text = atlas_text(options.output, atlas, fidelity);
  if (!pictures.empty()) {
    clock.begin("pictures");
    text += pictures.write(scene, assembly, atlas);
  }
  clock.end();
  text += fmt::format("  time             {}\n", stage_text(clock.stages()));
  for (const std::string& note : atlas.report.notes) log::note(options.scene.scene + ": " + note);
  if (log::level() != log::Level::quiet) fmt::print("{}", text);
  return int(ExitCode::done);
}

}  // namespace

void add_bake_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* command = app.add_subcommand("bake", "Do the precomputation alone and keep it in a .lode file");
  auto options = std::make_shared<BakeOptions>();
  add_scene_argument(*command, options->scene);
  add_path(*command, "-o,--output", "FILE.lode", "The baked file", options->output)->required();
  add_tracer_option(*command);
  add_atlas_options(*command, options->scene);
  command->add_flag("--keep-maps", options->scene.atlas.charts.keep_maps,
                    "Keep the maps of resampled charts, which --relaxation-sweeps needs");
  add_path(*command, "--atlas-image", "NAME.png", atlas_image_help, options->atlas_image);
  add_threads_option(*command, options->threads);
  add_log_options(*command);
  command->footer(
      std::string(stretch_help) +
      "The file is a scene itself, as long as the one that it was baked from lies in its folder or below.\n"
      "Example: lodestone bake stanford_dragon.ply -o dragon.lode");
  command->callback([options, &run] { run = [options] { return run_bake(*options); }; });
}

}  // namespace lodestone::app
