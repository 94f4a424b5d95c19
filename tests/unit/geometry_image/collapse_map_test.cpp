// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/collapse_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "lodestone/scene/load.h"
#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

using test::height_field;
using test::scene_of;

struct Made {
  scene::Scene scene;
  scene::Assembly assembly;
  Atlas atlas;
  CollapseMap map;

  explicit Made(scene::Scene made, const AtlasSettings& settings = {})
      : scene(std::move(made)),
        assembly(scene::assemble(scene)),
        atlas(build_atlas(scene, assembly, settings)),
        map(make_collapse_map(assembly, atlas)) {}
};

std::vector<uint32_t> corners(const CoarseNode& node) {
  return {node.texel, node.texel + node.across, node.texel + node.along,
          node.texel + node.across + node.along};
}

std::vector<uint32_t> between(const CoarseNode& node) {
  std::vector<uint32_t> texels;
  if (node.half_across != 0) {
    texels.push_back(node.texel + node.half_across);
    texels.push_back(node.texel + node.along + node.half_across);
  }
  if (node.half_along != 0) {
    texels.push_back(node.texel + node.half_along);
    texels.push_back(node.texel + node.across + node.half_along);
  }
  if (node.half_across != 0 && node.half_along != 0)
    texels.push_back(node.texel + node.half_across + node.half_along);
  return texels;
}

size_t whole_nodes(const CollapseMap& map, uint32_t level) {
  return static_cast<size_t>(std::count_if(map.nodes.begin(), map.nodes.end(), [&](const CoarseNode& node) {
    return node.level == level && node.whole;
  }));
}

TEST(CollapseMap, HalvesASquareAgainAndAgain) {
  const Made made(scene_of({height_field(9, 9)}));
  EXPECT_EQ(whole_nodes(made.map, 1), 16u);
  EXPECT_EQ(whole_nodes(made.map, 2), 4u);
  EXPECT_EQ(whole_nodes(made.map, 3), 1u);
  ASSERT_EQ(made.map.levels, (std::vector<uint32_t>{16, 20, 21}));
  const uint32_t stride = 9;
  // Inner texels go up in x and down in y; those of the border stay on it; the corners stay.
  EXPECT_EQ(made.map.parents[3 * stride + 3], 2 * stride + 4);
  EXPECT_EQ(made.map.parents[2 * stride + 6], 0 * stride + 8);
  EXPECT_EQ(made.map.parents[4 * stride + 4], 0 * stride + 8);
  EXPECT_EQ(made.map.parents[5], 4u);
  EXPECT_EQ(made.map.parents[4], 0u);
  for (uint32_t corner : {0u, 8u, 72u, 80u}) EXPECT_EQ(made.map.parents[corner], corner);
}

TEST(CollapseMap, KeepsWhatIsNoMultipleOfTwo) {
  const Made made(scene_of({height_field(6, 4)}));
  EXPECT_EQ(whole_nodes(made.map, 1), 6u);
  EXPECT_EQ(whole_nodes(made.map, 2), 2u);
  for (const CoarseNode& node : made.map.nodes) {
    EXPECT_GT(node.across, 0u);
    EXPECT_LE(node.texel % 6 + node.across, 5u);
    EXPECT_LE(node.texel / 6 + node.along / 6, 3u);
  }
}

// What layout/detail.h relies on.
void expect_consistent(const Made& made) {
  const CollapseMap& map = made.map;
  const auto texels = static_cast<uint32_t>(made.atlas.texel_map.size());
  ASSERT_EQ(map.points.size(), texels);
  ASSERT_EQ(map.parents.size(), texels);
  for (uint32_t i = 0; i < texels; ++i) {
    EXPECT_LE(map.points[i], i);
    EXPECT_EQ(map.points[map.points[i]], map.points[i]);
    // All texels of a point go to one point.
    EXPECT_EQ(map.points[map.parents[i]], map.points[map.parents[map.points[i]]]) << i;
    uint32_t end = i;
    for (int steps = 0; map.parents[end] != end; ++steps) {
      ASSERT_LT(steps, 32) << i;
      end = map.parents[end];
    }
  }
  // What is between the corners of a node goes to one of these, or stays.
  for (const CoarseNode& node : map.nodes) {
    for (uint32_t texel : between(node)) {
      const uint32_t parent = map.parents[texel];
      bool to_corner = false;
      for (uint32_t corner : corners(node)) to_corner |= map.points[corner] == map.points[parent];
      EXPECT_TRUE(parent == texel || to_corner);
      EXPECT_TRUE(parent != texel || !node.whole);
    }
  }
  // Corners of nodes of a step are between those of none in the same step or before it.
  std::set<uint32_t> known;
  uint32_t begin = 0;
  for (uint32_t end : map.steps) {
    for (uint32_t i = begin; i < end; ++i)
      for (uint32_t texel : between(map.nodes[map.order[i]])) known.insert(map.points[texel]);
    for (uint32_t i = begin; i < end; ++i) {
      const CoarseNode& node = map.nodes[map.order[i]];
      if (!node.whole) continue;
      for (uint32_t texel : corners(node)) EXPECT_FALSE(known.contains(map.points[texel]));
    }
    begin = end;
  }
  EXPECT_EQ(map.order.size(), map.nodes.size());
  EXPECT_EQ(map.steps.empty() ? 0u : map.steps.back(), map.nodes.size());
}

TEST(CollapseMap, IsWhatTracersRelyOnForChartsOfAllKinds) {
  for (const char* name : {"builtin:spheres", "builtin:terrain", "builtin:head", "builtin:teapots"}) {
    SCOPED_TRACE(name);
    expect_consistent(Made(scene::load(name)));
  }
  for (const AtlasKind kind : {AtlasKind::charts, AtlasKind::exact}) {
    SCOPED_TRACE(static_cast<uint32_t>(kind));
    expect_consistent(Made(scene::load("builtin:spheres"), kind));
  }
}

TEST(CollapseMap, LeavesExactChartsAlone) {
  const Made made(scene_of({height_field(5, 5)}), AtlasKind::exact);
  EXPECT_TRUE(made.map.nodes.empty());
  for (uint32_t i = 0; i < made.map.parents.size(); ++i) EXPECT_EQ(made.map.parents[i], i);
}

// Two sheets that touch along a line: one point there where they are one mesh, two where one of them could
// move away.
TEST(CollapseMap, TakesForOnePointWhatStaysOneInEveryPose) {
  scene::Mesh left = height_field(5, 5), right = height_field(5, 5);
  for (glm::vec3& p : right.positions) p.x += 4;
  const auto border_points = [](const Made& made) {
    uint32_t shared = 0;
    for (uint32_t i = 0; i < made.map.points.size(); ++i) shared += made.map.points[i] != i ? 1 : 0;
    return shared;
  };
  for (glm::vec3& p : left.positions) p.z = p.x == 4 ? 0 : p.z;
  for (glm::vec3& p : right.positions) p.z = p.x == 4 ? 0 : p.z;
  EXPECT_EQ(border_points(Made(scene_of({left, right}))), 0u);  // each has a node of its own
  scene::Mesh both = left;
  const auto first = static_cast<uint32_t>(both.positions.size());
  both.positions.insert(both.positions.end(), right.positions.begin(), right.positions.end());
  both.normals.insert(both.normals.end(), right.normals.begin(), right.normals.end());
  std::vector<uint32_t> vertices(right.positions.size());
  for (uint32_t i = 0; i < vertices.size(); ++i) vertices[i] = first + i;
  test::add_grid(both, 5, 5, vertices);
  EXPECT_EQ(border_points(Made(scene_of({both}))), 5u);
}

}  // namespace
}  // namespace lodestone::geometry_image
