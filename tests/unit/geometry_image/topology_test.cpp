// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "brute_force.h"
#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

using test::add_grid;
using test::atlas_of;
using test::EdgeCounts;
using test::height_field;
using test::mesh_of;
using test::random_mesh;

void expect_edges(const scene::Mesh& mesh, const AtlasReport& report) {
  EdgeCounts edges;
  for (const glm::uvec3& t : mesh.triangles)
    edges.add(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
  EXPECT_EQ(report.boundary_edges, edges.boundary());
  EXPECT_EQ(report.non_manifold_edges, edges.non_manifold());
}

TEST(Topology, CountsOpenAndCrowdedEdgesOfRandomMeshes) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    scene::Mesh mesh = random_mesh(seed, 10 + seed, 40);
    // Duplicates would be dropped, and the brute force would count them.
    std::set<std::array<uint32_t, 3>> known;
    std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
      std::array<uint32_t, 3> corners = {t.x, t.y, t.z};
      std::sort(corners.begin(), corners.end());
      return !known.insert(corners).second;
    });
    mesh.parts[0].triangle_count = static_cast<uint32_t>(mesh.triangles.size());
    expect_edges(mesh, atlas_of(mesh).report);
  }
}

TEST(Topology, FindsAClosedSurfaceAcrossSeams) {
  // A tetrahedron whose faces share no vertex.
  const glm::vec3 p[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const scene::Mesh mesh = mesh_of({p[0], p[2], p[1], p[0], p[1], p[3], p[1], p[2], p[3], p[2], p[0], p[3]},
                                   {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}});
  const Atlas atlas = atlas_of(mesh);
  EXPECT_TRUE(atlas.report.closed());
  EXPECT_EQ(atlas.report.welded_vertices, 8u);
  EXPECT_TRUE(atlas.report.notes.empty());
}

TEST(Topology, CountsEachPlacementAlone) {
  scene::Scene scene = test::scene_of({mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}})});
  scene.nodes.push_back(scene.nodes[0]);
  const AtlasReport report = atlas_of(scene).report;
  EXPECT_EQ(report.boundary_edges, 6u);
  EXPECT_EQ(report.duplicate_triangles, 0u);
}

// Samples of a grid that are one vertex: a seam, a pole, a tube so thin that both neighbours of a sample are
// one.
TEST(Topology, CountsTheEdgesOfGridsThatMeetThemselves) {
  for (const uint32_t around : {2u, 3u, 4u, 9u}) {
    scene::Mesh tube = mesh_of({}, {});
    std::vector<uint32_t> vertices;
    for (uint32_t y = 0; y < 6; ++y) {
      for (uint32_t x = 0; x < around; ++x) {
        const float angle = 6.2831853f * float(x) / float(around - 1);
        const float radius = y == 0 || y == 5 ? 0 : 1;  // poles
        tube.positions.push_back(radius * glm::vec3(std::cos(angle), std::sin(angle), 0) +
                                 glm::vec3(0, 0, y));
        tube.normals.emplace_back(0, 0, 1);
        if (x + 1 == around) tube.positions.back() = tube.positions[size_t(y) * around];
        vertices.push_back(y * around + x);
      }
    }
    add_grid(tube, around, 6, vertices);
    const Atlas atlas = atlas_of(tube, AtlasKind::grid);
    expect_edges(tube, atlas.report);
    EXPECT_TRUE(around != 9 || atlas.report.closed());
  }
}

TEST(Topology, CountsTheEdgesOfGridsOfRandomVertices) {
  std::mt19937 random(7);
  for (const uint32_t different : {6u, 20u, 60u, 400u}) {
    scene::Mesh mesh = random_mesh(different, different, 0);
    for (const glm::uvec2 size : {glm::uvec2(2, 2), glm::uvec2(5, 4), glm::uvec2(7, 9), glm::uvec2(2, 12)}) {
      std::vector<uint32_t> vertices(size.x * size.y);
      for (uint32_t& v : vertices) v = static_cast<uint32_t>(random()) % different;
      add_grid(mesh, size.x, size.y, vertices);
    }
    expect_edges(mesh, atlas_of(mesh, AtlasKind::grid).report);
  }
}

TEST(Topology, SeesThatGridsShareTheirBorders) {
  // One height field as one grid, and as two that share the samples of column 4.
  const scene::Mesh whole = height_field(9, 7);
  scene::Mesh halves = whole;
  halves.grids.clear();
  halves.triangles.clear();
  for (uint32_t side = 0; side < 2; ++side) {
    std::vector<uint32_t> vertices;
    for (uint32_t y = 0; y < 7; ++y) {
      for (uint32_t x = 0; x < 5; ++x) vertices.push_back(y * 9 + 4 * side + x);
    }
    add_grid(halves, 5, 7, vertices);
  }
  EXPECT_EQ(atlas_of(whole).report.boundary_edges, 2u * (8 + 6));
  EXPECT_EQ(atlas_of(halves).report.boundary_edges, 2u * (8 + 6));
  EXPECT_EQ(atlas_of(halves).report.non_manifold_edges, 0u);
}

}  // namespace
}  // namespace lodestone::geometry_image
