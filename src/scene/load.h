// SPDX-License-Identifier: MIT
// Scenes from files and from the program itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

struct LoadOptions {
  // Height of a height map's brightest possible sample, in units of one sample's width; 0: a quarter of the
  // larger side. Height maps only.
  float height_scale = 0;
};

// Reads `builtin:NAME`, .gltf .glb .obj .ply .stl, or a grey .png .exr .tif as a height map. Files that it
// names are opened only inside its own folder. Throws Error(bad_input) with file, place and remedy;
// Error(usage) for an unknown builtin or file type.
Scene load(const std::string& spec, const LoadOptions& options = {});

// The loaders behind it, one a file format, each in a file of its own.
Scene load_gltf(const std::filesystem::path& path);
Scene load_obj(const std::filesystem::path& path);
Scene load_ply(const std::filesystem::path& path);
Scene load_stl(const std::filesystem::path& path);
Scene load_height_map(const std::filesystem::path& path, const LoadOptions& options);

// The embedded scenes, without the prefix `builtin:`.
// Beside these there is terrain:QUADS, the same mountains in so many quads a side, at rest.
std::vector<std::string> builtin_names();
Scene make_builtin(const std::string& name);

}  // namespace lodestone::scene
