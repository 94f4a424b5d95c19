// SPDX-License-Identifier: MIT
#include "lodestone/mesh/triangle_tree.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "lodestone/base/parallel.h"
#include "lodestone/mesh/point_triangle.h"
#include "shapes.h"

namespace lodestone::mesh {
namespace {

using test::random_point;
using test::Shape;
using test::soup;

double distance_to(const Shape& shape, uint32_t triangle, const glm::dvec3& p) {
  const glm::uvec3& t = shape.triangles[triangle];
  return glm::length(
      offset_from_triangle(p, shape.positions[t[0]], shape.positions[t[1]], shape.positions[t[2]]));
}

double brute_force(const Shape& shape, const glm::dvec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (uint32_t i = 0; i < shape.triangles.size(); ++i) best = std::min(best, distance_to(shape, i, p));
  return best;
}

void expect_brute_force(const Shape& shape, const TriangleTree& tree, const glm::dvec3& p) {
  const double expected = brute_force(shape, p);
  const Nearest found = tree.nearest(p);
  EXPECT_NEAR(found.distance, expected, 1e-15 * expected);
  ASSERT_LT(found.triangle, shape.triangles.size());
  EXPECT_EQ(distance_to(shape, found.triangle, p), found.distance);
  EXPECT_NEAR(glm::distance(found.point, p), found.distance, 1e-15 + 1e-15 * glm::length(p));
}

TEST(TriangleTree, FindsWhatBruteForceFindsInSoups) {
  for (const uint32_t count : {1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 33u, 500u, 3000u}) {
    const Shape shape = soup(count, count);
    const TriangleTree tree(shape);
    std::mt19937 random(7);
    for (int i = 0; i < 200; ++i) {
      const glm::vec3 corner = shape.positions[random() % shape.positions.size()];
      for (const float reach : {0.0f, 1e-3f, 0.1f, 3.0f, 1e3f})
        expect_brute_force(shape, tree, glm::dvec3(corner + reach * random_point(random)));
    }
  }
}

// Faults of surfaces that a split by space alone would not end at, or not in time.
TEST(TriangleTree, TakesTrianglesThatCannotBeSplit) {
  Shape same, nested, geometric;
  for (int i = 0; i < 1000; ++i) same.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (int i = 1; i < 500; ++i) nested.add({-i, -i, 0}, {i, -i, 0}, {0, i, 0});
  for (int i = -140; i < 120; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 at(0);
      at[axis] = std::ldexp(1.0f, i);
      for (int copy = 0; copy < 20; ++copy) geometric.add(at, at, 1.5f * at);
    }
  }
  std::mt19937 random(8);
  for (const Shape* shape : {&same, &nested, &geometric}) {
    const TriangleTree tree(*shape);
    for (int i = 0; i < 100; ++i) {
      const float size = std::ldexp(1.0f, int(random() % 40) - 30);
      expect_brute_force(*shape, tree, glm::dvec3(size * random_point(random)));
    }
  }
}

TEST(TriangleTree, FindsNothingBeyondTheBound) {
  const TriangleTree tree(test::plane(10, 0));
  const glm::dvec3 p(0.5, 0.5, 2);
  EXPECT_EQ(tree.nearest(p, 1.99).triangle, none);
  EXPECT_EQ(tree.nearest(p, 1.99).distance, std::numeric_limits<double>::infinity());
  for (const double within : {2.0, 2.01, 1e300, std::numeric_limits<double>::infinity()}) {
    const Nearest found = tree.nearest(p, within);
    EXPECT_EQ(found.distance, 2);
    EXPECT_EQ(found.point, glm::dvec3(0.5, 0.5, 0));
  }
  EXPECT_EQ(tree.nearest({0.3f, 0.3f, 0}, 0).distance, 0);
}

TEST(TriangleTree, FindsTheLargestAndTheSmallestFloats) {
  for (const float size : {1e-44f, 1e-20f, 1e20f, 3e38f}) {
    Shape shape = soup(9, 200);
    for (glm::vec3& position : shape.positions) position *= size / 2;
    const TriangleTree tree(shape);
    std::mt19937 random(9);
    for (int i = 0; i < 50; ++i)
      expect_brute_force(shape, tree, double(size) * glm::dvec3(random_point(random)));
  }
}

TEST(TriangleTree, AnEmptySurfaceHasNoNearestPoint) {
  const std::vector<glm::vec3> unused = {{1, 2, 3}};
  const TriangleTree tree(Surface{unused, {}});
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.nearest({1, 2, 3}).triangle, none);
}

TEST(TriangleTree, RefusesIndicesOutOfRangeAndInfinitePositions) {
  Shape shape = soup(1, 100);
  shape.positions.push_back(glm::vec3(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_NO_THROW(TriangleTree{shape}) << "no triangle uses it";
  const auto last = static_cast<uint32_t>(shape.positions.size() - 1);
  shape.triangles[50].y = last;
  EXPECT_THROW(TriangleTree{shape}, std::invalid_argument);
  shape.positions[last] = glm::vec3(0, std::numeric_limits<float>::infinity(), 0);
  EXPECT_THROW(TriangleTree{shape}, std::invalid_argument);
  shape.triangles[50].y = last + 1;
  EXPECT_THROW(TriangleTree{shape}, std::invalid_argument);
}

TEST(TriangleTree, DoesNotDependOnThreads) {
  const Shape shape = soup(11, 50000);
  std::vector<uint32_t> expected;
  for (const uint32_t threads : {1u, 2u, 3u, 0u}) {
    set_thread_count(threads);
    const TriangleTree tree(shape);
    std::vector<uint32_t> triangles(500);
    parallel_for(triangles.size(), 10, [&](uint64_t begin, uint64_t end) {
      for (uint64_t i = begin; i < end; ++i)
        triangles[i] = tree.nearest(glm::dvec3(shape.positions[i * 3]) * 1.01).triangle;
    });
    if (expected.empty()) expected = triangles;
    EXPECT_EQ(triangles, expected) << threads;
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace lodestone::mesh
