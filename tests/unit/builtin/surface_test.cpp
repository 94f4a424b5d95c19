// SPDX-License-Identifier: MIT
// The grids that built-in scenes are made of.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "lodestone/scene/builtin/surface.h"
#include "mesh_probe.h"

namespace lodestone::scene::builtin {
namespace {

TEST(Snap, RoundsToMultiplesOfTwoToTheMinusTwenty) {
  const float step = 1.0f / 1048576;
  EXPECT_EQ(snap(0.4f * step), 0);
  EXPECT_EQ(snap(0.6f * step), step);
  EXPECT_EQ(snap(-1.6f * step), -2 * step);
  EXPECT_EQ(snap(1.5f), 1.5f);
}

TEST(BoxLattice, NumbersOnlyTheSurface) {
  const BoxLattice lattice({4, 3, 5}, 10);
  EXPECT_EQ(lattice.points().size(), size_t(5 * 4 * 6 - 3 * 2 * 4));
  for (size_t k = 0; k < lattice.points().size(); ++k) EXPECT_EQ(lattice.vertex(lattice.points()[k]), 10 + k);
}

Mesh box(glm::ivec3 cells) {
  const BoxLattice lattice(cells);
  Mesh mesh;
  for (const glm::ivec3& point : lattice.points()) mesh.positions.emplace_back(point);
  for (const BoxLattice::Face face : BoxLattice::faces) add_grid(mesh, lattice.chart(face));
  return mesh;
}

TEST(BoxLattice, ChartsCloseTheBoxFacingOutwards) {
  const Mesh mesh = box({4, 3, 5});
  EXPECT_EQ(mesh.triangles.size(), size_t(2 * 2 * (12 + 20 + 15)));
  EXPECT_EQ(test::open_edges(mesh), 0u);
  EXPECT_NEAR(test::volume(mesh, mesh.positions), 60, 1e-4);
}

TEST(BoxLattice, PieceOfAFaceIsTheFaceCutOut) {
  const BoxLattice lattice({6, 5, 2});
  const Grid whole = lattice.chart(BoxLattice::Face::front);
  const Grid piece = lattice.chart(BoxLattice::Face::front, {2, 1}, {5, 3});
  ASSERT_EQ(piece.width, 4u);
  ASSERT_EQ(piece.height, 3u);
  for (uint32_t y = 0; y < 3; ++y)
    for (uint32_t x = 0; x < 4; ++x)
      EXPECT_EQ(piece.vertices[y * 4 + x], whole.vertices[(y + 1) * 7 + x + 2]);
}

TEST(CubeSphere, SpreadsUnitDirections) {
  const BoxLattice lattice(glm::ivec3(8));
  std::set<std::array<float, 3>> distinct;
  for (const glm::ivec3& point : lattice.points()) {
    const glm::vec3 d = cube_sphere_direction(lattice, point);
    EXPECT_NEAR(glm::length(d), 1, 1e-6);
    distinct.insert({d.x, d.y, d.z});
  }
  EXPECT_EQ(distinct.size(), lattice.points().size());
}

TEST(ZippedTube, IsClosedWithoutDegenerateTriangles) {
  const ZippedTube tube(8, 5);
  EXPECT_EQ(tube.samples().size(), size_t(3 * 8 + 2 * 5));
  Mesh mesh;
  for (const ZippedTube::Sample& sample : tube.samples()) {
    const float angle = 6.2831853f * float(sample.column) / 8;
    const bool zipped = sample.row == 0 || sample.row == 4;
    mesh.positions.emplace_back(std::cos(angle), zipped ? 0 : std::sin(angle), sample.row);
  }
  add_grid(mesh, tube.chart());
  EXPECT_EQ(test::open_edges(mesh), 0u);
  EXPECT_GT(test::volume(mesh, mesh.positions), 6);
  for (const glm::uvec3& t : mesh.triangles) {
    EXPECT_NE(t.x, t.y);
    EXPECT_NE(t.y, t.z);
    EXPECT_NE(t.z, t.x);
  }
}

TEST(MorphTargets, HoldOnlyVerticesThatMoveOrTurn) {
  Mesh mesh = box({4, 3, 5});
  mesh.normals = snapped_normals(mesh, mesh.positions);
  std::vector<glm::vec3> posed = mesh.positions;
  posed[0] += glm::vec3(-0.5f, 0, 0);
  const MorphTarget target = morph_target(mesh, "corner", posed);
  ASSERT_FALSE(target.vertices.empty());
  EXPECT_EQ(target.vertices[0], 0u);
  EXPECT_EQ(target.positions[0], glm::vec3(-0.5f, 0, 0));
  EXPECT_LT(target.vertices.size(), 12u);
  EXPECT_EQ(test::posed_positions(mesh, target), posed);
  EXPECT_EQ(test::posed_normals(mesh, target), snapped_normals(mesh, posed));
}

TEST(MorphTargets, ThatMoveNothingAreNotAdded) {
  Mesh mesh = box({2, 2, 2});
  mesh.normals = snapped_normals(mesh, mesh.positions);
  add_target(mesh, morph_target(mesh, "nothing", mesh.positions));
  EXPECT_TRUE(mesh.targets.empty());
  EXPECT_TRUE(mesh.weights.empty());
}

}  // namespace
}  // namespace lodestone::scene::builtin
