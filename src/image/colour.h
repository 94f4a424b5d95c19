// SPDX-License-Identifier: MIT
// The sRGB transfer function (IEC 61966-2-1), per component.
#pragma once

#include <cmath>

namespace lodestone::image {

// To 0..1; NaN becomes 0.
inline float clamp_unit(float value) {
  return value > 0 ? (value < 1 ? value : 1.0f) : 0.0f;
}

inline float srgb_encode(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

inline float srgb_decode(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace lodestone::image
