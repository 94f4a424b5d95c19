// SPDX-License-Identifier: MIT
#pragma once

#include "lodestone/cpu_fallback/kernel.h"
#include "lodestone/layout/arithmetic.h"

namespace lodestone::cpu_fallback {

// The point that `source`, an entry of a texel map, is of its triangle, in the arithmetic of `rasterise`.
template <class Pass>
glm::vec3 texel_point(Pass& pass, const Quads& vertices, const glm::uvec4& triangle,
                      const glm::uvec4& source) {
  const float b1 = layout::uintBitsToFloat(source.y), b2 = layout::uintBitsToFloat(source.z);
  const float b0 = 1.0f - b1 - b2;
  const glm::vec3 p0 = as_vec3(pass.load(vertices, triangle.x)),
                  p1 = as_vec3(pass.load(vertices, triangle.y)),
                  p2 = as_vec3(pass.load(vertices, triangle.z));
  return layout::flush_tiny3(p0 * b0 + p1 * b1 + p2 * b2);
}

}  // namespace lodestone::cpu_fallback
