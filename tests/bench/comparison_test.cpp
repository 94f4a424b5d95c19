// SPDX-License-Identifier: MIT
// The tracers that the product is compared with must be right to be worth it.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/embree_scene.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/ready_scene.h"
#include "threaded_bvh.h"
#include "threaded_kernel.h"
#include "uniform_grid.h"

namespace lodestone::test {
namespace {

struct Sphere {
  std::vector<glm::vec3> points;
  std::vector<glm::uvec3> corners;
  std::vector<Triangle> triangles;
  Rays rays = random_rays(glm::vec3(-1.1f), glm::vec3(1.1f), 100000, 3);
  std::vector<EmbreeHit> truth;

  Sphere() {
    const scene::Scene scene = grid_sphere(64);
    points = scene.meshes[0].positions;
    corners = scene.meshes[0].triangles;
    triangles = triangles_of(points, corners);
    EmbreeScene(points, corners, true).intersect(rays, truth);
  }

  // Rays whose hit is not Embree's: one in 100,000 may graze an edge.
  uint64_t different(const std::vector<TriangleHit>& hits) const {
    uint64_t count = 0;
    for (size_t i = 0; i < truth.size(); ++i) {
      const bool hit = hits[i].triangle != no_triangle;
      if (hit != (truth[i].triangle != ~0u) || (hit && !(std::abs(hits[i].t - truth[i].t) <= 4e-5f))) ++count;
    }
    return count;
  }
};

TEST(ThreadedBvh, FindsWhatEmbreeFinds) {
  const Sphere sphere;
  std::vector<TriangleHit> hits;
  ThreadedBvh(sphere.triangles).intersect(sphere.rays, hits);
  EXPECT_LE(sphere.different(hits), 1u);
}

TEST(ThreadedBvh, LinksEveryTriangleOnceInDepthFirstOrder) {
  const Sphere sphere;
  const ThreadedBvh bvh(sphere.triangles);
  ASSERT_EQ(bvh.nodes().size(), 2 * sphere.triangles.size() - 1);
  std::vector<uint32_t> seen(sphere.triangles.size(), 0);
  for (uint32_t i = 0; i < bvh.nodes().size(); ++i) {
    const ThreadedBvh::Node& node = bvh.nodes()[i];
    if (node.triangle != no_triangle) ++seen[node.triangle];
    const uint32_t after = node.triangle != no_triangle ? i + 1 : bvh.nodes()[bvh.nodes()[i + 1].miss].miss;
    EXPECT_EQ(node.miss, after) << i;
  }
  EXPECT_EQ(seen, std::vector<uint32_t>(seen.size(), 1));
}

TEST(ThreadedBvh, TakesTrianglesThatLieInOnePlace) {
  const ThreadedBvh bvh(std::vector<Triangle>(5, Triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  Rays rays;
  add_ray(rays, {0.2f, 0.2f, 1}, {0, 0, -1});
  std::vector<TriangleHit> hits;
  bvh.intersect(rays, hits);
  EXPECT_EQ(bvh.nodes().size(), 9u);
  EXPECT_FLOAT_EQ(hits[0].t, 1);
  EXPECT_THROW(ThreadedBvh({}), std::invalid_argument);
}

TEST(ThreadedKernel, FindsTheSameOnEveryDevice) {
  const Sphere sphere;
  const ThreadedBvh bvh(sphere.triangles);
  std::vector<TriangleHit> first;
  for (const std::string& device : device_names()) {
    ThreadedKernel kernel(bvh, device);
    kernel.load_rays(sphere.rays);
    kernel.trace();
    const std::vector<TriangleHit> hits = kernel.hits();
    EXPECT_LE(sphere.different(hits), 1u) << device;
    if (first.empty()) first = hits;
    for (size_t i = 0; i < hits.size(); ++i) {
      ASSERT_EQ(hits[i].triangle, first[i].triangle) << device << " ray " << i;
      ASSERT_EQ(hits[i].t, first[i].t) << device << " ray " << i;
    }
  }
}

TEST(UniformGrid, FindsWhatEmbreeFinds) {
  const Sphere sphere;
  for (const float density : {0.05f, 5.0f, 60.0f}) {
    std::vector<TriangleHit> hits;
    UniformGrid(sphere.triangles, density).intersect(sphere.rays, hits);
    EXPECT_LE(sphere.different(hits), 1u) << density;
  }
}

TEST(UniformGrid, TakesAFlatSheetAndRaysAlongItsAxes) {
  const UniformGrid grid({{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{4, 4, 0}, {0, 4, 0}, {4, 0, 0}}}, 8);
  Rays rays;
  add_ray(rays, {1, 1, 2}, {0, 0, -1});
  add_ray(rays, {3, 3, -2}, {0, 0, 1});
  add_ray(rays, {1, 1, 2}, {0, 0, 1});
  add_ray(rays, {5, 1, 2}, {0, 0, -1});
  std::vector<TriangleHit> hits;
  grid.intersect(rays, hits);
  EXPECT_EQ(hits[0].triangle, 0u);
  EXPECT_EQ(hits[1].triangle, 1u);
  EXPECT_FLOAT_EQ(hits[1].t, 2);
  EXPECT_EQ(hits[2].triangle, no_triangle);
  EXPECT_EQ(hits[3].triangle, no_triangle);
  EXPECT_THROW(UniformGrid({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, 5), std::invalid_argument);
}

TEST(TraceCounts, AreThoseOfTheRays) {
  const Sphere sphere;
  Rays miss;
  add_ray(miss, {3, 3, 3}, {0, 0, 1});
  const TraceCounts missed = ThreadedBvh(sphere.triangles).count(miss);
  EXPECT_EQ(missed.steps, 1u);
  EXPECT_EQ(missed.triangle_tests, 0u);
  Rays through;
  add_ray(through, {0.1f, 0.2f, 3}, {0, 0, -1});
  EXPECT_GE(ThreadedBvh(sphere.triangles).count(through).triangle_tests, 1u);
  Rays past;
  add_ray(past, {0.9f, 0.9f, 3}, {0, 0, -1});  // through a corner of the grid's box, beside the sphere
  const UniformGrid grid(sphere.triangles, 5);
  EXPECT_EQ(grid.count(past).steps, grid.cells().z);
  EXPECT_EQ(grid.count(past).triangle_tests, 0u);
  EXPECT_GE(grid.count(through).triangle_tests, 1u);
}

}  // namespace
}  // namespace lodestone::test
