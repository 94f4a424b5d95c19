// SPDX-License-Identifier: MIT
// What is static of a surface, on the device: vertices and their deltas, and the atlas. Uploaded once.
#pragma once

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/render/backend.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::render {

struct SceneTables {
  // `first_emitters`: of each chart ChartRecord::first_emitter; empty: nothing shines.
  SceneTables(Backend& backend, const scene::Assembly& assembly, const geometry_image::Atlas& atlas,
              const std::vector<uint32_t>& first_emitters);

  // Inputs of blend.
  Buffer base_positions, base_normals, base_tangents, vertex_ranges;
  Buffer morph_positions, morph_normals, morph_tangents, influences;
  // The atlas.
  Buffer triangles, texel_map, leaf_map, charts;
  Buffer texcoords;
  uint32_t sources = 1;  // layout/surface.h
};

// Of the atlas: `sources` of layout/surface.h, without levels of detail.
uint32_t sources_of(const geometry_image::Atlas& atlas);

// Buffers of `name` filled with an array; arrays may be empty.
template <class T>
Buffer make_buffer(Backend& backend, const char* name, uint32_t element_bytes, const std::vector<T>& items) {
  const auto bytes = std::as_bytes(std::span(items));
  Buffer buffer(backend, {name, bytes.size() / element_bytes, element_bytes});
  if (!bytes.empty()) backend.upload(buffer.id(), bytes);
  return buffer;
}

}  // namespace lodestone::render
