// SPDX-License-Identifier: MIT
#include "triangle_set.h"

namespace lodestone::test {

std::vector<Triangle> triangles_of(const std::vector<glm::vec3>& points,
                                   const std::vector<glm::uvec3>& triangles) {
  std::vector<Triangle> result;
  result.reserve(triangles.size());
  for (const glm::uvec3& t : triangles) result.push_back({points[t.x], points[t.y], points[t.z]});
  return result;
}

}  // namespace lodestone::test
