// SPDX-License-Identifier: MIT
// A place on the input, in numbers that say the same from every triangle that has it: barycentrics are
// multiples of 2^-24, so that they add up to 1 exactly in single precision, and a point on an edge or at a
// vertex is evaluated by equal operations on equal operands whichever triangle is used.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>

namespace lodestone::geometry_image {

struct SurfaceSample {
  static constexpr uint32_t one = 1u << 24;

  uint32_t triangle = 0;
  std::array<uint32_t, 3> weights = {one, 0, 0};  // of the triangle's corners, in units of 1 / one; sum: one

  glm::uvec4 texel(uint32_t chart_index) const {
    const auto bits = [](uint32_t w) { return std::bit_cast<uint32_t>(float(w) * (1.0f / float(one))); };
    return {triangle, bits(weights[1]), bits(weights[2]), chart_index + 1};
  }
};

// Weights that are 0 stay 0; the others are rounded, and the largest makes up the sum.
SurfaceSample make_sample(uint32_t triangle, const glm::dvec3& barycentrics);

// The same place seen from triangle `other`: the corners with a weight must be corners of it too. `corners`
// are the welded vertices of the sample's triangle, `other_corners` those of the other. Throws
// std::logic_error where they are not.
SurfaceSample seen_from(const SurfaceSample& sample, const std::array<uint32_t, 3>& corners, uint32_t other,
                        const std::array<uint32_t, 3>& other_corners);

}  // namespace lodestone::geometry_image
