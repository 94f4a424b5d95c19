// SPDX-License-Identifier: MIT
// A pass over the JSON of a glTF file before tinygltf sees it. tinygltf takes a property of the wrong type
// for absent, wraps integers to 32 bits, recurses over nested values and copies what buffers name as often as
// they name it; here such files are turned away.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/scene/gltf_container.h"

namespace lodestone::scene {

struct GltfOutline {
  std::vector<std::string> extensions_used, extensions_required;
  std::vector<uint64_t>
      external_buffer_bytes;  // declared lengths of the buffers in files of their own, in order
};

// Throws Error(bad_input) naming the place in the JSON.
GltfOutline outline_gltf(const GltfContainer& gltf);

}  // namespace lodestone::scene
