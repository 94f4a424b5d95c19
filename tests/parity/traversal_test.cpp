// SPDX-License-Identifier: MIT
// All traversals give the same hits, to the bit, on every device and for any number of threads.
#include <gtest/gtest.h>

#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/rays.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

std::vector<glm::uvec4> hits_of(const ReadyScene& ready, const std::string& device,
                                render::Traversal traversal, const Rays& rays, uint32_t threads = 0,
                                uint32_t budget = 4000) {
  const auto backend = open(device, {.threads = threads});
  render::Settings settings;
  settings.width = settings.height = 8;
  settings.traversal = traversal;
  settings.loop_budget = budget;
  render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
  renderer.update(ready.pose(0.4f));
  renderer.load_rays(rays);
  renderer.trace_loaded();
  return renderer.hits();
}

uint64_t count_hits(const std::vector<glm::uvec4>& hits) {
  uint64_t count = 0;
  for (const auto& hit : hits) count += hit.w != layout::no_index ? 1 : 0;
  return count;
}

void expect_all_equal(const ReadyScene& ready, const Rays& rays) {
  const auto expected = hits_of(ready, "cpu", render::Traversal::threaded, rays);
  EXPECT_GT(count_hits(expected), rays.size() / 20);
  EXPECT_EQ(hits_of(ready, "cpu", render::Traversal::octant, rays), expected);
  EXPECT_EQ(hits_of(ready, "cpu", render::Traversal::wide, rays), expected);
  EXPECT_EQ(hits_of(ready, "cpu", render::Traversal::wide, rays, 1), expected);
  for (const std::string& device : device_names()) {
    if (device == "cpu") continue;
    EXPECT_EQ(hits_of(ready, device, render::Traversal::threaded, rays), expected) << device;
    EXPECT_EQ(hits_of(ready, device, render::Traversal::octant, rays), expected) << device;
    EXPECT_EQ(hits_of(ready, device, render::Traversal::octant, rays, 0, 50), expected) << device;
  }
}

TEST(Traversals, AgreeOnRandomRays) {
  expect_all_equal(ReadyScene("builtin:spheres"), random_rays({-4, -1, -4}, {4, 4, 4}, 30000, 1));
  expect_all_equal(ReadyScene("builtin:spheres", geometry_image::AtlasKind::exact),
                   random_rays({-4, -1, -4}, {4, 4, 4}, 30000, 2));
}

TEST(Traversals, AgreeOnPrimaryRaysWhichTravelAsPackets) {
  expect_all_equal(ReadyScene(grid_sphere(64)), primary_rays({1.5f, 1, 3}, {0, 0, 0}, 0.4f, 128));
  expect_all_equal(ReadyScene(grid_sphere(37)), primary_rays({0, 0.3f, 3}, {0, 0, 0}, 0.4f, 64));
}

TEST(Traversals, AgreeOnRaysThroughVerticesAndEdges) {
  const ReadyScene ready(grid_sphere(24));
  const auto texels = ready.texels(ready.pose(0));
  const QuadTriangles quads = quad_triangles(ready.atlas);
  Rays rays;
  const glm::vec3 eye(0.25f, 0.5f, 3);
  for (const glm::uvec3& t : quads.texels) {
    add_ray(rays, eye, texels[t.x] - eye);
    add_ray(rays, eye, (texels[t.x] + texels[t.y]) * 0.5f - eye);
    add_ray(rays, eye, (texels[t.y] + texels[t.z]) * 0.5f - eye);
    add_ray(rays, {texels[t.x].x, texels[t.x].y, 3}, {0, 0, -1});  // along an axis
  }
  expect_all_equal(ready, rays);
}

}  // namespace
}  // namespace lodestone::test
