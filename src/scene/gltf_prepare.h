// SPDX-License-Identifier: MIT
// The JSON of a glTF file made ready for tinygltf, which misreads some of what glTF allows: it takes a plus
// sign in a file name for a space, wants a data URI to be of exactly the length and of one of a few types,
// and refuses indices without a buffer view.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lodestone/scene/gltf_container.h"
#include "lodestone/scene/gltf_outline.h"

namespace lodestone::scene {

// What a buffer or an image names as its contents.
struct GltfResource {
  std::string place;              // "buffers[0]"
  std::string uri;                // as in the file
  std::optional<uint64_t> bytes;  // byteLength of a buffer
};

struct PreparedGltf {
  std::string json;  // empty where the file's own will do
  // Resource i stands in `json` as "#i"; images of one uri share it.
  std::vector<GltfResource> resources;
  // Accessors without a buffer view that got one for show only: their elements are zeros.
  std::set<uint32_t> viewless;
};

PreparedGltf prepare_gltf(const GltfContainer& gltf, const GltfOutline& outline);

// The resource that a uri of PreparedGltf::json stands for; null where it is none.
const GltfResource* find_resource(const PreparedGltf& prepared, const std::string& uri);

}  // namespace lodestone::scene
