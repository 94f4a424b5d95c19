// SPDX-License-Identifier: MIT
// Image comparison for CI.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/image/image.h"

namespace lodestone::image {

// What may differ. Without any of these set (pixel and pixel_share: above 0) only equality passes. With some
// set, each of them must hold, and the others do not matter.
struct Thresholds {
  // Upper bounds, inclusive, of the members of Comparison of the same names. NaN is never kept.
  std::optional<double> max, mean, rmse, flip_mean, flip_p99;
  // A pixel differs where a channel differs by more than `pixel`; `pixel_share` is the share of pixels that
  // may, 0..1. These two are one rule, set as soon as one of them is above 0.
  double pixel = 0;
  double pixel_share = 0;
  // Channels left out, e.g. steps.N, or layers, e.g. depth; names that no image has do no harm.
  std::vector<std::string> ignore;
};

// A sample that is non-finite in one image and not the same in the other, and an id against another id, are
// further apart than any number: no bound on numbers keeps them, only the rule on pixels may allow them.
struct ChannelDifference {
  std::string name;
  bool ids = false;                    // unsigned: compared exactly; max, mean and rmse stay 0
  double max = 0, mean = 0, rmse = 0;  // of |a - b|; infinite where non_finite is not 0
  uint64_t non_finite = 0;  // samples where one is non-finite and the other is not the same (equal infinities
                            // and NaN against NaN are equal)
  uint64_t different = 0;   // samples not equal (+0 and -0 are equal)
};

struct Comparison {
  bool same_size = true,
       same_channels = true;     // where one is false, nothing below but first_difference is measured
  std::string first_difference;  // size, channel or pixel (by rows from the top), in words; empty where equal
  std::vector<ChannelDifference> channels;  // in the order of the first image, ignored ones left out
  double max = 0, mean = 0, rmse = 0;       // over all samples of the float channels
  // FLIP error over all pixels (flip.h): where both have R G B, none of them ignored, and no non-finite
  // difference there.
  std::optional<double> flip_mean, flip_p99;
  double pixel_share = 0;  // of pixels that differ by more than Thresholds::pixel in any channel
  bool pass = false;
  std::vector<std::string> failures;  // one line a threshold broken
};

// Size and channels first (their order does not matter), then non-finite values, then the measures. Where all
// channels are ignored nothing passes. Metadata is not compared. The same for any number of threads.
Comparison compare(const Image& a, const Image& b, const Thresholds& thresholds);

// The difference as a picture for display: |a - b| of R G B (of the encoded values, as FLIP sees them),
// magnified by a power of two that its label names, beside the FLIP error through a colour map from black
// over purple to pale yellow. Where there is no R G B in both: the largest |a - b| over all common channels,
// grey and through the map. Magenta: a non-finite sample against another value. Throws std::invalid_argument
// where sizes differ.
Image difference_image(const Image& a, const Image& b);

// One object; its keys are always the same and non-finite numbers are null. `a` and `b`: what was compared.
std::string to_json(const Comparison& comparison, const std::string& a, const std::string& b);

}  // namespace lodestone::image
