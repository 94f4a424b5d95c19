// SPDX-License-Identifier: MIT
// LDR-FLIP: what a viewer notices who flips between two pictures.
#pragma once

#include <vector>

#include "lodestone/image/image.h"

namespace lodestone::image {

// A viewer 0.7 m before a display 0.7 m and 3840 pixels wide: 3840 pi / 180.
inline constexpr double default_pixels_per_degree = 67.02064327658225;

// The FLIP error of every pixel, 0 (nothing to see) to 1, row by row. Colours are taken as displayed: R G B
// of an image that is Image::linear are clamped to 0..1 once encoded, and so is everything else; NaN counts
// as 0. The same bits for any number of threads. `a` and `b` have one size and float R G B
// (std::invalid_argument otherwise).
std::vector<float> flip_error(const Image& a, const Image& b,
                              double pixels_per_degree = default_pixels_per_degree);

struct FlipSummary {
  double mean = 0;
  double p99 = 0;  // 99th percentile by nearest rank: 99 % of the pixels have at most this error
};
FlipSummary summarise(const std::vector<float>& errors);

}  // namespace lodestone::image
