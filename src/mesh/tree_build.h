// SPDX-License-Identifier: MIT
// The bounding volume hierarchy behind TriangleTree.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "lodestone/mesh/surface.h"

namespace lodestone::mesh {

struct Box {
  glm::vec3 lo{std::numeric_limits<float>::infinity()}, hi{-std::numeric_limits<float>::infinity()};

  void add(const glm::vec3& point) {
    lo = glm::min(lo, point);
    hi = glm::max(hi, point);
  }
  void add(const Box& box) {
    lo = glm::min(lo, box.lo);
    hi = glm::max(hi, box.hi);
  }
};

// A leaf or an inner node, with the box of all below it.
struct TreeChild {
  static constexpr uint32_t leaf_bit = 0x80000000u;

  Box box;
  uint32_t reference = leaf_bit;  // the index of a node, or leaf_bit + the index of a leaf
};

struct alignas(64) TreeNode {
  std::array<TreeChild, 2> children;
};

struct TreeTriangle {
  std::array<glm::vec3, 3> corners;
  uint32_t triangle = none;  // in the surface
};

// All leaves are full: the last one repeats its last triangle.
using TreeLeaf = std::array<TreeTriangle, 4>;

struct Tree {
  // A path from the root to a leaf passes no more nodes than this.
  static constexpr uint32_t max_depth = 72;

  std::vector<TreeNode> nodes;
  std::vector<TreeLeaf> leaves;
  TreeChild root;  // meaningless where there are no leaves
};

// The same tree for any number of threads. Throws as Surface says.
Tree build_tree(const Surface& surface);

}  // namespace lodestone::mesh
