// SPDX-License-Identifier: MIT
// What the maps of charts are to have little stretch for: the rest pose, or all morph targets as well.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/base_complex/stretch.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

// Of each triangle of the assembly the mean of two metrics, which the L2 stretch is linear in: that of the
// rest pose, and that of the morph target (alone, at full weight) or rest pose in which its edges are
// longest.
class ShapeMetrics {
 public:
  ShapeMetrics(const scene::Scene& scene, const scene::Assembly& assembly);

  // The shapes of a cell's faces, in order; face f of its mesh is a piece of `triangles[mesh.triangle(f)]`.
  std::vector<base_complex::TriangleShape> of_cell(const base_complex::BaseComplex& complex,
                                                   const std::vector<uint32_t>& triangles,
                                                   uint32_t cell) const;

 private:
  base_complex::TriangleShape of_face(const base_complex::HalfEdgeMesh& mesh,
                                      const std::vector<uint32_t>& triangles, uint32_t face) const;

  std::vector<base_complex::TriangleShape> rest_, largest_;
};

}  // namespace lodestone::geometry_image
