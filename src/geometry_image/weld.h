// SPDX-License-Identifier: MIT
// Vertices that are one point of the surface in every pose, though the file lists them several times (along
// seams of texture coordinates or normals).
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

// Whether two vertices always move alike: the same position deltas (zero ones do not count) and the same skin
// influences in the same order. Where they also start at one place, `blend` gives them equal bits in every
// pose.
bool same_deformation(const scene::Assembly& assembly, uint32_t a, uint32_t b);

// For each vertex the lowest one with an equal position and the same deformation.
std::vector<uint32_t> weld(const scene::Assembly& assembly);

}  // namespace lodestone::geometry_image
