// SPDX-License-Identifier: MIT
// tinygltf, kept in a cage: files only through AssetFolder and within limits, images only through
// decode_image, no exception of its own.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <set>
#include <vector>

#include "lodestone/scene/gltf_container.h"
#include "lodestone/scene/gltf_outline.h"
#include "lodestone/scene/scene.h"

namespace lodestone::scene {

struct ParsedGltf {
  tinygltf::Model model;           // buffers loaded, images not; indices and lengths unchecked
  std::vector<Image> images;       // decoded, each file or buffer view once
  std::vector<uint32_t> image_of;  // for each image of the model one of `images`
  std::set<uint32_t> viewless;     // accessors whose buffer view is not theirs: all zeros
};

// Throws Error(bad_input).
ParsedGltf parse_gltf(const GltfContainer& gltf, const GltfOutline& outline);

}  // namespace lodestone::scene
