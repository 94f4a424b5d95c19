// SPDX-License-Identifier: MIT
// A mesh over a rectangle of height samples.
#pragma once

#include <cstdint>
#include <span>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// Samples a side of the largest grid that a height field is divided into.
inline constexpr uint32_t max_grid_side = 257;

// Makes a mesh of width x height finite samples, row by row, the row at the far side (-Z) first. The samples
// are heights along +Y, 1 apart along X and Z, and centred on the origin; seen from above the field lies as
// its image does. Normals follow from central differences, one-sided at the border; texture coordinates run
// from (0, 0) at the first sample to (1, 1) at the last one. Vertices begin with the near row, so that
// triangles face up; the grids follow each other likewise. Needs width and height of 2 and more, and fewer
// than 2^32 - 1 triangles.
Mesh make_height_field(uint32_t width, uint32_t height, std::span<const float> samples);

}  // namespace lodestone::scene
