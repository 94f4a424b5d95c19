// SPDX-License-Identifier: MIT
// A pass over the JSON of a glTF file before tinygltf sees it. tinygltf takes a property of the wrong type
// for absent, wraps integers to 32 bits, recurses over nested values and makes a kilobyte and more of an
// empty object; here such files are turned away.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/scene/gltf_container.h"

namespace lodestone::scene {

struct GltfOutline {
  std::vector<std::string> extensions_used, extensions_required;
  bool names_resources = false;            // a buffer or an image has a uri
  std::vector<uint32_t> viewless_indices;  // accessors of indices that have no buffer view, ascending
};

// Throws Error(bad_input) naming the place in the JSON.
GltfOutline outline_gltf(const GltfContainer& gltf);

}  // namespace lodestone::scene
