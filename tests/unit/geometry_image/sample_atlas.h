// SPDX-License-Identifier: MIT
// Small atlases for the tests of baked files.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "lodestone/geometry_image/charts.h"
#include "lodestone/geometry_image/notes.h"
#include "lodestone/geometry_image/slots.h"
#include "lodestone/geometry_image/weld.h"
#include "meshes.h"

namespace lodestone::geometry_image::test {

// A grid, and a square of which one triangle is dropped and edges are open.
inline scene::Scene sample_scene() {
  return scene_of({height_field(4, 3),
                   mesh_of({{0, 0, 5}, {1, 0, 5}, {0, 1, 5}, {1, 1, 5}}, {{0, 1, 2}, {3, 2, 1}, {0, 0, 3}})});
}

// Of that scene: a grid chart, two exact ones, and notes.
inline Atlas sample_atlas() {
  const scene::Scene scene = sample_scene();
  const scene::Assembly assembly = scene::assemble(scene);
  const std::vector<bool> as_grid = {true, false};
  const TriangleSurvey survey = survey_triangles(scene, assembly, weld(assembly), as_grid);
  Atlas atlas;
  report_survey(scene, assembly, survey, atlas.report);
  atlas.charts = make_charts(scene, assembly, survey, as_grid);
  atlas.kind = kind_of(atlas.charts);
  atlas.texel_map = make_texel_map(atlas.charts);
  const uint64_t slots =
      assign_slots(atlas.charts, std::vector<ChartBox>(atlas.charts.size()), ChartOrder::median, scene.name);
  atlas.objects.push_back(
      {tree_depth(slots), 0, static_cast<uint32_t>(slots), 0, static_cast<uint32_t>(atlas.texel_map.size())});
  atlas.leaf_map = make_leaf_map(atlas.charts, slots);
  atlas.report.quads = quad_count(atlas.charts[0]) + 2 * 3;
  atlas.report.texels = atlas.texel_map.size();
  atlas.report.slots = slots;
  return atlas;
}

inline void expect_equal(const Atlas& a, const Atlas& b) {
  EXPECT_EQ(a.kind, b.kind);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (size_t i = 0; i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i].depth, b.objects[i].depth);
    EXPECT_EQ(a.objects[i].first_slot, b.objects[i].first_slot);
    EXPECT_EQ(a.objects[i].slots, b.objects[i].slots);
    EXPECT_EQ(a.objects[i].first_texel, b.objects[i].first_texel);
    EXPECT_EQ(a.objects[i].texels, b.objects[i].texels);
  }
  ASSERT_EQ(a.charts.size(), b.charts.size());
  for (size_t i = 0; i < a.charts.size(); ++i) {
    const layout::ChartRecord &x = a.charts[i], &y = b.charts[i];
    EXPECT_TRUE(x.first_texel == y.first_texel && x.width == y.width && x.height == y.height &&
                x.kind == y.kind && x.first_triangle == y.first_triangle && x.first_slot == y.first_slot &&
                x.slot_count == y.slot_count && x.first_emitter == y.first_emitter)
        << i;
  }
  EXPECT_EQ(a.texel_map, b.texel_map);
  EXPECT_EQ(a.leaf_map, b.leaf_map);
  ASSERT_EQ(a.maps.sites.size(), b.maps.sites.size());
  for (size_t i = 0; i < a.maps.sites.size(); ++i) {
    EXPECT_EQ(a.maps.sites[i].at, b.maps.sites[i].at);
    EXPECT_EQ(a.maps.sites[i].face, b.maps.sites[i].face);
  }
  EXPECT_EQ(a.maps.points, b.maps.points);
  EXPECT_EQ(a.maps.faces.size(), b.maps.faces.size());
  EXPECT_EQ(a.maps.pieces.size(), b.maps.pieces.size());
  EXPECT_EQ(a.report.triangles, b.report.triangles);
  EXPECT_EQ(a.report.quads, b.report.quads);
  EXPECT_EQ(a.report.texels, b.report.texels);
  EXPECT_EQ(a.report.slots, b.report.slots);
  EXPECT_EQ(a.report.degenerate_triangles, b.report.degenerate_triangles);
  EXPECT_EQ(a.report.duplicate_triangles, b.report.duplicate_triangles);
  EXPECT_EQ(a.report.non_manifold_edges, b.report.non_manifold_edges);
  EXPECT_EQ(a.report.boundary_edges, b.report.boundary_edges);
  EXPECT_EQ(a.report.welded_vertices, b.report.welded_vertices);
  EXPECT_EQ(a.report.notes, b.report.notes);
}

// A folder of its own for every test, removed after it.
class FolderTest : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("lodestone-") + test->test_suite_name() +
                                                        "-" + test->name() + "-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace lodestone::geometry_image::test
