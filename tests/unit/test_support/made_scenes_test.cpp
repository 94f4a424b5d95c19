// SPDX-License-Identifier: MIT
// Scenes that benches make at any resolution.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "lodestone/scene/load.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/head_chart.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/regrid.h"
#include "lodestone/test_support/secondary_rays.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

TEST(HeadChart, IsOneClosedChartOfTheResolutionAsked) {
  for (const uint32_t quads : {4u, 8u, 30u}) {
    const scene::Scene scene = head_chart(quads);
    scene::validate(scene);
    const ReadyScene ready(scene);
    ASSERT_EQ(ready.atlas.charts.size(), 1u) << quads;
    EXPECT_EQ(ready.atlas.report.quads, uint64_t(quads) * quads);
    EXPECT_TRUE(ready.atlas.report.closed()) << quads;
  }
  EXPECT_THROW(head_chart(7), std::invalid_argument);
  EXPECT_THROW(head_chart(2), std::invalid_argument);
}

TEST(HeadChart, FacesOutwardsAndMovesWithTheClip) {
  const ReadyScene ready(head_chart(32));
  const auto rest = ready.texels(ready.pose(0)), talking = ready.texels(ready.pose(1.4f));
  double volume = 0, moved = 0;
  for (const glm::uvec3& t : quad_triangles(ready.atlas).texels)
    volume += glm::dot(rest[t.x], glm::cross(rest[t.y], rest[t.z])) / 6;
  for (size_t i = 0; i < rest.size(); ++i) moved = std::max(moved, double(glm::length(talking[i] - rest[i])));
  EXPECT_GT(volume, 1);
  EXPECT_GT(moved, 0.05);
}

uint64_t placed_quads(const scene::Scene& scene) {
  return scene::assemble(scene).triangles.size() / 2;
}

TEST(Regridded, HasAboutTheQuadsAskedAndTheSameShape) {
  const scene::Scene scene = scene::load("builtin:teapots");
  const scene::Bounds all = scene::pose_bounds(scene, scene::evaluate(scene, scene::none, 0));
  for (const uint64_t quads : {16384u, 200000u}) {
    const scene::Scene made = regridded(scene, quads);
    scene::validate(made);
    EXPECT_NEAR(double(placed_quads(made)) / double(quads), 1, 0.08) << quads;
    const scene::Bounds bounds = scene::pose_bounds(made, scene::evaluate(made, scene::none, 0));
    EXPECT_LT(glm::length(bounds.lo - all.lo) + glm::length(bounds.hi - all.hi), 1);
  }
  // A quad a grid is the least.
  const scene::Scene least = regridded(scene, 1);
  uint64_t grids = 0;
  for (const scene::Node& node : scene.nodes)
    grids += node.mesh == scene::none ? 0 : scene.meshes[node.mesh].grids.size();
  EXPECT_EQ(placed_quads(least), grids);
}

TEST(Regridded, KeepsEverySampleWhereNothingChanges) {
  const scene::Scene scene = scene::load("builtin:teapots");
  const scene::Scene made = regridded(scene, placed_quads(scene));
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    const scene::Mesh &from = scene.meshes[m], &to = made.meshes[m];
    ASSERT_EQ(from.triangles.size(), to.triangles.size());
    ASSERT_EQ(from.parts.size(), to.parts.size());
    for (size_t t = 0; t < from.triangles.size(); ++t) {
      for (int corner = 0; corner < 3; ++corner)
        ASSERT_EQ(from.positions[from.triangles[t][corner]], to.positions[to.triangles[t][corner]]);
    }
  }
}

TEST(Regridded, RefusesWhatIsNotRigidGrids) {
  EXPECT_THROW(regridded(scene::load("builtin:head"), 100), std::invalid_argument);
  EXPECT_THROW(regridded(facing_camera({square(0, scene::none)}, {}), 100), std::invalid_argument);
}

TEST(LensRays, MeetInThePlaneOfFocus) {
  render::View view;
  view.origin = {1, 2, 3};
  const Rays pinhole = primary_rays(view, 16), rays = lens_rays(view, 16, 5, 0.4f, 1);
  ASSERT_EQ(rays.size(), pinhole.size());
  float farthest = 0;
  for (size_t i = 0; i < rays.size(); i += 2) {
    const glm::vec3 from(rays[i]), along(rays[i + 1]), sharp_along(pinhole[i + 1]);
    farthest = std::max(farthest, glm::length(from - view.origin));
    const glm::vec3 there = from + along * (-5 / along.z),
                    sharp = view.origin + sharp_along * (-5 / sharp_along.z);
    EXPECT_LT(glm::length(there - sharp), 1e-4f);
  }
  EXPECT_LE(farthest, 0.4001f);
  EXPECT_GT(farthest, 0.3f);
  view.perspective = false;
  EXPECT_THROW(lens_rays(view, 16, 5, 0.4f, 1), std::invalid_argument);
}

TEST(GlossyRays, LeaveTheSurfaceRoundTheMirroredDirection) {
  const ReadyScene ready(facing_camera({square(0, scene::none)}, {}), geometry_image::AtlasKind::exact);
  const auto backend = open("cpu");
  render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, {});
  renderer.update(ready.pose(0));
  Rays rays;
  for (int i = 0; i < 64; ++i) add_ray(rays, {-0.5f, 0.1f, 1}, {0.6f, 0, -1});
  add_ray(rays, {9, 9, 3}, {0, 0, 1});         // meets nothing
  add_ray(rays, {0.1f, 0.1f, -2}, {0, 0, 1});  // from behind
  renderer.load_rays(rays);
  renderer.trace_loaded();
  const auto hits = renderer.hits();
  const Rays mirrored = glossy_rays(rays, hits, ready, ready.pose(0), 0.01f, 1);
  ASSERT_EQ(mirrored.size(), 128u);
  const glm::vec3 expected = glm::normalize(glm::vec3(0.6f, 0, 1));
  for (size_t i = 0; i < mirrored.size(); i += 2)
    EXPECT_GT(glm::dot(glm::vec3(mirrored[i + 1]), expected), 0.999f);
  const Rays rough = glossy_rays(rays, hits, ready, ready.pose(0), 0.8f, 1);
  float least = 1;
  for (size_t i = 0; i < rough.size(); i += 2) {
    EXPECT_GT(rough[i + 1].z, 0);
    least = std::min(least, glm::dot(glm::vec3(rough[i + 1]), expected));
  }
  EXPECT_LT(least, 0.8f);
}

}  // namespace
}  // namespace lodestone::test
