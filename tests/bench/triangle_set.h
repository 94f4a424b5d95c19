// SPDX-License-Identifier: MIT
// What the comparison tracers of this folder share: triangles, three own corners each, as the GPU ray tracers
// of the time had them, and their hits.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/test_support/rays.h"

namespace lodestone::test {

struct Triangle {
  glm::vec3 a, b, c;
};

std::vector<Triangle> triangles_of(const std::vector<glm::vec3>& points,
                                   const std::vector<glm::uvec3>& triangles);

inline constexpr uint32_t no_triangle = 0xffffffffu;

struct TriangleHit {
  float t = 0, u = 0, v = 0;  // t: that of the ray's end on a miss
  uint32_t triangle = no_triangle;
};

// What a tracer did, all rays together.
struct TraceCounts {
  uint64_t steps = 0, triangle_tests = 0;  // nodes or cells visited
  void step() { ++steps; }
  void test() { ++triangle_tests; }
};
// In its place where nothing is counted.
struct NoCounts {
  void step() {}
  void test() {}
};

// Möller and Trumbore 1997, both sides. Takes the hit where it is between tmin and hit.t.
inline bool intersect(const Triangle& triangle, const glm::vec3& origin, const glm::vec3& direction,
                      float tmin, TriangleHit& hit) {
  const glm::vec3 ab = triangle.b - triangle.a, ac = triangle.c - triangle.a;
  const glm::vec3 p = glm::cross(direction, ac);
  const float determinant = glm::dot(ab, p);
  if (determinant == 0) return false;
  const float inverse = 1 / determinant;
  const glm::vec3 from = origin - triangle.a;
  const float u = glm::dot(from, p) * inverse;
  if (!(u >= 0 && u <= 1)) return false;
  const glm::vec3 q = glm::cross(from, ab);
  const float v = glm::dot(direction, q) * inverse;
  if (!(v >= 0 && u + v <= 1)) return false;
  const float t = glm::dot(ac, q) * inverse;
  if (!(t > tmin && t < hit.t)) return false;
  hit.t = t;
  hit.u = u;
  hit.v = v;
  return true;
}

}  // namespace lodestone::test
