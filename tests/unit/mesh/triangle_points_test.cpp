// SPDX-License-Identifier: MIT
#include "lodestone/mesh/triangle_points.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace lodestone::mesh {
namespace {

TEST(TrianglePoints, TheFirstIsTheCentroidAndTheNextThreeAreTowardsTheCorners) {
  EXPECT_EQ(triangle_point(0), glm::dvec3(1.0 / 3));
  for (int corner = 0; corner < 3; ++corner) {
    const glm::dvec3 at = triangle_point(static_cast<uint64_t>(corner) + 1);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(at[i], i == corner ? 2.0 / 3 : 1.0 / 6, 1e-15);
  }
}

// The small triangle of a subdivision of every edge into `n` that a point is in.
int small_triangle(const glm::dvec3& at, int n) {
  const int x = int(at[0] * n), y = int(at[1] * n), z = int(at[2] * n);
  return (x * n + y) * n + z;
}

TEST(TrianglePoints, APowerOfFourOfThemFillsARegularSubdivision) {
  for (const int n : {2, 4, 8, 16, 32}) {
    std::set<int> used;
    for (int i = 0; i < n * n; ++i) {
      const glm::dvec3 at = triangle_point(static_cast<uint64_t>(i));
      EXPECT_NEAR(at[0] + at[1] + at[2], 1, 1e-14);
      EXPECT_GT(std::min({at[0], at[1], at[2]}), 0);
      used.insert(small_triangle(at, n));
    }
    EXPECT_EQ(used.size(), size_t(n) * n);
  }
}

TEST(TrianglePoints, StayInsideForAnyIndex) {
  for (uint64_t index = 1; index != 0; index <<= 1) {
    for (const uint64_t i : {index, ~index, index - 1}) {
      const glm::dvec3 at = triangle_point(i);
      EXPECT_GE(std::min({at[0], at[1], at[2]}), 0) << i;
      EXPECT_NEAR(at[0] + at[1] + at[2], 1, 1e-14) << i;
    }
  }
}

}  // namespace
}  // namespace lodestone::mesh
