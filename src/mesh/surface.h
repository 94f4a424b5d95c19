// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace lodestone::mesh {

// What stands for no triangle.
inline constexpr uint32_t none = 0xffffffffu;

// Triangles by the indices of their corners. It owns nothing. Triangles may be degenerate (a line, a point),
// may cross, and need not be connected; positions that no triangle uses do not count. Empty: no triangle.
//
// Functions that take one throw std::invalid_argument where an index is out of range or a used position is
// not finite, and std::length_error where there are more than 2^32 - 2 triangles.
struct Surface {
  std::span<const glm::vec3> positions;
  std::span<const glm::uvec3> triangles;
};

// Throws what is said above.
void check(const Surface& surface);

// Of the box round the corners of all triangles; 0 where there is none.
double diagonal(const Surface& surface);

}  // namespace lodestone::mesh
