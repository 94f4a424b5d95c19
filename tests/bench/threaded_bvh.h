// SPDX-License-Identifier: MIT
// A plain bounding volume hierarchy without a stack, as N. Thrane and L. O. Simonsen had it on the GPU ("A
// Comparison of Acceleration Structures for GPU Assisted Ray Tracing", 2005): nodes in depth-first order in
// one array, so that the hit link is the next node; each stores only where to go on when it is missed. A
// binary tree of one triangle a leaf, static, visited in one fixed order.
#pragma once

#include "triangle_set.h"

namespace lodestone::test {

class ThreadedBvh {
 public:
  struct Node {
    glm::vec3 lo;
    uint32_t miss;  // the node after all below this one; that of the last ones is nodes().size()
    glm::vec3 hi;
    uint32_t triangle;  // of the input; no_triangle: an inner node, whose hit link is the next node
  };
  static_assert(sizeof(Node) == 32);

  // Split by the surface area heuristic over 32 bins an axis, down to single triangles; by the median where
  // all centres fall into one bin. Throws std::invalid_argument without triangles.
  explicit ThreadedBvh(std::vector<Triangle> triangles);

  // On all cores. Closest hits.
  void intersect(const Rays& rays, std::vector<TriangleHit>& hits) const;
  TraceCounts count(const Rays& rays) const;

  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  template <class Count>
  TriangleHit trace(const glm::vec4& from, const glm::vec4& along, Count& count) const;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace lodestone::test
