// SPDX-License-Identifier: MIT
// What the tree over charts and quads promises to the kernels.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "lodestone/geometry_image/atlas_check.h"
#include "lodestone/geometry_image/build.h"
#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

using test::atlas_of;
using test::height_field;
using test::random_mesh;
using test::scene_of;

// Charts of all kinds: triangles that are resampled, soup that is not, and grids of many shapes.
scene::Scene mixed_scene(uint32_t seed) {
  std::mt19937 random(seed);
  scene::Scene scene = scene_of({random_mesh(seed, 50, 200), test::pages(300)});
  for (uint32_t i = 0; i < 6; ++i) {
    const auto width = static_cast<uint32_t>(2 + random() % 40),
               height = static_cast<uint32_t>(2 + random() % 9);
    scene.meshes.push_back(height_field(width, height, {float(10 * i), 0, 5}));
    scene.nodes.emplace_back();
    scene.nodes.back().mesh = i + 2;
    scene.nodes.back().translation = {0, float(random() % 100), 0};
  }
  scene.nodes.push_back(scene.nodes[0]);
  return scene;
}

void expect_every_quad_once(const Atlas& atlas) {
  std::vector<uint32_t> found(atlas.texel_map.size(), 0);
  for (const layout::ChartRecord& chart : atlas.charts) {
    for (uint32_t s = 0; s < chart.slot_count; ++s) {
      const glm::uvec2& leaf = atlas.leaf_map[chart.first_slot + s];
      if (leaf.x == layout::empty_slot) {
        EXPECT_EQ(leaf.y, 0u);
        continue;
      }
      // In the block of its own chart, and a quad of it.
      ASSERT_GE(leaf.x, chart.first_texel);
      ASSERT_LT(leaf.x, chart.first_texel + chart.width * chart.height);
      EXPECT_EQ(leaf.y, chart.width);
      EXPECT_LT((leaf.x - chart.first_texel) % chart.width, chart.width - 1);
      EXPECT_LT((leaf.x - chart.first_texel) / chart.width, chart.height - 1);
      ++found[leaf.x];
    }
  }
  EXPECT_EQ(*std::max_element(found.begin(), found.end()), 1u);
  uint64_t quads = 0;
  for (const layout::ChartRecord& chart : atlas.charts) {
    quads += chart.kind == layout::chart_exact ? 3 : (chart.width - 1) * (chart.height - 1);
  }
  EXPECT_EQ(std::accumulate(found.begin(), found.end(), uint64_t(0)), quads);
  EXPECT_EQ(atlas.report.quads, quads);
}

void expect_charts_to_be_subtrees(const Atlas& atlas) {
  uint64_t covered = 0;
  for (const layout::ChartRecord& chart : atlas.charts) {
    EXPECT_TRUE(std::has_single_bit(chart.slot_count));
    EXPECT_EQ(chart.first_slot % chart.slot_count, 0u);
    covered += chart.slot_count;
  }
  EXPECT_EQ(covered, atlas.leaf_map.size());
  EXPECT_GE(uint64_t(1) << (2 * atlas.objects[0].depth), atlas.leaf_map.size());
  EXPECT_TRUE(atlas.objects[0].depth == 1 ||
              uint64_t(1) << (2 * atlas.objects[0].depth - 2) < atlas.leaf_map.size());
}

TEST(Hierarchy, HoldsEveryQuadOnceAndEveryChartInASubtree) {
  for (uint32_t seed = 1; seed <= 10; ++seed) {
    const scene::Scene scene = mixed_scene(seed);
    const scene::Assembly assembly = scene::assemble(scene);
    for (const AtlasKind kind : {AtlasKind::automatic, AtlasKind::exact, AtlasKind::charts}) {
      // Resampling takes seconds.
      if (kind != AtlasKind::exact && seed > 3) continue;
      for (const ChartOrder order : {ChartOrder::median, ChartOrder::hilbert}) {
        // Where some charts are resampled none are ordered (slots.h).
        if (kind != AtlasKind::exact && order != ChartOrder::median) continue;
        const Atlas atlas = build_atlas(scene, assembly, kind, order);
        expect_every_quad_once(atlas);
        expect_charts_to_be_subtrees(atlas);
        EXPECT_EQ(find_fault(atlas), "");
        std::set<uint32_t> kinds;
        for (const layout::ChartRecord& chart : atlas.charts) kinds.insert(chart.kind);
        EXPECT_EQ(kinds.size(), kind == AtlasKind::automatic ? 3u : kind == AtlasKind::exact ? 1u : 2u);
      }
    }
  }
}

TEST(Hierarchy, HoldsThinChartsWithLittleWaste) {
  for (const glm::uvec2 quads : {glm::uvec2(1000, 3), glm::uvec2(3, 1000)}) {
    const Atlas atlas = atlas_of(height_field(quads.x + 1, quads.y + 1));
    expect_every_quad_once(atlas);
    EXPECT_LT(atlas.leaf_map.size(), 3u * 3000u);
    EXPECT_EQ(atlas.leaf_map.size(), 4096u);
  }
}

TEST(Hierarchy, HoldsASingleQuad) {
  const Atlas atlas = atlas_of(height_field(2, 2));
  EXPECT_EQ(atlas.objects[0].depth, 1u);
  EXPECT_EQ(atlas.leaf_map, (std::vector<glm::uvec2>{{0, 2}}));
  expect_charts_to_be_subtrees(atlas);
}

// The order follows the surface in its rest pose, node transforms included.
TEST(Hierarchy, BringsNeighboursInTheWorldTogether) {
  const scene::Mesh triangle = test::mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  scene::Scene scene = scene_of({triangle});
  scene.nodes.resize(16, scene.nodes[0]);
  for (uint32_t i = 0; i < 16; ++i) scene.nodes[i].translation = {float(i % 4) * 100, float(i / 4), 0};
  const Atlas atlas = atlas_of(scene, AtlasKind::exact);
  for (uint32_t i = 0; i < 16; ++i) {
    for (uint32_t j = 0; j < 16; ++j) {
      const bool same_subtree = atlas.charts[i].first_slot / 16 == atlas.charts[j].first_slot / 16;
      EXPECT_EQ(same_subtree, i % 4 == j % 4) << i << " " << j;
    }
  }
}

}  // namespace
}  // namespace lodestone::geometry_image
