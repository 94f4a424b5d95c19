// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>

#include "expect_error.h"
#include "lodestone/geometry_image/atlas.h"
#include "lodestone/geometry_image/charts.h"
#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

using test::add_grid;
using test::atlas_of;
using test::expect_error;
using test::height_field;
using test::mesh_of;
using test::scene_of;

// The vertex that a texel map entry picks; the test fails where it is not exactly one.
uint32_t picked_vertex(const scene::Assembly& assembly, const glm::uvec4& texel) {
  const float b1 = std::bit_cast<float>(texel.y), b2 = std::bit_cast<float>(texel.z);
  EXPECT_TRUE((b1 == 0 && b2 == 0) || (b1 == 1 && b2 == 0) || (b1 == 0 && b2 == 1)) << b1 << " " << b2;
  const glm::uvec4& triangle = assembly.triangles[texel.x];
  return b1 == 1 ? triangle.y : b2 == 1 ? triangle.z : triangle.x;
}

TEST(GridCharts, SampleExactlyTheVerticesOfTheirGrid) {
  scene::Mesh two = height_field(4, 3);
  std::vector<uint32_t> vertices;
  for (uint32_t i = 0; i < 10; ++i) {
    vertices.push_back(static_cast<uint32_t>(two.positions.size()));
    two.positions.emplace_back(float(i % 2), float(i), 9);
    two.normals.emplace_back(0, 0, 1);
  }
  add_grid(two, 2, 5, vertices);
  const scene::Scene scene = scene_of({height_field(2, 2), two});
  const scene::Assembly assembly = scene::assemble(scene);
  const Atlas atlas = build_atlas(scene, assembly, AtlasKind::grid);
  EXPECT_EQ(atlas.kind, AtlasKind::grid);
  ASSERT_EQ(atlas.charts.size(), 3u);
  uint32_t chart_index = 0, next_texel = 0;
  for (const scene::Placement& placement : assembly.placements) {
    for (const scene::Grid& grid : scene.meshes[placement.mesh].grids) {
      const layout::ChartRecord& chart = atlas.charts[chart_index++];
      EXPECT_EQ(chart.kind, layout::chart_grid);
      EXPECT_EQ(chart.first_texel, next_texel);
      EXPECT_EQ(chart.width, grid.width);
      EXPECT_EQ(chart.height, grid.height);
      EXPECT_EQ(chart.first_triangle, placement.first_triangle + grid.first_triangle);
      for (uint32_t i = 0; i < grid.vertices.size(); ++i) {
        const glm::uvec4& texel = atlas.texel_map[next_texel + i];
        EXPECT_EQ(texel.w, chart_index);
        EXPECT_EQ(picked_vertex(assembly, texel), placement.first_vertex + grid.vertices[i]);
      }
      next_texel += static_cast<uint32_t>(grid.vertices.size());
    }
  }
  EXPECT_EQ(atlas.texel_map.size(), next_texel);
}

// layout/atlas.h: quad (x, y) half h is triangle first_triangle + 2 * (y * (width - 1) + x) + h.
TEST(GridCharts, HaveQuadsWhoseHalvesAreTheInputsTriangles) {
  const scene::Scene scene = scene_of({height_field(7, 4), height_field(5, 6, {20, 0, 0})});
  const scene::Assembly assembly = scene::assemble(scene);
  const Atlas atlas = build_atlas(scene, assembly, AtlasKind::automatic);
  uint32_t found = 0;
  for (const glm::uvec2& leaf : atlas.leaf_map) {
    if (leaf.x == layout::empty_slot) continue;
    const uint32_t a = picked_vertex(assembly, atlas.texel_map[leaf.x]);
    const uint32_t b = picked_vertex(assembly, atlas.texel_map[leaf.x + 1]);
    const uint32_t c = picked_vertex(assembly, atlas.texel_map[leaf.x + leaf.y]);
    const uint32_t d = picked_vertex(assembly, atlas.texel_map[leaf.x + leaf.y + 1]);
    const layout::ChartRecord& chart = atlas.charts[atlas.texel_map[leaf.x].w - 1];
    const uint32_t x = (leaf.x - chart.first_texel) % chart.width,
                   y = (leaf.x - chart.first_texel) / chart.width;
    const uint32_t triangle = chart.first_triangle + 2 * (y * (chart.width - 1) + x);
    EXPECT_EQ(glm::uvec3(assembly.triangles[triangle]), glm::uvec3(a, b, c));
    EXPECT_EQ(glm::uvec3(assembly.triangles[triangle + 1]), glm::uvec3(d, c, b));
    ++found;
  }
  EXPECT_EQ(found, 6u * 3u + 4u * 5u);
}

TEST(GridCharts, ShareAnAtlasWithExactOnes) {
  constexpr uint32_t count = 256;
  const scene::Scene scene = scene_of({test::pages(count), height_field(9, 9), test::pages(count)});
  const Atlas atlas = atlas_of(scene);
  EXPECT_EQ(atlas.kind, AtlasKind::automatic);
  ASSERT_EQ(atlas.charts.size(), 2 * count + 1);
  uint32_t triangle = 0;
  for (uint32_t i = 0; i < atlas.charts.size(); ++i) {
    EXPECT_EQ(atlas.charts[i].kind, i == count ? layout::chart_grid : layout::chart_exact) << i;
    EXPECT_EQ(atlas.charts[i].first_triangle, triangle) << i;
    triangle += i == count ? 128 : 1;
  }
  EXPECT_EQ(atlas.charts[count].first_slot, 0u) << "the largest block comes first";
  EXPECT_EQ(atlas.report.quads, 64u + 2 * count * 3);
}

TEST(GridCharts, StayWhereOtherMeshesAreResampled) {
  const scene::Mesh triangles = mesh_of({{0, 0, 5}, {1, 0, 5}, {0, 1, 5}, {1, 1, 5}}, {{0, 1, 2}, {3, 2, 1}});
  const Atlas atlas = atlas_of(scene_of({triangles, height_field(9, 9), triangles}));
  EXPECT_EQ(atlas.kind, AtlasKind::automatic);
  ASSERT_EQ(atlas.charts.size(), 3u);
  EXPECT_EQ(atlas.charts[0].kind, layout::chart_grid);
  EXPECT_EQ(atlas.charts[0].first_triangle, 2u);
  for (uint32_t i : {1u, 2u}) EXPECT_EQ(atlas.charts[i].kind, layout::chart_mapped);
  EXPECT_EQ(atlas.report.mapped_triangles, 4u);
}

TEST(GridCharts, GiveWayToExactOnesOnRequest) {
  const Atlas atlas = atlas_of(height_field(3, 3), AtlasKind::exact);
  EXPECT_EQ(atlas.kind, AtlasKind::exact);
  EXPECT_EQ(atlas.charts.size(), 8u);
}

TEST(GridCharts, NeedMeshesOfGrids) {
  const scene::Scene scene =
      scene_of({height_field(3, 3), mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}})});
  expect_error([&] { atlas_of(scene, AtlasKind::grid); }, ExitCode::usage, "--atlas", "mesh 1 'sample'");
}

TEST(GridCharts, AreRefusedWhereTheyAreNotTheTrianglesOfTheMesh) {
  const auto refuse = [](const auto& damage, const std::string& because) {
    scene::Mesh mesh = height_field(4, 4);
    damage(mesh);
    expect_error([&] { atlas_of(mesh); }, ExitCode::bad_input, "test", because);
  };
  refuse([](scene::Mesh& m) { m.grids[0].width = 1; }, "at least 2 x 2");
  refuse([](scene::Mesh& m) { m.grids[0].vertices.pop_back(); }, "a vertex a sample");
  refuse([](scene::Mesh& m) { m.grids[0].first_triangle = 1; }, "not the triangles");
  refuse([](scene::Mesh& m) { std::swap(m.grids[0].vertices[3], m.grids[0].vertices[9]); },
         "not the triangles");
  refuse([](scene::Mesh& m) { m.grids.push_back(m.grids[0]); }, "not the triangles");
  refuse([](scene::Mesh& m) { m.triangles[17] = {0, 1, 2}; }, "not the triangles");
  refuse(
      [](scene::Mesh& m) {
        m.triangles.push_back({0, 1, 2});
        ++m.parts[0].triangle_count;
      },
      "its grids are 18 triangles, the mesh is 19");
}

TEST(GridCharts, KeepTrianglesWithoutAnArea) {
  scene::Mesh mesh = height_field(4, 3);
  for (uint32_t x = 0; x < 4; ++x) mesh.positions[x] = {1, 1, 1};  // a pole
  const Atlas atlas = atlas_of(mesh);
  EXPECT_EQ(atlas.report.quads, 6u);
  EXPECT_EQ(atlas.report.degenerate_triangles, 3u);
  ASSERT_FALSE(atlas.report.notes.empty());
}

TEST(GridCharts, AreRefusedBeforeTheirTexelsOutgrowTheImage) {
  const scene::Scene scene = scene_of({height_field(1024, 1024)});
  scene::Assembly assembly;
  assembly.placements.resize(2048);  // of 2^20 texels each
  const TriangleSurvey survey;
  expect_error([&] { make_charts(scene, assembly, survey, std::vector<bool>(2048, true)); },
               ExitCode::bad_input, "test", "2147483648 texels in 2048 charts");
  assembly.placements.pop_back();
  EXPECT_EQ(make_charts(scene, assembly, survey, std::vector<bool>(2047, true)).size(), 2047u);
}

}  // namespace
}  // namespace lodestone::geometry_image
