// SPDX-License-Identifier: MIT
// Atlases with mapped charts, made by hand.
#pragma once

#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {

// Makes mapped charts of the same texels out of an atlas's grid charts: of every `nth`, from the first on.
void map_grids(geometry_image::Atlas& atlas, uint32_t nth = 1);

// Three squares that face the camera (small_scenes.h), with charts of one kind each. The mapped one is mesh 0
// and chart 0; it reaches from -1 to 1, and its two triangles, Y >= X and Y <= X, have vertices and materials
// of their own, which agree in nothing but place. Texel (x, y) of the chart is the point straddled_point(x,
// y), so that most quads near the diagonal have texels in both. The exact square lies at its right, the grid
// at its left.
struct Straddled {
  bool mapped = true;     // else the square has two exact charts in place of the mapped one
  bool tangents = false;  // own ones, which are those that follow from the texture coordinates
  bool cut_out = false;   // where alpha, which the vertices have, is below 0.5
};
constexpr uint32_t straddled_width = 6, straddled_height = 5;
inline glm::dvec2 straddled_point(uint32_t x, uint32_t y) {
  return {2.0 * x / (straddled_width - 1) - 1, 1 - 2.0 * y / (straddled_height - 1)};
}
ReadyScene straddled_squares(const Straddled& options = {});

}  // namespace lodestone::test
