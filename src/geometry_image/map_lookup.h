// SPDX-License-Identifier: MIT
// Which face of a cell's map is at a place of its rectangle.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/base_complex/cell_map.h"

namespace lodestone::geometry_image {

// A place in a map: a face, and where in it.
struct FacePoint {
  uint32_t face = base_complex::none;  // index into CellMap::faces
  glm::dvec3 barycentrics{0};          // none below 0
};

glm::dvec2 place_in(const base_complex::CellMap& map, const FacePoint& point);

// Of each point of a lattice (row by row, columns x rows of them, `spacing` apart in the rectangle of the
// map) the face of the map that holds it, or comes nearest to, for numbers are rounded.
std::vector<FacePoint> find_lattice(const base_complex::CellMap& map, uint32_t columns, uint32_t rows,
                                    double spacing);

// From face to face.
class FaceWalk {
 public:
  explicit FaceWalk(const base_complex::CellMap& map);  // must outlive it

  // The face beyond the edge from corner `k` of a face to its next one; none on the map's border.
  uint32_t beside(uint32_t face, uint32_t k) const { return beside_[face][k]; }

  // The face that holds a point of the rectangle, walking from another one; none where it is not found soon.
  FacePoint find(const glm::dvec2& at, uint32_t start) const;

 private:
  const base_complex::CellMap& map_;
  std::vector<std::array<uint32_t, 3>> beside_;
};

}  // namespace lodestone::geometry_image
