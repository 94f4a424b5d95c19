// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "lodestone/mesh/surface.h"
#include "lodestone/mesh/tree_build.h"

namespace lodestone::mesh {

// The nearest point of a surface. Lengths and points are in the units of its positions.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  // at least 0; infinite where none was found
  glm::dvec3 point{0};                                        // meaningless where none was found
  uint32_t triangle = none;  // one of those that are nearest, always the same
};

// Answers which point of a surface is nearest to a given one. 56 bytes a triangle; what the surface
// refers to is copied and may go. Any number of threads may ask at once.
class TriangleTree {
 public:
  // On all cores; half a second a million triangles on one, and half as much memory again as it keeps. Throws
  // as Surface says.
  explicit TriangleTree(const Surface& surface);

  bool empty() const { return tree_.leaves.empty(); }

  // The nearest point that is no further away than `within` (at least 0), if there is any; an empty surface
  // has none. The nearer `within` is to the answer, the faster. `point` is finite. Of the distance all but
  // the last few bits of a double are right, relative to the distance or the size of the nearest triangle,
  // whichever is larger; of triangles that are higher than 0 but lower than 1e-8 of their longest edge, 8
  // digits.
  Nearest nearest(const glm::dvec3& point, double within = std::numeric_limits<double>::infinity()) const;

 private:
  Tree tree_;
};

}  // namespace lodestone::mesh
