// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/atlas_objects.h"

#include <gtest/gtest.h>

#include "lodestone/geometry_image/atlas_check.h"
#include "lodestone/geometry_image/atlas_file.h"
#include "lodestone/geometry_image/fidelity.h"
#include "lodestone/scene/load.h"
#include "sample_atlas.h"

namespace lodestone::geometry_image {
namespace {

// A large and a small copy of the tiny scene's meshes, and one of its own.
struct Placed {
  scene::Scene scene = scene::make_builtin("teapots");
  scene::Assembly assembly = scene::assemble(scene, scene::Instancing::on);
};

TEST(AtlasObjects, HaveAnAtlasEachBehindOneAnother) {
  const Placed placed;
  ASSERT_EQ(placed.assembly.objects.size(), 6u) << "three teapots, two palms, the island with its sea";
  const Atlas atlas = build_atlas(placed.scene, placed.assembly, AtlasKind::automatic);
  EXPECT_EQ(find_fault(atlas), "");
  ASSERT_EQ(atlas.objects.size(), 6u);
  EXPECT_EQ(atlas.report.triangles, placed.assembly.triangles.size());
  for (size_t i = 0; i < 6; ++i) {
    const Atlas alone =
        build_atlas(placed.scene, assemble_object(placed.scene, placed.assembly, i), AtlasKind::automatic);
    const AtlasObject& object = atlas.objects[i];
    EXPECT_EQ(object.depth, alone.objects[0].depth);
    ASSERT_EQ(object.texels, alone.texel_map.size());
    ASSERT_EQ(object.slots, alone.leaf_map.size());
    const uint32_t first_triangle = placed.assembly.objects[i].first_triangle;
    for (uint32_t t = 0; t < object.texels; ++t) {
      const glm::uvec4 &texel = atlas.texel_map[object.first_texel + t], &own = alone.texel_map[t];
      ASSERT_EQ(texel.y, own.y);
      ASSERT_EQ(texel.z, own.z);
      ASSERT_EQ(texel.x, own.w == 0 ? own.x : own.x + first_triangle);
    }
    for (uint32_t slot = 0; slot < object.slots; ++slot) {
      const glm::uvec2 &leaf = atlas.leaf_map[object.first_slot + slot], &own = alone.leaf_map[slot];
      ASSERT_EQ(leaf.y, own.y);
      ASSERT_EQ(leaf.x, own.x == layout::empty_slot ? own.x : own.x + object.first_texel);
    }
  }
}

TEST(AtlasObjects, ComeBackFromAFileAndAreCheckedThere) {
  const Placed placed;
  const Atlas good = build_atlas(placed.scene, placed.assembly, AtlasKind::automatic);
  BakeRecord record;
  record.instancing = scene::Instancing::on;
  BakeRecord found;
  const Atlas back = unpack_atlas("x.lode", pack_atlas(good, record), &found);
  EXPECT_EQ(found.instancing, scene::Instancing::on);
  test::expect_equal(back, good);
  const auto fault = [&](const auto& change) {
    Atlas bad = good;
    change(bad);
    return find_fault(bad);
  };
  EXPECT_EQ(fault([](Atlas& a) { a.objects.pop_back(); }), "texels of no object");
  EXPECT_EQ(fault([](Atlas& a) { a.objects[1].first_texel += 1; }), "objects that do not follow one another");
  EXPECT_EQ(fault([](Atlas& a) { a.objects[1].first_slot -= 1; }), "objects that do not follow one another");
  EXPECT_EQ(fault([](Atlas& a) { a.objects[5].slots += 1; }), "objects beyond its end");
  EXPECT_EQ(fault([](Atlas& a) { a.objects[2].depth += 1; }), "a hierarchy of the wrong depth");
  EXPECT_NE(fault([](Atlas& a) {
              a.objects[1].texels -= 9;
              a.objects[2].first_texel -= 9;
              a.objects[2].texels += 9;
            }),
            "");
}

// Errors are told in parts of an object, not of the scene: a teapot keeps its shape beside an island.
TEST(AtlasObjects, AreResampledEachToItsOwnSize) {
  const Placed placed;
  const Atlas apart = build_atlas(placed.scene, placed.assembly, AtlasKind::charts);
  const scene::Assembly whole = scene::assemble(placed.scene);
  const Atlas together = build_atlas(placed.scene, whole, AtlasKind::charts);
  const auto texels_of_first = [](const scene::Assembly& assembly, const Atlas& atlas) {
    const uint32_t end =
        assembly.objects.size() > 1 ? assembly.objects[0].triangles : assembly.placements[1].first_triangle;
    uint64_t count = 0;
    for (const glm::uvec4& texel : atlas.texel_map) count += texel.w != 0 && texel.x < end ? 1 : 0;
    return count;
  };
  EXPECT_GT(texels_of_first(placed.assembly, apart), 4 * texels_of_first(whole, together));
}

TEST(AtlasObjects, ShareABudgetByTheAreaOfTheirLargestInstance) {
  scene::Scene scene = scene::make_builtin("teapots");
  const scene::Assembly assembly = scene::assemble(scene, scene::Instancing::on);
  const std::vector<double> before = object_areas(scene, assembly);
  for (scene::Node& node : scene.nodes)
    if (node.mesh == 0) node.scale = glm::vec3(3);
  const std::vector<double> after = object_areas(scene, assembly);
  EXPECT_NEAR(after[0], 9 * before[0], 1e-3 * before[0]);
  EXPECT_EQ(after[1], before[1]);
  AtlasSettings settings(AtlasKind::charts);
  settings.charts.texel_budget = 60000;
  const Atlas atlas = build_atlas(scene, assembly, settings);
  EXPECT_LT(atlas.report.texels, 1.5 * 60000);
}

}  // namespace
}  // namespace lodestone::geometry_image
