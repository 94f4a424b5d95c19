// SPDX-License-Identifier: MIT
// Facets for meshes that come without normals (glTF 2.0, 3.7.2.1).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// Gives every corner of the triangles that are `flat` (one entry a triangle, not 0) a vertex of its own with
// the normal of the facet, and every morph target that bends a facet the change of that normal. A facet
// without an area gets zeros. No vertex may belong to both flat and other triangles. `charge` is told of all
// memory, in bytes, before it is taken, and may throw.
void make_flat(Mesh& mesh, const std::vector<uint8_t>& flat, const std::function<void(uint64_t)>& charge);

}  // namespace lodestone::scene
