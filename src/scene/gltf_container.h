// SPDX-License-Identifier: MIT
// The outer layer of a glTF file: plain JSON, or the chunks of a GLB.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::scene {

struct GltfContainer {
  std::string file;              // as the user named it: the subject of errors
  std::vector<std::byte> bytes;  // the whole file
  bool is_binary = false;        // a GLB
  std::string_view json;         // both inside `bytes`
  std::span<const std::byte> binary_chunk;
};

// Reads a .gltf or .glb (told apart by the first bytes) and checks the lengths of header and chunks. Throws
// Error(bad_input) where the file is cut short, not glTF, or of another container version than 2.
GltfContainer open_gltf(const std::filesystem::path& path);

// A GLB of other JSON and the same binary chunk.
std::string rebuild_glb(const std::string& json, std::span<const std::byte> binary_chunk);

}  // namespace lodestone::scene
