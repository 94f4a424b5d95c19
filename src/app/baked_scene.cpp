// SPDX-License-Identifier: MIT
#include "lodestone/app/baked_scene.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "lodestone/app/output_path.h"
#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/asset_folder.h"

namespace lodestone::app {
namespace fs = std::filesystem;
namespace {

bool is_builtin(const std::string& scene) {
  return scene.starts_with("builtin:");
}

fs::path folder_of(const fs::path& file) {
  const fs::path parent = file.parent_path();
  return fs::canonical(parent.empty() ? fs::path(".") : parent);
}

// Whether a .lode at `output` that records `recorded` would find this very scene.
bool finds(const fs::path& output, const std::string& recorded, const fs::path& scene) {
  try {
    return scene::AssetFolder(output).find(recorded) == fs::canonical(scene);
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

bool is_baked(const std::string& scene) {
  return !is_builtin(scene) && lower_extension(scene) == ".lode";
}

BakedScene::BakedScene(const SceneOptions& options) : file_(options.scene) {
  if (options.height_scale != 0)
    fail(ExitCode::usage, "--height", "`{}` was baked with a height of its own; leave the option out", file_);
  atlas_ = geometry_image::load_atlas(file_, &record_);
  if (options.atlas.charts.keep_maps && atlas_.report.mapped_charts > 0 && atlas_.maps.empty()) {
    fail(ExitCode::usage, "--relaxation-sweeps",
         "`{}` was baked without the maps of its charts; bake it again with --keep-maps", file_);
  }
  if (options.instancing != scene::Instancing::automatic && options.instancing != record_.instancing)
    fail(ExitCode::usage, "--instancing", "`{}` was baked with another mode; leave the option out", file_);
  geometry_image::AtlasSettings asked = options.atlas;
  asked.charts.keep_maps = false;  // a file that has them serves both
  // What it is may be asked for by name, whatever it was asked for as.
  if (asked.kind == atlas_.kind && asked.charts == geometry_image::ChartSettings{}) asked = {};
  if (asked != geometry_image::AtlasSettings{}) asked.charts.keep_maps = record_.asked.charts.keep_maps;
  if (asked != geometry_image::AtlasSettings{} && asked != record_.asked)
    fail(ExitCode::usage, "--atlas", "`{}` was baked with another one; leave the option out or bake it again",
         file_);
  if (record_.scene.empty())
    fail_input(file_, "does not say what it was baked from; give that scene, or `lodestone bake` it again");
}

scene::Scene BakedScene::load() const {
  SceneOptions source;
  source.scene = record_.scene;
  source.height_scale = record_.height_scale;
  if (!is_builtin(record_.scene)) {
    try {
      source.scene = scene::AssetFolder(file_).find(record_.scene).string();
    } catch (const Error&) {
      fail_input(file_, "was baked from `{}`, which is no file in its folder; put it there or bake it again",
                 record_.scene);
    }
  }
  try {
    return load_scene(source);
  } catch (const Error& error) {
    if (error.code() != ExitCode::usage) throw;
    fail_input(file_, "names a scene that there cannot be ({}); bake it again", error.what());
  }
}

geometry_image::Atlas BakedScene::take_atlas(const scene::Scene& scene, const scene::Assembly& assembly) {
  const bool same = atlas_.report.triangles == assembly.triangles.size() &&
                    geometry_image::atlas_hash(scene, assembly, record_.asked) == record_.content_hash;
  if (!same)
    fail_input(file_, "`{}` has changed since it was baked (or the program has); bake it again",
               record_.scene);
  return std::move(atlas_);
}

geometry_image::BakeRecord record_of(const SceneOptions& options, const fs::path& output,
                                     const std::string& content_hash) {
  geometry_image::BakeRecord record = {content_hash, options.scene, options.height_scale, options.atlas,
                                       instancing_of(options)};
  if (is_builtin(options.scene)) return record;
  // The folder is resolved, so that two names for it are one; the file is not, for what it names itself is
  // looked for beside it.
  const fs::path scene = options.scene;
  const fs::path relative = (folder_of(scene) / scene.filename()).lexically_relative(folder_of(output));
  const bool below = !relative.empty() && *relative.begin() != "..";
  record.scene = (below ? relative : scene.filename()).generic_string();
  if (!finds(output, record.scene, scene))
    log::warn(
        fmt::format("{}: keep `{}` beside it: the scene is not in its folder, where it will be looked for",
                    output.string(), record.scene));
  return record;
}

}  // namespace lodestone::app
