// SPDX-License-Identifier: MIT
#include "lodestone/scene/load.h"

#include <algorithm>
#include <cctype>

#include "lodestone/base/error.h"

namespace lodestone::scene {
namespace {

constexpr std::string_view builtin_prefix = "builtin:";

std::string lower_case_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

Scene load_file(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string type = lower_case_extension(path);
  if (type == ".gltf" || type == ".glb") return load_gltf(path);
  if (type == ".obj") return load_obj(path);
  if (type == ".ply") return load_ply(path);
  if (type == ".stl") return load_stl(path);
  if (type == ".png" || type == ".exr" || type == ".tif" || type == ".tiff")
    return load_height_map(path, options);
  fail(ExitCode::usage, path.string(),
       "is of no known type; give a .gltf .glb .obj .ply .stl file, a grey .png .exr .tif, or builtin:NAME");
}

}  // namespace

Scene load(const std::string& spec, const LoadOptions& options) {
  const bool builtin = spec.starts_with(builtin_prefix);
  Scene scene = builtin ? make_builtin(spec.substr(builtin_prefix.size())) : load_file(spec, options);
  scene.name = spec;
  validate(scene);
  return scene;
}

}  // namespace lodestone::scene
