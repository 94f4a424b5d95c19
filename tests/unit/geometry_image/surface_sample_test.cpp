// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/surface_sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "brute_force.h"
#include "lodestone/layout/arithmetic.h"

namespace lodestone::geometry_image {
namespace {

using Corners = std::array<uint32_t, 3>;
constexpr double one = SurfaceSample::one;

uint64_t sum_of(const SurfaceSample& sample) {
  return uint64_t(sample.weights[0]) + sample.weights[1] + sample.weights[2];
}

// As the pass `rasterise` does it.
glm::vec3 position_of(const SurfaceSample& sample, const Corners& corners,
                      const std::vector<glm::vec3>& positions) {
  const glm::uvec4 texel = sample.texel(0);
  const float b1 = std::bit_cast<float>(texel.y), b2 = std::bit_cast<float>(texel.z);
  const float b0 = 1.0f - b1 - b2;
  return layout::flush_tiny3(positions[corners[0]] * b0 + positions[corners[1]] * b1 +
                             positions[corners[2]] * b2);
}

TEST(SurfaceSample, WeightsAddUpExactlyAndAreWhatTheyWere) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(0, 1);
  for (int i = 0; i < 20000; ++i) {
    glm::dvec3 b(number(random), number(random), number(random));
    // Also corners of the triangle, edges, and places very near to them.
    if (i % 4 == 1) b[i / 4 % 3] = 0;
    if (i % 4 == 2) b[i / 4 % 3] *= 1e-7;
    if (i % 4 == 3) b[i / 4 % 3] = b[(i / 4 + 1) % 3] = i % 8 == 3 ? 0 : 1e-9 * number(random);
    b /= b.x + b.y + b.z;
    const SurfaceSample sample = make_sample(7, b);
    EXPECT_EQ(sample.triangle, 7u);
    ASSERT_EQ(sum_of(sample), SurfaceSample::one);
    for (glm::length_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(sample.weights[size_t(k)] / one, b[k], 2 / one);
      EXPECT_TRUE(b[k] != 0 || sample.weights[size_t(k)] == 0) << "a sample that left its edge";
    }
  }
}

TEST(SurfaceSample, TakesBarycentricsThatAreNotNormalised) {
  EXPECT_EQ(make_sample(0, {2, 2, 4}).weights, (Corners{1u << 22, 1u << 22, 1u << 23}));
  // What rounding has put outside comes back to the edge.
  EXPECT_EQ(make_sample(0, {-1e-12, 0.5, 0.5}).weights, (Corners{0, 1u << 23, 1u << 23}));
  EXPECT_EQ(make_sample(0, {1, 0, 0}).weights, (Corners{SurfaceSample::one, 0, 0}));
}

TEST(SurfaceSample, TheThirdBarycentricFollowsExactlyFromATexelsTwo) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const SurfaceSample sample = make_sample(3, {number(random), number(random), number(random)});
    const glm::uvec4 texel = sample.texel(41);
    EXPECT_EQ(texel.x, 3u);
    EXPECT_EQ(texel.w, 42u);
    const float b1 = std::bit_cast<float>(texel.y), b2 = std::bit_cast<float>(texel.z);
    EXPECT_EQ(double(b1) * one, sample.weights[1]);
    EXPECT_EQ(double(b2) * one, sample.weights[2]);
    EXPECT_EQ(double(1.0f - b1 - b2) * one, sample.weights[0]);
  }
}

// Two triangles that share an edge, or a corner only, with their corners in all orders.
TEST(SurfaceSample, IsAtTheSamePlaceToTheBitSeenFromEitherTriangle) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  std::uniform_real_distribution<double> number(0, 1);
  for (int i = 0; i < 300; ++i) {
    std::vector<glm::vec3> positions;
    for (int p = 0; p < 5; ++p) {
      const float size = std::exp2(float(int(random() % 60) - 30));
      positions.emplace_back(size * coordinate(random), coordinate(random), i % 5 == 0 ? -0.0f : size);
    }
    Corners corners = {0, 1, 2};
    do {
      // The sample is on the edge from point 0 to point 1, or at one of them.
      glm::dvec3 b(0);
      for (glm::length_t k = 0; k < 3; ++k)
        if (corners[size_t(k)] != 2) b[k] = i % 3 != 0 ? number(random) : corners[size_t(k)] == 0 ? 1 : 0;
      const SurfaceSample sample = make_sample(10, b);
      const glm::vec3 expected = position_of(sample, corners, positions);
      Corners other = {0, i % 3 != 0 ? 1u : 4u, 3};
      std::sort(other.begin(), other.end());
      do {
        const SurfaceSample seen = seen_from(sample, corners, 20, other);
        EXPECT_EQ(seen.triangle, 20u);
        EXPECT_EQ(sum_of(seen), SurfaceSample::one);
        EXPECT_EQ(test::bits_of(position_of(seen, other, positions)), test::bits_of(expected));
        // And back again.
        EXPECT_EQ(seen_from(seen, other, 10, corners).weights, sample.weights);
      } while (std::next_permutation(other.begin(), other.end()));
    } while (std::next_permutation(corners.begin(), corners.end()));
  }
}

TEST(SurfaceSample, IsNotSeenFromATriangleThatHasItNot) {
  const SurfaceSample inside = make_sample(1, {0.2, 0.3, 0.5}), on_edge = make_sample(1, {0.5, 0.5, 0});
  EXPECT_THROW(seen_from(inside, {0, 1, 2}, 2, {0, 1, 3}), std::logic_error);
  EXPECT_NO_THROW(seen_from(on_edge, {0, 1, 2}, 2, {0, 1, 3}));
  EXPECT_THROW(seen_from(on_edge, {0, 1, 2}, 2, {0, 2, 3}), std::logic_error);
  // From its own triangle it is what it is.
  EXPECT_EQ(seen_from(inside, {0, 1, 2}, 1, {0, 1, 2}).weights, inside.weights);
}

}  // namespace
}  // namespace lodestone::geometry_image
