// SPDX-License-Identifier: MIT
// Image comparison for CI. FLIP: Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating
// Images".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/image/image.h"

namespace lodestone::image {

struct Thresholds {
  std::optional<double> max, mean, rmse, flip_mean, flip_p99;
  // A pixel differs where a channel differs by more than `pixel`; `pixel_share` is the share of pixels that
  // may.
  double pixel = 0;
  double pixel_share = 0;
  std::vector<std::string> ignore;  // channels left out, e.g. steps.N
};

struct ChannelDifference {
  std::string name;
  double max = 0, mean = 0, rmse = 0;
  uint64_t non_finite = 0;  // samples where one is non-finite and the other is not the same (equal infinities
                            // and NaN against NaN are equal)
  uint64_t different = 0;   // samples not equal to the bit (+0 and -0 are equal)
};

struct Comparison {
  bool same_size = true, same_channels = true;
  std::string first_difference;  // size, channel or pixel, in words; empty where equal
  std::vector<ChannelDifference> channels;
  double max = 0, mean = 0, rmse = 0;
  std::optional<double> flip_mean, flip_p99;  // where both have R G B and no non-finite differences
  double pixel_share = 0;                     // of pixels that differ by more than Thresholds::pixel
  bool pass = false;
  std::vector<std::string> failures;  // one line a threshold broken
};

// Size and channels first, then non-finite values, then the measures. Without any threshold set only equality
// passes. `linear`: RGB are linear (EXR) and are tone-mapped by exposure 0 and encoded for FLIP.
Comparison compare(const Image& a, const Image& b, const Thresholds& thresholds);

// The difference as a picture: FLIP error through a colour map beside |a - b|.
Image difference_image(const Image& a, const Image& b);

std::string to_json(const Comparison& comparison, const std::string& a, const std::string& b);

}  // namespace lodestone::image
