// SPDX-License-Identifier: MIT
#include "lodestone/app/info_command.h"

#include <fmt/format.h>
#include <CLI/App.hpp>

#include <algorithm>
#include <memory>

#include "lodestone/app/common_options.h"
#include "lodestone/app/describe.h"
#include "lodestone/app/output_path.h"
#include "lodestone/base/error.h"

namespace lodestone::app {
namespace {

struct InfoOptions {
  SceneOptions scene;
  bool height_map = false;  // an image is a scene
  bool json = false;
};

bool is_image(const std::string& extension) {
  constexpr const char* known[] = {".png", ".exr", ".tif", ".tiff", ".jpg", ".jpeg"};
  return std::find(std::begin(known), std::end(known), extension) != std::end(known);
}

nlohmann::ordered_json describe(const InfoOptions& options) {
  const std::string extension = lower_extension(options.scene.scene);
  if (extension == ".lode") return describe_baked(options.scene.scene);
  if (is_image(extension) && !options.height_map) return describe_image(options.scene.scene);
  return describe_scene(options.scene);
}

int run_info(const InfoOptions& options) {
  const nlohmann::ordered_json description = describe(options);
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  fmt::print("{}", options.json ? description.dump(2, ' ', false, replace) + "\n" : plain_text(description));
  return int(ExitCode::done);
}

}  // namespace

void add_info_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* command = app.add_subcommand("info", "Say what a scene, a baked file or an image holds");
  auto options = std::make_shared<InfoOptions>();
  add_path(*command, "FILE", "", "A scene, as `lodestone render` takes it, a .lode or an image",
           options->scene.scene)
      ->required();
  command->add_flag("--json", options->json, "Print JSON");
  command->add_flag("--height-map", options->height_map, "Take an image for a scene: a height map");
  add_atlas_options(*command, options->scene);
  add_log_options(*command);
  command->footer("Example: lodestone info Fox.glb --json");
  command->callback([options, &run] { run = [options] { return run_info(*options); }; });
}

}  // namespace lodestone::app
