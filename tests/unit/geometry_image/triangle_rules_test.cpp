// SPDX-License-Identifier: MIT
// Which of the input's bad triangles are drawn, and what is said about the others.
#include <gtest/gtest.h>

#include <algorithm>

#include "expect_error.h"
#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

using test::expect_error;
using test::mesh_of;

// With a chart for every triangle that is drawn.
template <class Input>
Atlas atlas_of(Input input) {
  return test::atlas_of(std::move(input), AtlasKind::exact);
}

std::vector<uint32_t> drawn(const Atlas& atlas) {
  std::vector<uint32_t> triangles;
  for (const layout::ChartRecord& chart : atlas.charts) triangles.push_back(chart.first_triangle);
  return triangles;
}

using Triangles = std::vector<uint32_t>;

bool notes(const Atlas& atlas, const std::string& text) {
  return std::any_of(atlas.report.notes.begin(), atlas.report.notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

// A good triangle (0, 1, 2); 3 is at 0, and 4 in the middle of 0 and 1.
const std::vector<glm::vec3> points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 0}, {1, 0, 0}};

TEST(TriangleRules, DropTrianglesWithTwoCornersAtOnePoint) {
  const Atlas atlas = atlas_of(mesh_of(points, {{0, 0, 1}, {0, 1, 2}, {0, 3, 2}, {1, 0, 3}}));
  EXPECT_EQ(drawn(atlas), Triangles{1});
  EXPECT_EQ(atlas.report.degenerate_triangles, 3u);
  EXPECT_EQ(atlas.report.triangles, 4u);
  EXPECT_TRUE(notes(atlas,
                    "3 triangles with two corners at one point: not drawn; the first is triangle 0 of mesh 0 "
                    "'sample'."));
}

TEST(TriangleRules, DropTrianglesThatAreALineInEveryPose) {
  scene::Mesh mesh = mesh_of(points, {{0, 1, 2}, {0, 1, 4}});
  EXPECT_EQ(drawn(atlas_of(mesh)), Triangles{0});
  EXPECT_TRUE(
      notes(atlas_of(mesh), "1 triangle without an area in any pose: not drawn; the first is triangle 1"));
  // A target that moves all three corners alike does not open it.
  mesh.targets.push_back({"a", {0, 1, 2, 4}, {{0, 1, 1}, {0, 1, 1}, {5, 5, 5}, {0, 1, 1}}, {}, {}});
  mesh.weights = {0};
  EXPECT_EQ(drawn(atlas_of(mesh)), Triangles{0});
  EXPECT_EQ(atlas_of(mesh).report.boundary_edges, 3u) << "its edges are not counted";
}

TEST(TriangleRules, KeepTrianglesThatAMorphTargetCanOpen) {
  scene::Mesh mesh = mesh_of(points, {{0, 1, 4}, {0, 3, 1}});
  mesh.targets.push_back({"a", {3, 4}, {{0, 1, 0}, {0, 0, 1}}, {}, {}});
  mesh.weights = {0};
  const Atlas atlas = atlas_of(mesh);
  EXPECT_EQ(drawn(atlas), (Triangles{0, 1}));
  EXPECT_EQ(atlas.report.degenerate_triangles, 2u);
  EXPECT_TRUE(notes(atlas, "2 triangles without an area in the rest pose: kept"));
}

TEST(TriangleRules, KeepTrianglesThatAJointCanOpen) {
  scene::Mesh mesh = mesh_of(points, {{0, 1, 4}, {0, 3, 1}, {0, 1, 2}});
  mesh.first_influence = {0, 1, 2, 3, 4, 5};
  mesh.influences = {{0, 1}, {0, 1}, {0, 1}, {0, 1}, {1, 1}};
  scene::Scene scene = test::scene_of({mesh});
  scene.nodes.resize(3);
  scene.skins.push_back({"skin", {1, 2}, {glm::mat4(1), glm::mat4(1)}});
  scene.nodes[0].skin = 0;
  EXPECT_EQ(drawn(atlas_of(scene)), (Triangles{0, 2})) << "only 4 follows another joint";
}

// A tetrahedron one of whose edges, 0-1, is split at 4 for one neighbour and not for the other; the flat
// triangle (1, 0, 4) between them is the only thing that keeps it closed.
TEST(TriangleRules, KeepFlatTrianglesThatSealAGap) {
  std::vector<glm::vec3> corners = points;
  corners[3] = {0, 0, 2};
  const Atlas sealed =
      atlas_of(mesh_of(corners, {{0, 2, 1}, {1, 2, 3}, {2, 0, 3}, {0, 4, 3}, {4, 1, 3}, {0, 1, 4}}));
  EXPECT_EQ(drawn(sealed), (Triangles{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(sealed.report.degenerate_triangles, 1u);
  EXPECT_TRUE(sealed.report.closed());
  const Atlas open = atlas_of(mesh_of(corners, {{0, 2, 1}, {1, 2, 3}, {2, 0, 3}, {0, 4, 3}, {0, 1, 4}}));
  EXPECT_EQ(drawn(open), (Triangles{0, 1, 2, 3})) << "4-1 is open whether it is there or not";
}

TEST(TriangleRules, DropTheSecondOfTwoEqualTriangles) {
  const Atlas atlas = atlas_of(mesh_of(points, {{2, 4, 1}, {0, 1, 2}, {1, 2, 0}, {4, 1, 2}, {2, 3, 1}}));
  EXPECT_EQ(drawn(atlas), (Triangles{0, 1}));
  EXPECT_EQ(atlas.report.duplicate_triangles, 3u);
  EXPECT_EQ(atlas.report.degenerate_triangles, 0u);
  EXPECT_TRUE(notes(atlas, "3 triangles given a second time: not drawn again; the first is triangle 2"));
}

TEST(TriangleRules, KeepTheBackOfATriangle) {
  const Atlas atlas = atlas_of(mesh_of(points, {{0, 1, 2}, {0, 2, 1}}));
  EXPECT_EQ(drawn(atlas), (Triangles{0, 1}));
  EXPECT_EQ(atlas.report.duplicate_triangles, 0u);
  EXPECT_TRUE(atlas.report.closed());
}

TEST(TriangleRules, KeepAndCountCrowdedEdges) {
  const Atlas atlas = atlas_of(mesh_of(points, {{0, 1, 2}, {1, 0, 2}, {4, 1, 2}, {2, 1, 4}, {4, 2, 0}}));
  EXPECT_EQ(drawn(atlas).size(), 5u);
  EXPECT_EQ(atlas.report.non_manifold_edges, 3u);  // 1-2 of four triangles, 2-4 and 0-2 of three
  EXPECT_TRUE(notes(atlas, "3 edges have more than two triangles"));
}

TEST(TriangleRules, CountFromTheFrontOfTheTrianglesOwnMesh) {
  scene::Mesh mesh = mesh_of(points, {{0, 1, 2}, {0, 0, 1}});
  mesh.parts = {{0, 1, scene::none}, {1, 1, scene::none}};
  EXPECT_TRUE(
      notes(atlas_of(test::scene_of({mesh_of(points, {{0, 1, 2}}), mesh})), "triangle 1 of mesh 1 'sample'"));
  mesh.name = "bad\x1b[2J";
  EXPECT_TRUE(notes(atlas_of(mesh), "mesh 0 'bad?[2J'")) << "names must not steer terminals";
}

TEST(TriangleRules, RefuseASceneOfWhichNothingIsLeft) {
  expect_error(
      [] {
        atlas_of(mesh_of(points, {{0, 1, 4}, {0, 3, 2}}));
      },
      ExitCode::bad_input, "test", "none of its 2 triangles has an area");
}

}  // namespace
}  // namespace lodestone::geometry_image
