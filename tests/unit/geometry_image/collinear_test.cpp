// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/collinear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lodestone::geometry_image {
namespace {

TEST(ExactlyCollinear, HoldsForPointsOfOneLine) {
  EXPECT_TRUE(exactly_collinear({0, 0, 0}, {1, 2, 3}, {2, 4, 6}));
  EXPECT_TRUE(exactly_collinear({1, 1, 1}, {1, 1, 1}, {5, 6, 7}));
  EXPECT_TRUE(exactly_collinear({2, 2, 2}, {2, 2, 2}, {2, 2, 2}));
  std::mt19937 random(1);
  const auto small = [&] { return float(int(random() % 4096) - 2048); };
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 a(small(), small(), small()), step(small(), small(), small());
    EXPECT_TRUE(exactly_collinear(a, a + 3.0f * step, a - 5.0f * step));
  }
}

TEST(ExactlyCollinear, SeesTheSmallestBend) {
  std::mt19937 random(2);
  const auto small = [&] { return float(int(random() % 4096) - 2048); };
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 a(small(), small(), small()), step(small() + 0.5f, small(), small());
    const glm::vec3 b = a + 2.0f * step;
    glm::vec3 c = a + 4.0f * step;
    c.y = std::nextafter(c.y, 1e9f);
    EXPECT_FALSE(exactly_collinear(a, b, c));
    EXPECT_FALSE(exactly_collinear(c, a, b));
  }
}

TEST(ExactlyCollinear, DoesNotClaimWhatDoublePrecisionCannotTell) {
  // In double precision both sides of the corner at the origin of this L look alike from 10^20 away.
  EXPECT_FALSE(exactly_collinear({1e20f, 1e20f, 0}, {1, 0, 0}, {0, 1, 0}));
  // The two products of the cross product are 1 - t - e t - e^2 and 1 - t + e t - e^2: equal once they are
  // rounded.
  const float e = std::ldexp(1.0f, -36), t = std::ldexp(1.0f, -24);
  EXPECT_FALSE(exactly_collinear({-e, e, 0}, {1, 1, 0}, {1 - t, 1 - t, 0}));
}

TEST(ExactlyCollinear, TakesTheLargestAndTheSmallestFloats) {
  const float big = 3e38f, tiny = std::ldexp(1.0f, -149);
  EXPECT_TRUE(exactly_collinear({-big, -big, big}, {big, big, -big}, {0, 0, 0}));
  EXPECT_FALSE(exactly_collinear({-big, -big, big}, {big, big, big}, {big, -big, -big}));
  EXPECT_TRUE(exactly_collinear({0, 0, 0}, {tiny, tiny, tiny}, {2 * tiny, 2 * tiny, 2 * tiny}));
  EXPECT_FALSE(exactly_collinear({0, 0, 0}, {tiny, tiny, tiny}, {2 * tiny, 2 * tiny, 3 * tiny}));
}

}  // namespace
}  // namespace lodestone::geometry_image
