// SPDX-License-Identifier: MIT
// The point of a triangle that is nearest to a given one.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace lodestone::mesh {

// From the nearest point of the segment from a to b to the point p, given p - a and b - a.
inline glm::dvec3 offset_from_segment(const glm::dvec3& from_a, const glm::dvec3& edge) {
  const double square = glm::dot(edge, edge);
  const double along = square > 0 ? std::clamp(glm::dot(from_a, edge) / square, 0.0, 1.0) : 0.0;
  return from_a - along * edge;
}

// From the nearest point of the triangle to p: p minus it is that point, its length the distance. Zero, not
// about zero, where p is a corner.
//
// By regions of Voronoi (Ericson, Real-Time Collision Detection, 5.1.5), but his barycentric coordinates are
// differences of products that lose all their digits on needles and far from the triangle. Here signs alone
// say where p is: above the inside the nearest point is p's projection, otherwise it is on an edge that has
// p on its outer side. A sign that rounding turned belongs to a p at the border of two regions, where both
// give the same. A triangle of less than 1e-8 of its longest edge in height has no reliable normal and
// is its edges.
inline glm::dvec3 offset_from_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                       const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, bc = c - b, ca = a - c;
  const glm::dvec3 ap = p - a, bp = p - b, cp = p - c;
  const glm::dvec3 normal = glm::cross(ab, bc);
  const double square = glm::dot(normal, normal);
  const double longest = std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)});
  double beside_ab = 0, beside_bc = 0, beside_ca = 0;
  if (square > 1e-16 * longest * longest) {
    beside_ab = glm::dot(glm::cross(ab, ap), normal);
    beside_bc = glm::dot(glm::cross(bc, bp), normal);
    beside_ca = glm::dot(glm::cross(ca, cp), normal);
    if (beside_ab > 0 && beside_bc > 0 && beside_ca > 0) return normal * (glm::dot(normal, ap) / square);
  }
  glm::dvec3 nearest = ap;
  double nearest_square = glm::dot(ap, ap);
  const auto try_edge = [&](const glm::dvec3& from_start, const glm::dvec3& edge) {
    const glm::dvec3 offset = offset_from_segment(from_start, edge);
    const double offset_square = glm::dot(offset, offset);
    if (offset_square < nearest_square) {
      nearest = offset;
      nearest_square = offset_square;
    }
  };
  if (beside_ab <= 0) try_edge(ap, ab);
  if (beside_bc <= 0) try_edge(bp, bc);
  if (beside_ca <= 0) try_edge(cp, ca);
  return nearest;
}

}  // namespace lodestone::mesh
