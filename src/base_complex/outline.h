// SPDX-License-Identifier: MIT
// A closed boundary with distances along it.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/half_edge_mesh.h"

namespace lodestone::base_complex {

// Of the half-edges of a boundary, how far along each starts.
struct Outline {
  Outline(const HalfEdgeMesh& mesh, const std::vector<uint32_t>& boundary) {
    for (const uint32_t h : boundary) {
      along.push_back(length);
      length += mesh.length(h);
    }
  }
  double between(size_t from, size_t to) const {  // counterclockwise
    const double d = along[to] - along[from];
    return d > 0 || (d == 0 && to >= from) ? d : d + length;
  }
  std::vector<double> along;
  double length = 0;
};

// The angle of the cell at the start of each half-edge of its boundary, as measured on the surface.
std::vector<double> boundary_angles(const HalfEdgeMesh& mesh, const std::vector<uint32_t>& cell_of_face,
                                    const std::vector<uint32_t>& boundary);

}  // namespace lodestone::base_complex
