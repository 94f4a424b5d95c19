// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>

#include "lodestone/geometry_image/atlas.h"
#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

using test::atlas_of;
using test::mesh_of;

glm::uvec4 texel(uint32_t triangle, float b1, float b2, uint32_t chart) {
  return {triangle, std::bit_cast<uint32_t>(b1), std::bit_cast<uint32_t>(b2), chart + 1};
}

TEST(ExactCharts, SampleCornersMidpointsAndCentroidOfATriangle) {
  const Atlas atlas = atlas_of(mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}), AtlasKind::exact);
  EXPECT_EQ(atlas.kind, AtlasKind::exact);
  EXPECT_EQ(atlas.objects[0].depth, 1u);
  ASSERT_EQ(atlas.charts.size(), 1u);
  const layout::ChartRecord& chart = atlas.charts[0];
  EXPECT_EQ(chart.first_texel, 0u);
  EXPECT_EQ(chart.width, 3u);
  EXPECT_EQ(chart.height, 3u);
  EXPECT_EQ(chart.kind, layout::chart_exact);
  EXPECT_EQ(chart.first_triangle, 0u);
  EXPECT_EQ(chart.first_slot, 0u);
  EXPECT_EQ(chart.slot_count, 4u);
  const std::vector<glm::uvec4> texels = {texel(0, 0, 0, 0),
                                          texel(0, 0.5f, 0, 0),
                                          texel(0, 1, 0, 0),
                                          texel(0, 0, 0.5f, 0),
                                          texel(0, 1 / 3.0f, 1 / 3.0f, 0),
                                          texel(0, 0.5f, 0.5f, 0),
                                          texel(0, 0, 1, 0),
                                          texel(0, 0.5f, 0.5f, 0),
                                          glm::uvec4(0)};
  EXPECT_EQ(atlas.texel_map, texels);
  const std::vector<glm::uvec2> leaves = {{0, 3}, {1, 3}, {3, 3}, {layout::empty_slot, 0}};
  EXPECT_EQ(atlas.leaf_map, leaves);
  EXPECT_EQ(atlas.report.triangles, 1u);
  EXPECT_EQ(atlas.report.quads, 3u);
  EXPECT_EQ(atlas.report.texels, 9u);
  EXPECT_EQ(atlas.report.slots, 4u);
  EXPECT_EQ(atlas.report.boundary_edges, 3u);
  EXPECT_FALSE(atlas.report.closed());
}

TEST(ExactCharts, KeepTheNumbersOfTheInputsTriangles) {
  // Triangles 1 and 3 have no area: charts 0, 1, 2 are triangles 0, 2, 4.
  const Atlas atlas = atlas_of(mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {5, 5, 5}},
                                       {{0, 1, 2}, {0, 0, 2}, {3, 2, 1}, {1, 2, 1}, {0, 3, 4}}),
                               AtlasKind::exact);
  ASSERT_EQ(atlas.charts.size(), 3u);
  for (uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(atlas.charts[i].first_triangle, 2 * i);
    EXPECT_EQ(atlas.charts[i].first_texel, 9 * i);
    EXPECT_EQ(atlas.texel_map[9 * i + 4], texel(2 * i, 1 / 3.0f, 1 / 3.0f, i));
  }
  EXPECT_EQ(atlas.report.triangles, 5u);
  EXPECT_EQ(atlas.objects[0].depth, 2u);
}

// Each small triangle of the quads' halves (a, b, c) and (d, c, b), in the triangle's own coordinates.
TEST(ExactCharts, CoverTheTriangleOnceAndKeepItsOrientation) {
  const Atlas atlas = atlas_of(mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}), AtlasKind::exact);
  double covered = 0;
  for (const glm::uvec2& leaf : atlas.leaf_map) {
    if (leaf.x == layout::empty_slot) continue;
    glm::dvec2 corner[4];
    for (uint32_t i = 0; i < 4; ++i) {
      const glm::uvec4& at = atlas.texel_map[leaf.x + i % 2 + i / 2 * leaf.y];
      ASSERT_NE(at.w, 0u);
      corner[i] = {std::bit_cast<float>(at.y), std::bit_cast<float>(at.z)};
    }
    const auto area = [](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
      return 0.5 * ((b - a).x * (c - a).y - (b - a).y * (c - a).x);
    };
    const double first = area(corner[0], corner[1], corner[2]),
                 second = area(corner[3], corner[2], corner[1]);
    EXPECT_GT(first, 0.04);
    EXPECT_GT(second, 0.04);
    covered += first + second;
  }
  EXPECT_NEAR(covered, 0.5, 1e-7);
}

}  // namespace
}  // namespace lodestone::geometry_image
