// SPDX-License-Identifier: MIT
// The convolution kernels of FLIP, all of them separable.
#pragma once

#include <vector>

namespace lodestone::image {

// Weights of the pixels at -radius..radius.
struct Kernel {
  std::vector<float> weights;
  int radius() const { return int(weights.size() / 2); }
};

// kernel(x) kernel(y), times weight.
struct SeparableTerm {
  float weight = 1;
  Kernel kernel;
};

struct FlipFilters {
  // Contrast sensitivity of the achromatic, red-green and blue-yellow channel; each sums to 1 over the plane.
  std::vector<SeparableTerm> sensitivity[3];
  // A Gaussian as wide as the features that the eye tells apart, its first derivative (edges) and its second
  // (points). The negative weights of the derivatives sum to -1, the positive ones to 1.
  Kernel blur, edge, point;
  int radius = 0;  // of the largest kernel
};

FlipFilters make_flip_filters(double pixels_per_degree);

}  // namespace lodestone::image
