// SPDX-License-Identifier: MIT
#include "lodestone/mesh/surface.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "lodestone/base/parallel.h"

namespace lodestone::mesh {
namespace {

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

void check(const Surface& surface) {
  if (surface.triangles.size() >= none) throw std::length_error("a surface of more than 2^32 - 2 triangles");
  parallel_for(surface.triangles.size(), 1u << 14, [&](uint64_t begin, uint64_t end) {
    for (uint64_t triangle = begin; triangle < end; ++triangle) {
      for (int corner = 0; corner < 3; ++corner) {
        const uint32_t vertex = surface.triangles[triangle][corner];
        if (vertex >= surface.positions.size())
          throw std::invalid_argument("a triangle names a vertex that does not exist");
        if (!is_finite(surface.positions[vertex]))
          throw std::invalid_argument("a position is not a finite number");
      }
    }
  });
}

double diagonal(const Surface& surface) {
  glm::dvec3 lo(std::numeric_limits<double>::infinity()), hi = -lo;
  for (const glm::uvec3& triangle : surface.triangles) {
    for (glm::length_t k = 0; k < 3; ++k) {
      lo = glm::min(lo, glm::dvec3(surface.positions[triangle[k]]));
      hi = glm::max(hi, glm::dvec3(surface.positions[triangle[k]]));
    }
  }
  return surface.triangles.empty() ? 0.0 : glm::distance(lo, hi);
}

}  // namespace lodestone::mesh
