// SPDX-License-Identifier: MIT
// All traversals give the same hits, to the bit, on every device and for any number of threads.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "lodestone/layout/tile.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/instanced_scenes.h"
#include "lodestone/test_support/rays.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

std::vector<glm::uvec4> hits_on(render::Backend& backend, const ReadyScene& ready,
                                render::Traversal traversal, const Rays& rays, uint32_t budget = 4000) {
  render::Settings settings;
  settings.width = settings.height = 8;
  settings.traversal = traversal;
  settings.loop_budget = budget;
  render::Renderer renderer(backend, ready.scene, ready.assembly, ready.atlas, settings);
  renderer.update(ready.pose(0.4f));
  renderer.load_rays(rays);
  renderer.trace_loaded();
  return renderer.hits();
}

// On the CPU.
std::vector<glm::uvec4> hits_of(const ReadyScene& ready, render::Traversal traversal, const Rays& rays,
                                uint32_t threads = 0) {
  return hits_on(*open("cpu", {.threads = threads}), ready, traversal, rays);
}

uint64_t count_hits(const std::vector<glm::uvec4>& hits) {
  uint64_t count = 0;
  for (const auto& hit : hits) count += hit.w != layout::no_index ? 1 : 0;
  return count;
}

// Devices are opened once a test: making their kernels takes longer than most of these rays.
class Traversals : public testing::Test {
 protected:
  void expect_all_equal(const ReadyScene& ready, const Rays& rays) {
    const auto expected = hits_of(ready, render::Traversal::threaded, rays);
    EXPECT_GT(count_hits(expected), rays.size() / 20);
    expect_equal_to(expected, ready, rays);
  }
  void expect_equal_to(const std::vector<glm::uvec4>& expected, const ReadyScene& ready, const Rays& rays) {
    using render::Traversal;
    EXPECT_EQ(hits_of(ready, Traversal::octant, rays), expected);
    EXPECT_EQ(hits_of(ready, Traversal::wide, rays), expected);
    EXPECT_EQ(hits_of(ready, Traversal::wide, rays, 1), expected);
    for (const auto& device : devices_) {
      const std::string& name = device->info().name;
      EXPECT_EQ(hits_on(*device, ready, Traversal::threaded, rays), expected) << name;
      EXPECT_EQ(hits_on(*device, ready, Traversal::octant, rays), expected) << name;
      EXPECT_EQ(hits_on(*device, ready, Traversal::octant, rays, 50), expected) << name;
      EXPECT_EQ(hits_on(*device, ready, Traversal::wide, rays), expected) << name;
      EXPECT_EQ(hits_on(*device, ready, Traversal::wide, rays, 50), expected) << name;
      if (device->info().subgroup_size != layout::tile_lanes) continue;
      EXPECT_EQ(hits_on(*device, ready, Traversal::tile, rays), expected) << name;
      EXPECT_EQ(hits_on(*device, ready, Traversal::tile, rays, 5), expected) << name;
    }
  }

 private:
  static std::vector<std::unique_ptr<render::Backend>> opened() {
    std::vector<std::unique_ptr<render::Backend>> devices;
    for (const std::string& name : vulkan_device_names()) devices.push_back(open(name));
    return devices;
  }
  const std::vector<std::unique_ptr<render::Backend>> devices_ = opened();
};

TEST_F(Traversals, AgreeOnRandomRays) {
  expect_all_equal(ReadyScene("builtin:spheres"), random_rays({-4, -1, -4}, {4, 4, 4}, 30000, 1));
  expect_all_equal(ReadyScene("builtin:spheres", geometry_image::AtlasKind::exact),
                   random_rays({-4, -1, -4}, {4, 4, 4}, 30000, 2));
  expect_all_equal(ReadyScene("builtin:spheres", geometry_image::AtlasKind::charts),
                   random_rays({-4, -1, -4}, {4, 4, 4}, 30000, 3));
}

TEST_F(Traversals, AgreeThroughInstances) {
  expect_all_equal(ReadyScene(grove(), {}, scene::Instancing::on),
                   random_rays({-2.5f, -1.5f, -2}, {2.5f, 2.5f, 2}, 20000, 4));
  expect_all_equal(ReadyScene(swarm(500, 3), {}, scene::Instancing::on),
                   random_rays({-3, -3, -3}, {3, 3, 3}, 20000, 5));
}

TEST_F(Traversals, AgreeOnPrimaryRaysWhichTravelTogether) {
  expect_all_equal(ReadyScene(grid_sphere(64)), primary_rays({1.5f, 1, 3}, {0, 0, 0}, 0.4f, 128));
  expect_all_equal(ReadyScene(grid_sphere(37)), primary_rays({0, 0.3f, 3}, {0, 0, 0}, 0.4f, 64));
}

// As shadow rays to one light do, or those of a parallel projection: some of them, of three kinds, mixed with
// what is no ray or has nothing to look for.
TEST_F(Traversals, AgreeOnRaysThatStartNearEachOther) {
  const ReadyScene ready(grid_sphere(64));
  std::mt19937 random(8);
  std::uniform_real_distribution<float> unit(0, 1);
  Rays rays;
  for (uint32_t i = 0; i < 64 * 64; ++i) {
    const float x = static_cast<float>(i % 64) / 32 - 1, y = static_cast<float>(i / 64) / 32 - 1;
    const uint32_t kind = i / 64 % 4 == 3 ? i % 3 : 0;
    const glm::vec3 from[] = {{x, y, 3 + unit(random) * 0.01f}, {3, x, y}, {x, y, -3}};
    const glm::vec3 target = glm::vec3(0.1f, 0.2f, 0) * unit(random);
    add_ray(rays, from[kind], target - from[kind]);
    glm::vec4 &start = rays[rays.size() - 2], &end = rays.back();
    start.w = i % 5 == 0 ? 2.5f * unit(random) : 0;
    if (i % 7 == 0) end.w = 3 * unit(random);
    if (i % 11 == 0) end.w = -1;
    if (i % 97 == 0) start.x = std::numeric_limits<float>::quiet_NaN();
    if (i % 101 == 0) end.y = std::numeric_limits<float>::infinity();
  }
  expect_all_equal(ready, rays);
}

// Devices put those side by side that have something to do, and the others must say that they have hit
// nothing, whatever lay in their places before.
TEST_F(Traversals, AgreeWhereFewRaysHaveAnythingToDo) {
  for (const uint32_t share : {8u, 200u}) {
    Rays rays = random_rays({-4, -1, -4}, {4, 4, 4}, 30000, 9);
    for (size_t i = 0; i < rays.size() / 2; ++i) {
      if (i % share != 3) rays[2 * i + 1].w = -1;
    }
    const ReadyScene ready("builtin:spheres");
    const auto expected = hits_of(ready, render::Traversal::threaded, rays);
    EXPECT_GT(count_hits(expected), rays.size() / (20 * share));
    expect_equal_to(expected, ready, rays);
  }
  Rays none = random_rays({-4, -1, -4}, {4, 4, 4}, 5000, 9);
  for (size_t i = 1; i < none.size(); i += 2) none[i].w = -1;
  const ReadyScene ready("builtin:spheres");
  expect_equal_to(hits_of(ready, render::Traversal::threaded, none), ready, none);
}

TEST_F(Traversals, AgreeOnRaysThroughVerticesAndEdges) {
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

// A stack of `count` triangles that a ray along z at (0.9, 0.9) misses, though it enters every one's bound,
// before one that it hits.
scene::Scene long_way(uint32_t count) {
  scene::Mesh mesh;
  const auto add = [&](float z, float reach) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(reach, 0), glm::vec2(0, reach)}) {
      mesh.positions.emplace_back(corner, z);
      mesh.normals.emplace_back(0, 0, 1);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  };
  for (uint32_t i = 0; i < count; ++i) add(static_cast<float>(i + 1) / static_cast<float>(count), 1);
  add(-1, 3);
  mesh.parts = {{0, count + 1, scene::none}};
  scene::Scene scene;
  scene.name = "long way";
  scene.meshes = {mesh};
  scene.nodes.emplace_back();
  scene.nodes[0].mesh = 0;
  return scene;
}

TEST_F(Traversals, GoOnWhereADeviceCutsLoops) {
  const ReadyScene ready(long_way(24000), geometry_image::AtlasKind::exact);
  Rays rays;
  for (int i = 0; i < 16; ++i) add_ray(rays, {0.9f, 0.9f - 0.001f * static_cast<float>(i), 2}, {0, 0, -1});
  for (const std::string& device : device_names()) {
    const auto backend = open(device, {.counters = true});
    for (const auto traversal :
         {render::Traversal::threaded, render::Traversal::octant, render::Traversal::wide}) {
      render::Settings settings;
      settings.width = settings.height = 8;
      settings.traversal = traversal;
      render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
      renderer.update(ready.pose(0));
      renderer.load_rays(rays);
      backend->finish();
      renderer.trace_loaded();
      uint64_t visits = 0;
      for (const render::PassRecord& pass : backend->finish()) visits += pass.counters.node_visits;
      EXPECT_GT(visits / 16, 65535u) << "the way is too short to show anything";
      for (const glm::uvec4& hit : renderer.hits()) {
        ASSERT_NE(hit.w, layout::no_index) << device;
        EXPECT_FLOAT_EQ(std::bit_cast<float>(hit.x), 3.0f);
      }
    }
  }
}

// Bounds in 16 bits, flat ones, seen from so far that rounding enters empty children too; trees of odd and
// even depth.
TEST_F(Traversals, AgreeOnFlatSurfacesFromFarAway) {
  for (const uint32_t quads : {3u, 7u, 20u}) {
    for (int axis = 0; axis < 3; ++axis) {
      scene::Scene flat = grid_sphere(quads);
      for (glm::vec3& position : flat.meshes[0].positions) position[axis] = 0.25f;
      const ReadyScene ready(std::move(flat));
      Rays rays;
      for (const float distance : {2.0f, 3e3f, 4e6f}) {
        for (int i = 0; i < 500; ++i) {
          const auto turn = static_cast<float>(i);
          glm::vec3 eye(std::sin(turn) * distance, std::cos(2 * turn) * distance,
                        std::sin(3 * turn) * distance);
          const glm::vec3 target(0.9f * std::sin(5 * turn), 0.9f * std::cos(7 * turn),
                                 0.8f * std::sin(11 * turn));
          add_ray(rays, eye, glm::normalize(target - eye));
        }
      }
      expect_all_equal(ready, rays);
    }
  }
}

TEST_F(Traversals, AgreeAtEveryVectorWidth) {
  const ReadyScene ready(grid_sphere(48));
  Rays rays = primary_rays({1.5f, 1, 3}, {0, 0, 0}, 0.4f, 64);
  // From one point through vertices and the middles of edges, as many side by side as go together; some of
  // them are no rays.
  const glm::vec3 eye(1.5f, 1, 3);
  const std::vector<glm::vec3> texels = ready.texels(ready.pose(0));
  for (size_t i = 0; i + 1 < texels.size(); ++i) {
    add_ray(rays, eye, texels[i] - eye);
    add_ray(rays, eye, 0.5f * (texels[i] + texels[i + 1]) - eye);
    if (i % 500 == 0) rays.back().w = -1;
    if (i % 700 == 0) rays.back().x = std::numeric_limits<float>::quiet_NaN();
  }
  const Rays more = random_rays({-1, -1, -1}, {1, 1, 1}, 4000, 9);
  rays.insert(rays.end(), more.begin(), more.end());
  const auto expected = hits_of(ready, render::Traversal::threaded, rays);
  const int64_t all = hwy::SupportedTargets() & HWY_TARGETS;
  int widths = 0;
  for (int64_t rest = all; rest != 0; rest &= rest - 1) {
    hwy::SetSupportedTargetsForTest(rest & -rest);
    EXPECT_EQ(hits_of(ready, render::Traversal::wide, rays), expected) << hwy::TargetName(rest & -rest);
    ++widths;
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GE(widths, 1);
}

}  // namespace
}  // namespace lodestone::test
