// SPDX-License-Identifier: MIT
// Hit or miss, and the distance, against Embree in robust mode on the very triangles of the geometry image.
#include "lodestone/test_support/embree_scene.h"

#include <gtest/gtest.h>

#include <bit>

#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

void expect_agreement(const ReadyScene& ready, float time, uint32_t count) {
  const auto texels = ready.texels(ready.pose(time));
  const QuadTriangles quads = quad_triangles(ready.atlas);
  glm::vec3 lo(1e30f), hi(-1e30f);
  for (const glm::uvec3& t : quads.texels) {
    lo = glm::min(lo, texels[t.x]);
    hi = glm::max(hi, texels[t.x]);
  }
  const float size = glm::length(hi - lo);
  const Rays rays = random_rays(lo, hi, count, 7);
  const EmbreeScene embree(texels, quads.texels, true);
  std::vector<EmbreeHit> expected;
  embree.intersect(rays, expected);

  const auto backend = open("cpu");
  render::Settings settings;
  settings.width = settings.height = 8;
  render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
  renderer.update(ready.pose(time));
  renderer.load_rays(rays);
  renderer.trace_loaded();
  const auto hits = renderer.hits();

  uint64_t wrong = 0, hit_count = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const bool hit = hits[i].w != layout::no_index, hit_there = expected[i].triangle != ~0u;
    hit_count += hit ? 1 : 0;
    const float t = std::bit_cast<float>(hits[i].x);
    const bool same = hit == hit_there && (!hit || std::abs(t - expected[i].t) <= 1e-5f * size);
    wrong += same ? 0 : 1;
  }
  EXPECT_GT(hit_count, count / 20);
  EXPECT_LE(static_cast<double>(wrong), 1e-5 * count) << "of " << count << " rays";
}

TEST(Embree, AgreesOnABumpySphere) {
  expect_agreement(ReadyScene(grid_sphere(256)), 0, 400000);
}
TEST(Embree, AgreesOnTheHead) {
  expect_agreement(ReadyScene("builtin:head"), 0.7f, 400000);
}
TEST(Embree, AgreesOnTerrain) {
  expect_agreement(ReadyScene("builtin:terrain"), 0.2f, 400000);
}
TEST(Embree, AgreesOnAnExactAtlas) {
  const auto file = data_file("armadillo.obj");
  if (!file) GTEST_SKIP() << "shared data are absent";
  expect_agreement(ReadyScene(*file, geometry_image::AtlasKind::exact), 0, 400000);
}
TEST(Embree, AgreesOnResampledSpheres) {
  expect_agreement(ReadyScene("builtin:spheres", geometry_image::AtlasKind::charts), 0.6f, 400000);
}
TEST(Embree, AgreesOnTheResampledArmadillo) {
  const auto file = data_file("armadillo.obj");
  if (!file) GTEST_SKIP() << "shared data are absent";
  expect_agreement(ReadyScene(*file, geometry_image::AtlasKind::charts), 0, 400000);
}

}  // namespace
}  // namespace lodestone::test
