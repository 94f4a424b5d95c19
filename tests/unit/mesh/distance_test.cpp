// SPDX-License-Identifier: MIT
#include "lodestone/mesh/distance.h"

#include <gtest/gtest.h>

#include <bit>
#include <stdexcept>

#include "lodestone/base/parallel.h"
#include "lodestone/mesh/point_triangle.h"
#include "shapes.h"

namespace lodestone::mesh {
namespace {

using test::cube;
using test::plane;
using test::Shape;
using test::soup;
using test::sphere;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Distance, OfParallelPlanesIsTheirGap) {
  const SymmetricDistance distance = symmetric(plane(10, 0), plane(7, 0.25f), 5000);
  for (const OneSidedDistance& side : {distance.forth, distance.back}) {
    EXPECT_NEAR(side.maximum, 0.25, 1e-15);
    EXPECT_NEAR(side.mean, 0.25, 1e-14);
    EXPECT_NEAR(side.root_mean_square, 0.25, 1e-14);
    EXPECT_NEAR(double(side.samples), 5000, 500);
  }
  EXPECT_NEAR(distance.hausdorff(), 0.25, 1e-15);
}

// The unit square against a line along its side: the distance of (x, y, 0) is x.
TEST(Distance, MeanAndRootMeanSquareAreOverTheArea) {
  Shape flat = plane(1, 0);
  // One half in a few large triangles, the other in many small ones: area must count, not triangles.
  Shape uneven;
  uneven.add({0, 0, 0}, {0.5f, 0, 0}, {0, 1, 0});
  uneven.add({0.5f, 1, 0}, {0, 1, 0}, {0.5f, 0, 0});
  const Shape fine = plane(64, 0);
  for (const glm::uvec3& t : fine.triangles) {
    const auto half = [&](uint32_t v) {
      return glm::vec3(0.5f + fine.positions[v].x / 2, fine.positions[v].y, 0);
    };
    uneven.add(half(t[0]), half(t[1]), half(t[2]));
  }
  Shape edge;
  edge.add({0, -1, 0}, {0, 2, 0}, {0, 0, 0});
  for (const Shape* from : {&flat, &uneven}) {
    const OneSidedDistance distance = one_sided(*from, edge, 100000);
    EXPECT_NEAR(distance.mean, 0.5, 1e-4);
    EXPECT_NEAR(distance.root_mean_square, std::sqrt(1.0 / 3), 1e-4);
    EXPECT_EQ(distance.maximum, 1);
    EXPECT_EQ(distance.farthest.point.x, 1);
    EXPECT_EQ(distance.farthest.nearest.x, 0);
    EXPECT_EQ(distance.farthest.nearest_triangle, 0u);
  }
}

TEST(Distance, OfConcentricSpheresIsTheDifferenceOfTheirRadii) {
  const SymmetricDistance distance = symmetric(sphere(60, 1), sphere(60, 1.5), 20000);
  // Facets are up to 1 - cos(pi / 120) inside of their sphere, 3.4e-4, squares twice that.
  for (const OneSidedDistance& side : {distance.forth, distance.back}) {
    EXPECT_NEAR(side.maximum, 0.5, 2e-3);
    EXPECT_NEAR(side.mean, 0.5, 2e-3);
    EXPECT_NEAR(side.root_mean_square, 0.5, 2e-3);
    EXPECT_GE(side.root_mean_square, side.mean * (1 - 1e-12));
    EXPECT_GE(side.maximum, side.root_mean_square);
  }
}

TEST(Distance, OfACubeWithASpikeIsTheSpike) {
  const Shape smooth = cube();
  Shape spiked = cube();
  const auto base = static_cast<uint32_t>(spiked.triangles.size());
  spiked.add({0, 0, 1}, {0.01f, 0, 1}, {0, 0, 4});
  const SymmetricDistance distance = symmetric(spiked, smooth, 10000);
  EXPECT_EQ(distance.hausdorff(), 3);
  EXPECT_EQ(distance.forth.maximum, 3);
  EXPECT_EQ(distance.forth.farthest.point, glm::dvec3(0, 0, 4));
  EXPECT_EQ(distance.forth.farthest.triangle, base);
  EXPECT_EQ(distance.forth.farthest.nearest, glm::dvec3(0, 0, 1));
  EXPECT_LT(distance.back.maximum, 1e-15);
  EXPECT_LT(distance.forth.mean, 0.01);
}

TEST(Distance, OneVertexFarAwayIsFoundWhereItIs) {
  const Shape before = sphere(50, 1);
  Shape after = before;
  after.positions[2345] *= 1000.0f;
  const OneSidedDistance distance = one_sided(after, before, 1);
  EXPECT_NEAR(distance.maximum, 999, 1e-3);
  EXPECT_EQ(distance.farthest.point, glm::dvec3(after.positions[2345]));
  const glm::uvec3& triangle = after.triangles[distance.farthest.triangle];
  EXPECT_TRUE(triangle.x == 2345 || triangle.y == 2345 || triangle.z == 2345);
}

// Corners exactly, points inside to the rounding of their own coordinates, in needles that have no normal to
// their height.
TEST(Distance, OfASurfaceFromItselfIsZero) {
  for (const Shape& shape : {sphere(60, 1), cube(), plane(20, 0.1f)})
    EXPECT_LT(one_sided(shape, shape, 20000).maximum, 1e-15);
  const Shape faulty = soup(5, 3000);
  EXPECT_LT(one_sided(faulty, faulty, 20000).maximum, 4e-8);
}

TEST(Distance, EveryVertexOnceAndEveryTriangleAtLeastOnce) {
  const Shape shape = plane(10, 0);
  EXPECT_EQ(one_sided(shape, shape, 0).samples, 121u + 200u);
  EXPECT_EQ(one_sided(shape, shape, 200).samples, 121u + 200u);
  EXPECT_EQ(one_sided(shape, shape, 2000).samples, 121u + 2000u);
}

// The maximum over samples found one by one, without a tree and without bounds from sample to sample.
TEST(Distance, AgreesWithBruteForceAtTheVertices) {
  const Shape from = soup(21, 300), to = soup(22, 300);
  double farthest = 0;
  for (const glm::vec3& p : from.positions) {
    double nearest = infinity;
    for (const glm::uvec3& t : to.triangles) {
      nearest = std::min(nearest, glm::length(offset_from_triangle(p, to.positions[t[0]], to.positions[t[1]],
                                                                   to.positions[t[2]])));
    }
    farthest = std::max(farthest, nearest);
  }
  const OneSidedDistance distance = one_sided(from, to, 10000);
  EXPECT_GE(distance.maximum, farthest * (1 - 1e-14));
  EXPECT_LE(distance.maximum, farthest + 0.5);
  EXPECT_NEAR(glm::distance(distance.farthest.point, distance.farthest.nearest), distance.maximum, 1e-14);
}

TEST(Distance, ThreadsDoNotShowInTheBits) {
  const Shape from = soup(31, 4000), to = soup(32, 4000);
  std::vector<uint64_t> expected;
  for (const uint32_t threads : {1u, 2u, 3u, 0u}) {
    set_thread_count(threads);
    const OneSidedDistance distance = one_sided(from, to, 6000);
    const glm::dvec3 &point = distance.farthest.point, &nearest = distance.farthest.nearest;
    std::vector<uint64_t> bits = {distance.samples, distance.farthest.triangle,
                                  distance.farthest.nearest_triangle};
    for (const double value : {distance.maximum, distance.mean, distance.root_mean_square, point.x, point.y,
                               point.z, nearest.x, nearest.y, nearest.z})
      bits.push_back(std::bit_cast<uint64_t>(value));
    if (expected.empty()) expected = bits;
    EXPECT_EQ(bits, expected) << threads;
  }
  set_thread_count(0);
}

TEST(Distance, OfSurfacesWithoutAreaCountsTheirTrianglesAlike) {
  Shape points;
  for (const float z : {1.0f, 2.0f, 3.0f}) points.add({0.5f, 0.5f, z}, {0.5f, 0.5f, z}, {0.5f, 0.5f, z});
  const OneSidedDistance distance = one_sided(points, plane(1, 0), 30);
  EXPECT_EQ(distance.maximum, 3);
  EXPECT_NEAR(distance.mean, 2, 1e-14);
  EXPECT_NEAR(distance.root_mean_square, std::sqrt(14.0 / 3), 1e-14);
}

TEST(Distance, OfNothingIsZeroAndToNothingIsInfinite) {
  const Shape nothing, something = cube();
  const SymmetricDistance distance = symmetric(nothing, something, 100);
  EXPECT_EQ(distance.forth.maximum, 0);
  EXPECT_EQ(distance.forth.mean, 0);
  EXPECT_EQ(distance.forth.samples, 0u);
  EXPECT_EQ(distance.forth.farthest.triangle, none);
  EXPECT_EQ(distance.back.maximum, infinity);
  EXPECT_EQ(distance.back.mean, infinity);
  EXPECT_EQ(distance.back.root_mean_square, infinity);
  EXPECT_EQ(distance.back.farthest.triangle, none);
  EXPECT_EQ(distance.hausdorff(), infinity);
  EXPECT_EQ(symmetric(nothing, nothing).hausdorff(), 0);
}

TEST(Distance, RefusesABadSurfaceOnEitherSide) {
  Shape bad = cube();
  bad.triangles[3].z = 8;
  const TriangleTree good(cube());
  EXPECT_THROW(one_sided(bad, good), std::invalid_argument);
  EXPECT_THROW(one_sided(cube(), bad), std::invalid_argument);
}

}  // namespace
}  // namespace lodestone::mesh
