// SPDX-License-Identifier: MIT
// What the formats that hold one mesh and nothing else have in common.
#pragma once

#include <filesystem>
#include <string>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// A scene of the mesh alone, placed by one node. Names an unnamed mesh after the file; gives it one part
// without a material where it has none.
Scene single_mesh_scene(const std::filesystem::path& path, Mesh mesh);

// For a file of 2^32 - 1 vertices or triangles and more: their numbers no longer fit.
[[noreturn]] void fail_too_many(const std::string& file);

}  // namespace lodestone::scene
