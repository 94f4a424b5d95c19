// SPDX-License-Identifier: MIT
#include "lodestone/mesh/point_triangle.h"

#include <gtest/gtest.h>

#include <random>

#include "shapes.h"

namespace lodestone::mesh {
namespace {

const glm::dvec3 a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);

void expect_nearest(const glm::dvec3& p, const glm::dvec3& nearest) {
  const glm::dvec3 found = p - offset_from_triangle(p, a, b, c);
  EXPECT_LT(glm::distance(found, nearest), 1e-14) << found.x << " " << found.y << " " << found.z;
}

TEST(PointTriangle, EveryRegionHasItsNearestPoint) {
  expect_nearest({1, 1, 5}, {1, 1, 0});
  expect_nearest({1, 1, 0}, {1, 1, 0});
  expect_nearest({1, 1, -5}, {1, 1, 0});
  expect_nearest({-1, -2, 3}, a);
  expect_nearest({6, -1, 3}, b);
  expect_nearest({-1, 5, -3}, c);
  expect_nearest({1, -2, 3}, {1, 0, 0});
  expect_nearest({-2, 1, 3}, {0, 1, 0});
  expect_nearest({2 + 3, 1.5 + 4, 7}, {2, 1.5, 0});
}

TEST(PointTriangle, ACornerIsAtDistanceZeroExactly) {
  for (const test::Shape& shape : {test::soup(1, 4000), test::soup(2, 4000)}) {
    for (const glm::uvec3& t : shape.triangles) {
      const glm::dvec3 corners[3] = {shape.positions[t[0]], shape.positions[t[1]], shape.positions[t[2]]};
      for (const glm::dvec3& corner : corners)
        EXPECT_EQ(offset_from_triangle(corner, corners[0], corners[1], corners[2]), glm::dvec3(0));
    }
  }
}

// The smallest distance to the slices of the triangle that are parallel to its edge from corner 1 to corner
// 2; it is a convex function of where the slice is.
double searched_distance(const glm::dvec3& p, const glm::dvec3 (&corners)[3]) {
  const glm::dvec3 from_start = p - corners[0], to_1 = corners[1] - corners[0],
                   to_2 = corners[2] - corners[0];
  const auto slice = [&](double x) {
    return glm::length(offset_from_segment(from_start - x * to_1, x * (to_2 - to_1)));
  };
  double lo = 0, hi = 1;
  for (int i = 0; i < 120; ++i) {
    const double a_third = lo + (hi - lo) / 3, two_thirds = hi - (hi - lo) / 3;
    (slice(a_third) < slice(two_thirds) ? hi : lo) =
        slice(a_third) < slice(two_thirds) ? two_thirds : a_third;
  }
  return std::min({slice(0), slice(lo), slice(1)});
}

TEST(PointTriangle, NoPointOfATriangleIsNearerAndTheFoundOneIsOnIt) {
  std::mt19937 random(3);
  const test::Shape shape = test::soup(4, 400);
  for (const glm::uvec3& t : shape.triangles) {
    const glm::dvec3 corners[3] = {shape.positions[t[0]], shape.positions[t[1]], shape.positions[t[2]]};
    for (int i = 0; i < 4; ++i) {
      const glm::dvec3 p =
          corners[random() % 3] + std::exp2(-double(random() % 12)) * glm::dvec3(test::random_point(random));
      const glm::dvec3 offset = offset_from_triangle(p, corners[0], corners[1], corners[2]);
      const double searched = searched_distance(p, corners);
      EXPECT_NEAR(glm::length(offset), searched, 1e-8);
      EXPECT_LT(searched_distance(p - offset, corners), 1e-8);
    }
  }
}

TEST(PointTriangle, DoesNotLoseItselfFarFromANeedle) {
  const glm::dvec3 tip(1000, 0, 0), side(999, 1e-4, 0);
  const glm::dvec3 p(500, 0.5, 1e6);
  EXPECT_NEAR(glm::length(offset_from_triangle(p, a, tip, side)), 1e6, 1e-6);
  EXPECT_LT(glm::distance(p - offset_from_triangle(p, a, tip, side), {500, 0, 0}), 1e-3);
}

TEST(PointTriangle, IsFiniteForTheSmallestAndTheLargestFloats) {
  for (const double size : {1e-45, 1e-38, 1e38}) {
    const glm::dvec3 p = size * glm::dvec3(1, 1, 2);
    EXPECT_NEAR(glm::length(offset_from_triangle(p, size * a, size * b, size * c)), 2 * size, 1e-12 * size);
    EXPECT_NEAR(glm::length(offset_from_triangle({1, 1, 2}, size * a, size * a, size * a)), std::sqrt(6.0),
                1e-12)
        << size;
  }
}

}  // namespace
}  // namespace lodestone::mesh
