// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace lodestone::scene::builtin {

// A linear colour, cut to 0 to 1, as an Image stores it: encoded as sRGB.
inline uint8_t color_texel(float linear) {
  const float c = glm::clamp(linear, 0.0f, 1.0f);
  const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
  return uint8_t(255 * s + 0.5f);
}

}  // namespace lodestone::scene::builtin
