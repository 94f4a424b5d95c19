// SPDX-License-Identifier: MIT
// Evenly spread points of a triangle.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace lodestone::mesh {

// Barycentric coordinates of point `index` of the sequence of Basu and Owen (Low discrepancy constructions in
// the triangle, 2015): the base-4 digits of the index, the lowest first, choose one of the four triangles
// that the edge midpoints cut the last one into, 0 the middle one; the point is the centroid of what is left.
// So point 0 is the centroid, and the first 4^k points are those of a regular subdivision.
inline glm::dvec3 triangle_point(uint64_t index) {
  constexpr double third = 1.0 / 3;
  glm::dvec3 center(third);
  // The corners of the triangle that is left are center + scale * (unit vector - third).
  double scale = 1;
  for (; index != 0; index /= 4) {
    const int digit = static_cast<int>(index % 4);
    scale /= 2;
    if (digit == 0) {
      scale = -scale;
    } else {
      center -= scale * third;
      center[digit - 1] += scale;
    }
  }
  return center;
}

}  // namespace lodestone::mesh
