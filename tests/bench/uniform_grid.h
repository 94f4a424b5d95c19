// SPDX-License-Identifier: MIT
// A uniform grid, as T. J. Purcell and others, and N. Thrane and L. O. Simonsen after them, had it on the
// GPU, walked cell by cell (J. Amanatides and A. Woo, "A Fast Voxel Traversal Algorithm", 1987).
#pragma once

#include "triangle_set.h"

namespace lodestone::test {

// Cells a triangle: 2 to 20 were within a tenth of each other on the bunny.
inline constexpr float usual_density = 5;

class UniformGrid {
 public:
  // About `density` cells a triangle, as near to cubes as whole numbers of them allow. Throws
  // std::invalid_argument without triangles, or where these have no extent.
  UniformGrid(std::vector<Triangle> triangles, float density);

  // On all cores. Closest hits.
  void intersect(const Rays& rays, std::vector<TriangleHit>& hits) const;
  TraceCounts count(const Rays& rays) const;

  glm::uvec3 cells() const { return cells_; }
  size_t cell_count() const { return first_.size() - 1; }
  size_t reference_count() const { return references_.size(); }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  template <class Count>
  TriangleHit trace(const glm::vec4& from, const glm::vec4& along, Count& count) const;
  template <class Visit>
  void visit_cells(const Triangle& triangle, const Visit& visit) const;

  std::vector<Triangle> triangles_;
  glm::vec3 lo_{}, hi_{}, cell_{};  // the whole, and one cell's size
  glm::uvec3 cells_{};
  std::vector<uint32_t> first_;  // of cell (x, y, z) at x + cells.x * (y + cells.y * z):
                                 // references_[first_[i] .. first_[i + 1])
  std::vector<uint32_t> references_;
};

}  // namespace lodestone::test
