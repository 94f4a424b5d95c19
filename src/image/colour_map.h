// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace lodestone::image {

using Rgb = std::array<float, 3>;  // encoded, 0..1

// 0..1 to colours from black over purple and orange to pale yellow, the lightness rising all the way, so that
// an error map reads without its colours too.
inline Rgb heat(float value) {
  constexpr std::array<Rgb, 9> stops = {{{0.00f, 0.00f, 0.02f},
                                         {0.10f, 0.06f, 0.24f},
                                         {0.28f, 0.08f, 0.44f},
                                         {0.48f, 0.12f, 0.50f},
                                         {0.68f, 0.20f, 0.48f},
                                         {0.87f, 0.31f, 0.40f},
                                         {0.97f, 0.52f, 0.37f},
                                         {0.99f, 0.77f, 0.53f},
                                         {0.99f, 0.99f, 0.78f}}};
  const float place = std::clamp(value, 0.0f, 1.0f) * float(stops.size() - 1);
  const size_t below = std::min(size_t(place), stops.size() - 2);
  const float share = place - float(below);
  Rgb colour;
  for (size_t c = 0; c < 3; ++c)
    colour[c] = stops[below][c] + share * (stops[below + 1][c] - stops[below][c]);
  return colour;
}

}  // namespace lodestone::image
