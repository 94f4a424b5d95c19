// SPDX-License-Identifier: MIT
// Materials and textures on the device, and which part of the surface is of which. Uploaded once.
#pragma once

#include "lodestone/render/backend.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/scene.h"

namespace lodestone::render {

// Linear, of a value of a texture's channel that is sRGB-encoded.
float srgb_level(uint32_t value);

struct MaterialTables {
  MaterialTables(Backend& backend, const scene::Scene& scene, const scene::Assembly& assembly);

  Buffer parts, materials, textures, images;
  bool has_masks = false;  // some material cuts out texels
  uint32_t layered = 0;    // layout/surface.h
};

}  // namespace lodestone::render
