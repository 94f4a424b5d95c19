// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/cells.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lodestone/base/parallel.h"
#include "surfaces.h"

namespace lodestone::base_complex {
namespace {

std::vector<CellOptions> all_options() {
  std::vector<CellOptions> all(4);
  all[0].cells = 1;
  all[1].cells = 8;
  all[2].cells = 100000;
  all[3].cells = 20;
  all[3].normal_weight = 0;
  all[3].relaxations = 0;
  return all;
}

Cells cells_of(HalfEdgeMesh mesh, const CellOptions& options) {
  return grow_cells(mesh, options);
}

void expect_disc(const HalfEdgeMesh& mesh, const Cells& cells, const std::vector<uint32_t>& faces) {
  const uint32_t cell = cells.of_face[faces.front()];
  // All faces are reached from the first without leaving the cell or crossing a barrier.
  std::set<uint32_t> reached = {faces.front()};
  std::vector<uint32_t> stack = {faces.front()};
  std::map<uint32_t, uint32_t> border;  // from each point the next one
  std::set<uint32_t> points;
  std::set<std::pair<uint32_t, uint32_t>> edges;
  while (!stack.empty()) {
    const uint32_t face = stack.back();
    stack.pop_back();
    for (uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
      points.insert(mesh.from(h));
      edges.insert(std::minmax({mesh.from(h), mesh.to(h)}));
      const uint32_t twin = mesh.twin(h);
      if (twin == none || cells.of_face[face_of(twin)] != cell) {
        EXPECT_TRUE(border.emplace(mesh.from(h), mesh.to(h)).second) << "a boundary comes to a point twice";
        continue;
      }
      EXPECT_FALSE(mesh.is_barrier(h)) << "a barrier is inside";
      if (!mesh.is_barrier(h) && reached.insert(face_of(twin)).second) stack.push_back(face_of(twin));
    }
  }
  EXPECT_EQ(reached.size(), faces.size());
  EXPECT_EQ(int64_t(points.size()) - int64_t(edges.size()) + int64_t(faces.size()), 1);
  ASSERT_FALSE(border.empty());
  size_t walked = 0;
  uint32_t at = border.begin()->first;
  do {
    ASSERT_TRUE(border.count(at));
    at = border[at];
    ++walked;
  } while (at != border.begin()->first && walked <= border.size());
  EXPECT_EQ(walked, border.size()) << "more than one boundary";
}

void expect_discs(const HalfEdgeMesh& mesh, const Cells& cells) {
  ASSERT_EQ(cells.of_face.size(), mesh.faces());
  for (const uint32_t cell : cells.of_face) ASSERT_LT(cell, cells.count);
  for (const std::vector<uint32_t>& faces : faces_by_cell(cells)) {
    ASSERT_FALSE(faces.empty()) << "a cell without a face";
    expect_disc(mesh, cells, faces);
  }
}

TEST(Cells, AreDiscsWhateverTheSurface) {
  for (const test::Sample& sample : test::all_samples()) {
    for (const CellOptions& options : all_options()) {
      SCOPED_TRACE(sample.name + ", " + std::to_string(options.cells));
      HalfEdgeMesh mesh = sample.mesh;
      const Cells cells = grow_cells(mesh, options);
      expect_discs(mesh, cells);
      if (HasFailure()) return;
    }
  }
}

TEST(Cells, AreAsManyAsTheShapeDemands) {
  CellOptions one;
  one.cells = 1;
  one.normal_weight = 0;
  EXPECT_EQ(cells_of(test::single_triangle().mesh(), one).count, 1u);
  EXPECT_EQ(cells_of(test::plane(4, 4).mesh(), one).count, 1u);
  EXPECT_GE(cells_of(test::sphere(8).mesh(), one).count, 2u);
  EXPECT_GE(cells_of(test::annulus(12, 2).mesh(), one).count, 2u);
  EXPECT_EQ(cells_of(test::sheets(5).mesh(), one).count, 5u);
  EXPECT_EQ(cells_of(test::many_components(10).mesh(), one).count >= 10, true);
}

TEST(Cells, AreAboutAsManyAsAskedFor) {
  for (const uint32_t asked : {16u, 64u, 200u}) {
    CellOptions options;
    options.cells = asked;
    const uint32_t found = cells_of(test::plane(60, 60).mesh(), options).count;
    EXPECT_GT(2 * found, asked);
    EXPECT_LT(found, 2 * asked);
  }
}

TEST(Cells, OfAPieceOfFewTrianglesIsOneHoweverLong) {
  HalfEdgeMesh strip = test::plane(45, 1).mesh(), long_strip = test::plane(200, 1).mesh();
  CellOptions options;
  options.cells = 30;
  EXPECT_EQ(grow_cells(strip, options).count, 1u);
  EXPECT_GT(grow_cells(long_strip, options).count, 10u);
}

TEST(Cells, AreSmallerWhereASurfaceTurns) {
  CellOptions options, flat;
  options.cells = flat.cells = 30;
  options.normal_weight = 8;
  flat.normal_weight = 0;
  const HalfEdgeMesh mesh = test::sphere(30).mesh();
  EXPECT_GT(cells_of(mesh, options).count, cells_of(mesh, flat).count);
}

TEST(Cells, AreTheSameEveryTimeOnAnyNumberOfThreads) {
  for (const test::Sample& sample : test::all_samples()) {
    std::vector<uint32_t> expected;
    for (const uint32_t threads : {1u, 2u, 7u, 0u, 1u}) {
      set_thread_count(threads);
      CellOptions options;
      options.cells = 12;
      const std::vector<uint32_t> found = cells_of(sample.mesh, options).of_face;
      if (expected.empty()) expected = found;
      EXPECT_EQ(found, expected) << sample.name << " on " << threads;
    }
  }
  set_thread_count(0);
}

// Several tasks' worth of faces.
TEST(Cells, OfALargeSurfaceAreTheSameOnAnyNumberOfThreads) {
  const HalfEdgeMesh mesh = test::torus(160, 100).mesh();
  std::vector<uint32_t> expected;
  for (const uint32_t threads : {1u, 7u}) {
    set_thread_count(threads);
    const std::vector<uint32_t> found = cells_of(mesh, {}).of_face;
    if (expected.empty()) expected = found;
    EXPECT_EQ(found, expected);
  }
  set_thread_count(0);
}

TEST(Cells, BecomeDiscsFromAnyStart) {
  for (const test::Sample& sample : test::all_samples()) {
    // Everything that is connected without crossing a barrier is one cell.
    Cells cells;
    cells.of_face.assign(sample.mesh.faces(), none);
    for (uint32_t start = 0; start < sample.mesh.faces(); ++start) {
      if (cells.of_face[start] != none) continue;
      std::vector<uint32_t> stack = {start};
      cells.of_face[start] = cells.count;
      while (!stack.empty()) {
        const uint32_t face = stack.back();
        stack.pop_back();
        for (uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
          if (sample.mesh.is_barrier(h) || cells.of_face[face_of(sample.mesh.twin(h))] != none) continue;
          cells.of_face[face_of(sample.mesh.twin(h))] = cells.count;
          stack.push_back(face_of(sample.mesh.twin(h)));
        }
      }
      ++cells.count;
    }
    SCOPED_TRACE(sample.name);
    HalfEdgeMesh mesh = sample.mesh;
    make_discs(mesh, cells);
    expect_discs(mesh, cells);
    if (HasFailure()) return;
  }
}

TEST(Cells, CanBeHalvedUntilTheyAreFaces) {
  HalfEdgeMesh mesh = test::plane(4, 3).mesh();
  Cells cells;
  cells.of_face.assign(mesh.faces(), 0);
  cells.count = 1;
  std::vector<std::vector<uint32_t>> faces = faces_by_cell(cells);
  ASSERT_TRUE(halve_cell(mesh, cells, faces, 0));
  EXPECT_EQ(cells.count, 2u);
  EXPECT_EQ(faces, faces_by_cell(cells));
  EXPECT_GE(faces[0].size(), 6u);
  EXPECT_GE(faces[1].size(), 6u);
  for (uint32_t cell = 0; cell < cells.count; ++cell) {
    while (faces[cell].size() > 1) {
      ASSERT_TRUE(halve_cell(mesh, cells, faces, cell));
      ASSERT_EQ(faces, faces_by_cell(cells));
    }
  }
  EXPECT_EQ(cells.count, mesh.faces());
  expect_discs(mesh, cells);
}

TEST(Cells, AreCutStraightThroughFacesWhileThereMayBeMore) {
  // Long thin triangles askew to the cut.
  HalfEdgeMesh mesh(
      {{0, 0, 0},
       {4, 0, 0},
       {0, 0.5, 0},
       {4, 0.5, 0},
       {0, 1, 0},
       {4, 1, 0},
       {0, 1.5, 0},
       {4, 1.5, 0},
       {0, 2, 0},
       {4, 2, 0}},
      std::vector<glm::uvec3>{
          {0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}, {4, 5, 7}, {4, 7, 6}, {6, 7, 9}, {6, 9, 8}});
  mesh.split_longer_than(3);
  Cells cells;
  cells.of_face.assign(mesh.faces(), 0);
  cells.count = 1;
  cells.most_faces = 60;
  std::vector<std::vector<uint32_t>> faces = faces_by_cell(cells);
  ASSERT_TRUE(halve_cell(mesh, cells, faces, 0));
  EXPECT_EQ(faces, faces_by_cell(cells));
  ASSERT_EQ(cells.count, 2u);
  expect_discs(mesh, cells);
  // The border is a straight line, but for points that were near enough to it to be taken instead.
  std::vector<glm::dvec3> border;
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h)
    if (mesh.twin(h) != none && cells.of_face[face_of(h)] == 0 && cells.of_face[face_of(mesh.twin(h))] == 1)
      border.push_back(mesh.position(mesh.from(h)));
  ASSERT_GE(border.size(), 4u);
  const glm::dvec3 along = border.back() - border.front();
  for (const glm::dvec3& p : border)
    EXPECT_LT(glm::length(glm::cross(p - border.front(), along)), 0.15 * glm::dot(along, along));
  for (uint32_t cell = 0; cell < cells.count; ++cell)
    while (faces[cell].size() > 1) ASSERT_TRUE(halve_cell(mesh, cells, faces, cell));
  EXPECT_LT(mesh.faces(), 120u);
}

TEST(Cells, ASplitGivesEachFaceToTheNearerOfTheTwo) {
  const HalfEdgeMesh mesh = test::plane(8, 1).mesh();
  Cells cells;
  cells.of_face.assign(mesh.faces(), 0);
  cells.count = 1;
  split_cell(mesh, cells, faces_by_cell(cells)[0], 0, mesh.faces() - 1);
  for (uint32_t f = 0; f < mesh.faces(); ++f) EXPECT_EQ(cells.of_face[f], f < 8 ? 0u : 1u);
}

TEST(Cells, HaveTheRadiusOfACircleOfTheirShare) {
  CellOptions options;
  options.cells = 4;
  EXPECT_NEAR(cell_radius(4 * test::pi, options), 1, 1e-15);
  options.cells = 0;
  EXPECT_NEAR(cell_radius(test::pi, options), 1, 1e-15);
}

TEST(Cells, OfAThinSurfaceAreAsLongAsInARow) {
  const HalfEdgeMesh needle({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}}, std::vector<glm::uvec3>{{0, 1, 2}});
  CellOptions options;
  options.cells = 1;
  EXPECT_NEAR(cell_radius(needle, options), 0.5, 1e-12);
  options.cells = 4;
  EXPECT_NEAR(cell_radius(needle, options), 0.125, 1e-12);
  EXPECT_LE(cells_of(needle, options).count, 4u);
}

}  // namespace
}  // namespace lodestone::base_complex
