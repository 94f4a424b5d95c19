// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/surface_sample.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lodestone::geometry_image {

SurfaceSample make_sample(uint32_t triangle, const glm::dvec3& barycentrics) {
  SurfaceSample sample;
  sample.triangle = triangle;
  const double sum =
      std::max(barycentrics.x, 0.0) + std::max(barycentrics.y, 0.0) + std::max(barycentrics.z, 0.0);
  uint32_t total = 0;
  for (glm::length_t k = 0; k < 3; ++k) {
    const double share = std::max(barycentrics[k], 0.0) / sum;
    sample.weights[static_cast<size_t>(k)] = static_cast<uint32_t>(std::lround(share * SurfaceSample::one));
    total += sample.weights[static_cast<size_t>(k)];
  }
  // Three roundings are off by one or two at most.
  uint32_t& largest = *std::max_element(sample.weights.begin(), sample.weights.end());
  largest += SurfaceSample::one - total;
  return sample;
}

SurfaceSample seen_from(const SurfaceSample& sample, const std::array<uint32_t, 3>& corners, uint32_t other,
                        const std::array<uint32_t, 3>& other_corners) {
  if (sample.triangle == other) return sample;
  SurfaceSample seen;
  seen.triangle = other;
  seen.weights = {0, 0, 0};
  for (size_t k = 0; k < 3; ++k) {
    if (sample.weights[k] == 0) continue;
    const auto* const found = std::find(other_corners.begin(), other_corners.end(), corners[k]);
    if (found == other_corners.end()) throw std::logic_error("a sample that is not on the triangle");
    seen.weights[static_cast<size_t>(found - other_corners.begin())] = sample.weights[k];
  }
  return seen;
}

}  // namespace lodestone::geometry_image
