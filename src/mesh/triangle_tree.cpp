// SPDX-License-Identifier: MIT
#include "lodestone/mesh/triangle_tree.h"

#include <array>
#include <cmath>

#include "lodestone/mesh/point_triangle.h"

namespace lodestone::mesh {
namespace {

// The minimum and the maximum instructions, which glm's and the library's functions become only if nothing
// tempts the compiler to branch: whether a point is beside a box is anybody's guess.
double clamped(double value, double lo, double hi) {
  const double raised = value < lo ? lo : value;
  return raised < hi ? raised : hi;
}

// Zero inside of the box.
double square_distance(const Box& box, const glm::dvec3& point) {
  const double x = point.x - clamped(point.x, box.lo.x, box.hi.x);
  const double y = point.y - clamped(point.y, box.lo.y, box.hi.y);
  const double z = point.z - clamped(point.z, box.lo.z, box.hi.z);
  return x * x + y * y + z * z;
}

// The nearest so far. What is not nearer than it is of no interest.
struct Search {
  glm::dvec3 point;
  double square;
  glm::dvec3 offset{0};
  uint32_t triangle = none;

  void visit(const TreeLeaf& leaf) {
    for (const TreeTriangle& candidate : leaf) {
      const auto& [a, b, c] = candidate.corners;
      Box box;
      box.add(a);
      box.add(b);
      box.add(c);
      if (square_distance(box, point) >= square) continue;
      const glm::dvec3 from = offset_from_triangle(point, a, b, c);
      const double from_square = glm::dot(from, from);
      if (from_square < square) {
        square = from_square;
        offset = from;
        triangle = candidate.triangle;
      }
    }
  }
};

struct Waiting {
  uint32_t reference;
  double square;
};

// The nearer child first; the other one waits.
void descend(const Tree& tree, Search& search) {
  std::array<Waiting, Tree::max_depth + 1> stack;
  uint32_t waiting = 0;
  stack[waiting++] = {tree.root.reference, square_distance(tree.root.box, search.point)};
  while (waiting != 0) {
    auto [reference, square] = stack[--waiting];
    while (square < search.square && reference < TreeChild::leaf_bit) {
      const std::array<TreeChild, 2>& children = tree.nodes[reference].children;
      const double squares[2] = {square_distance(children[0].box, search.point),
                                 square_distance(children[1].box, search.point)};
      const int near = squares[0] <= squares[1] ? 0 : 1, far = 1 - near;
      if (squares[far] < search.square) stack[waiting++] = {children[far].reference, squares[far]};
      reference = children[near].reference;
      square = squares[near];
    }
    if (square < search.square) search.visit(tree.leaves[reference - TreeChild::leaf_bit]);
  }
}

}  // namespace

TriangleTree::TriangleTree(const Surface& surface) : tree_(build_tree(surface)) {}

Nearest TriangleTree::nearest(const glm::dvec3& point, double within) const {
  Nearest nearest;
  if (empty()) return nearest;
  const double infinity = std::numeric_limits<double>::infinity();
  Search search{point, std::nextafter(within * within, infinity)};
  descend(tree_, search);
  if (search.triangle == none) return nearest;
  nearest.distance = std::sqrt(search.square);
  nearest.point = point - search.offset;
  nearest.triangle = search.triangle;
  return nearest;
}

}  // namespace lodestone::mesh
