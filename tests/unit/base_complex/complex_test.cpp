// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "lodestone/base/parallel.h"
#include "lodestone/base_complex/base_complex.h"
#include "surfaces.h"

namespace lodestone::base_complex {
namespace {

using Edge = std::pair<uint32_t, uint32_t>;

BaseComplex complex_of(HalfEdgeMesh mesh, uint32_t cells) {
  CellOptions options;
  options.cells = cells;
  Cells grown = grow_cells(mesh, options);
  return build_complex(std::move(mesh), std::move(grown));
}

bool is_border(const BaseComplex& complex, uint32_t h) {
  const uint32_t twin = complex.mesh.twin(h);
  return twin == none || complex.cell_of_face[face_of(twin)] != complex.cell_of_face[face_of(h)];
}

// The points of a passage as its own cell meets them.
std::vector<uint32_t> walked(const BaseComplex& complex, const Passage& passage) {
  const size_t count = complex.arcs[passage.arc].points.size();
  std::vector<uint32_t> points;
  for (uint32_t h = passage.first_half_edge; points.size() + 1 < count; h = next_on_boundary(complex, h)) {
    points.push_back(complex.mesh.from(h));
    if (points.size() + 1 == count) points.push_back(complex.mesh.to(h));
  }
  return points;
}

void expect_arcs_are_shared_whole(const BaseComplex& complex) {
  std::vector<uint32_t> beside(complex.arcs.size(), 0);
  for (uint32_t c = 0; c < complex.cells.size(); ++c) {
    for (const Passage& passage : complex.cells[c].boundary) {
      ASSERT_LT(passage.arc, complex.arcs.size());
      ++beside[passage.arc];
      EXPECT_EQ(complex.cell_of_face[face_of(passage.first_half_edge)], c);
      std::vector<uint32_t> points = walked(complex, passage);
      if (passage.backwards) std::reverse(points.begin(), points.end());
      EXPECT_EQ(points, complex.arcs[passage.arc].points);
    }
  }
  for (size_t a = 0; a < beside.size(); ++a) {
    EXPECT_GT(beside[a], 0u);
    EXPECT_EQ(beside[a], complex.arcs[a].cells);
  }
}

// Every border edge is in one arc, a point inside an arc is in no other, and two arcs have not both ends in
// common.
void expect_arcs_are_apart(const BaseComplex& complex) {
  std::set<Edge> edges, ends;
  std::map<uint32_t, uint32_t> inside;
  std::set<uint32_t> nodes;
  for (uint32_t a = 0; a < complex.arcs.size(); ++a) {
    const Arc& arc = complex.arcs[a];
    ASSERT_GE(arc.points.size(), 2u);
    double length = 0;
    for (size_t i = 0; i + 1 < arc.points.size(); ++i) {
      EXPECT_TRUE(edges.insert(std::minmax({arc.points[i], arc.points[i + 1]})).second);
      length += glm::distance(complex.mesh.position(arc.points[i]), complex.mesh.position(arc.points[i + 1]));
    }
    EXPECT_NEAR(arc.length, length, 1e-12 * length);
    for (size_t i = 1; i + 1 < arc.points.size(); ++i)
      EXPECT_TRUE(inside.emplace(arc.points[i], a).second) << "a crossing that is no node";
    nodes.insert({arc.points.front(), arc.points.back()});
    EXPECT_NE(arc.points.front(), arc.points.back());
    EXPECT_TRUE(ends.insert(std::minmax({arc.points.front(), arc.points.back()})).second)
        << "two arcs between the same two nodes";
  }
  for (const uint32_t node : nodes) EXPECT_EQ(inside.count(node), 0u);
  std::set<Edge> borders;
  for (uint32_t h = 0; h < 3 * complex.mesh.faces(); ++h)
    if (is_border(complex, h)) borders.insert(std::minmax({complex.mesh.from(h), complex.mesh.to(h)}));
  EXPECT_EQ(edges, borders);
}

// An arc is an edge of the surface itself from end to end, or nowhere.
void expect_arcs_are_firm_or_not(const BaseComplex& complex) {
  std::map<Edge, bool> is_barrier;
  for (uint32_t h = 0; h < 3 * complex.mesh.faces(); ++h)
    is_barrier[std::minmax({complex.mesh.from(h), complex.mesh.to(h)})] = complex.mesh.is_barrier(h);
  for (const Arc& arc : complex.arcs)
    for (size_t i = 0; i + 1 < arc.points.size(); ++i)
      EXPECT_EQ(is_barrier.at(std::minmax({arc.points[i], arc.points[i + 1]})), arc.firm);
}

void expect_cells_are_rectangles(const BaseComplex& complex) {
  std::vector<uint32_t> faces_of(complex.cells.size(), 0);
  for (uint32_t c = 0; c < complex.cells.size(); ++c) {
    const Cell& cell = complex.cells[c];
    ASSERT_GE(cell.boundary.size(), 4u);
    EXPECT_EQ(cell.corners[0], 0u);
    for (size_t k = 0; k < 4; ++k) {
      EXPECT_LT(cell.corners[k], cell.boundary.size());
      EXPECT_TRUE(k == 0 || cell.corners[k - 1] < cell.corners[k]);
    }
    std::set<uint32_t> passed;
    for (size_t p = 0; p < cell.boundary.size(); ++p) {
      EXPECT_TRUE(passed.insert(cell.boundary[p].arc).second) << "a cell that has an arc twice";
      const Passage& following = cell.boundary[(p + 1) % cell.boundary.size()];
      EXPECT_EQ(walked(complex, cell.boundary[p]).back(), complex.mesh.from(following.first_half_edge));
    }
    double area = 0;
    for (const uint32_t face : cell.faces) {
      EXPECT_EQ(complex.cell_of_face[face], c);
      area += complex.mesh.area(face);
    }
    EXPECT_NEAR(cell.area, area, 1e-12 * area);
    EXPECT_TRUE(std::is_sorted(cell.faces.begin(), cell.faces.end()));
    faces_of[c] = static_cast<uint32_t>(cell.faces.size());
  }
  uint64_t all = 0;
  for (const uint32_t faces : faces_of) all += faces;
  EXPECT_EQ(all, complex.mesh.faces());
}

// An edge through a cell from one point of its boundary to another would leave faces without area when both
// come to lie on one side.
void expect_no_chords(const BaseComplex& complex) {
  std::set<std::pair<uint32_t, uint32_t>> border_points;  // cell and point
  for (uint32_t h = 0; h < 3 * complex.mesh.faces(); ++h) {
    if (!is_border(complex, h)) continue;
    border_points.emplace(complex.cell_of_face[face_of(h)], complex.mesh.from(h));
    border_points.emplace(complex.cell_of_face[face_of(h)], complex.mesh.to(h));
  }
  for (uint32_t h = 0; h < 3 * complex.mesh.faces(); ++h) {
    const uint32_t cell = complex.cell_of_face[face_of(h)];
    EXPECT_FALSE(!is_border(complex, h) && border_points.count({cell, complex.mesh.from(h)}) &&
                 border_points.count({cell, complex.mesh.to(h)}));
  }
}

void expect_complex(const BaseComplex& complex) {
  expect_arcs_are_shared_whole(complex);
  expect_arcs_are_apart(complex);
  expect_arcs_are_firm_or_not(complex);
  expect_cells_are_rectangles(complex);
  expect_no_chords(complex);
}

TEST(Complex, IsSoundWhateverTheSurface) {
  for (const test::Sample& sample : test::all_samples()) {
    for (const uint32_t cells : {1u, 10u, 100000u}) {
      SCOPED_TRACE(sample.name + ", " + std::to_string(cells));
      expect_complex(complex_of(sample.mesh, cells));
      if (HasFailure()) return;
    }
  }
}

// Random discs, which nobody would choose: long and ragged ones, cells of one face.
TEST(Complex, IsSoundForRaggedCells) {
  for (const test::Sample& sample : test::all_samples()) {
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
      std::mt19937 random(seed);
      Cells cells;
      cells.of_face.assign(sample.mesh.faces(), 0);
      cells.count = sample.mesh.faces();
      for (uint32_t f = 0; f < cells.count; ++f) cells.of_face[f] = f;
      // Unions of faces, by edges taken at random; then numbered from 0.
      for (uint32_t i = 0; i < sample.mesh.faces(); ++i) {
        const auto h = static_cast<uint32_t>(random() % (3 * sample.mesh.faces()));
        if (sample.mesh.is_barrier(h) || random() % 5 < seed) continue;
        const uint32_t from = cells.of_face[face_of(h)], to = cells.of_face[face_of(sample.mesh.twin(h))];
        std::replace(cells.of_face.begin(), cells.of_face.end(), from, to);
      }
      std::map<uint32_t, uint32_t> numbers;
      for (uint32_t& cell : cells.of_face)
        cell = numbers.emplace(cell, static_cast<uint32_t>(numbers.size())).first->second;
      cells.count = static_cast<uint32_t>(numbers.size());
      SCOPED_TRACE(sample.name + ", " + std::to_string(seed));
      HalfEdgeMesh mesh = sample.mesh;
      make_discs(mesh, cells);
      expect_complex(build_complex(std::move(mesh), cells));
      if (HasFailure()) return;
    }
  }
}

TEST(Complex, KeepsTheSurface) {
  for (const test::Sample& sample : test::all_samples()) {
    const BaseComplex complex = complex_of(sample.mesh, 10);
    double before = 0, after = 0;
    for (uint32_t f = 0; f < sample.mesh.faces(); ++f) before += sample.mesh.area(f);
    for (const Cell& cell : complex.cells) after += cell.area;
    EXPECT_NEAR(after, before, 1e-10 * before) << sample.name;
  }
}

TEST(Complex, OfARectangleHasItsCorners) {
  Cells one;
  one.of_face.assign(2 * 8 * 5, 0);
  one.count = 1;
  const BaseComplex complex = build_complex(test::plane(8, 5).mesh(), one);
  const Cell& cell = complex.cells[0];
  std::set<std::pair<double, double>> corners;
  for (const uint32_t corner : cell.corners) {
    const glm::dvec3 p = complex.mesh.position(complex.mesh.from(cell.boundary[corner].first_half_edge));
    corners.emplace(p.x, p.y);
  }
  EXPECT_EQ(corners, (std::set<std::pair<double, double>>{{0, 0}, {8, 0}, {8, 5}, {0, 5}}));
}

TEST(Complex, ArcsAreFirmWhereTheSurfaceHasAnEdge) {
  const BaseComplex closed = complex_of(test::sphere(16).mesh(), 12);
  for (const Arc& arc : closed.arcs) {
    EXPECT_FALSE(arc.firm);
    EXPECT_EQ(arc.cells, 2u);
  }
  const BaseComplex open = complex_of(test::plane(12, 12).mesh(), 12);
  for (const Arc& arc : open.arcs) EXPECT_EQ(arc.firm, arc.cells == 1);
  const BaseComplex fan = complex_of(test::sheets(5).mesh(), 1);
  uint32_t spine = 0;
  for (const Arc& arc : fan.arcs) {
    EXPECT_TRUE(arc.firm);
    spine += arc.cells == 5 ? 1 : 0;
  }
  EXPECT_GE(spine, 1u);
}

TEST(Complex, KnowsHowFarPointsOfArcsAreFromTheEdgesOfTheSurface) {
  // One hole in the middle of a plane: what is beside no cell on the outside has only that near.
  const auto is_hole = [](uint32_t x, uint32_t y) { return x / 4 == 3 && y / 4 == 3; };
  const BaseComplex complex = complex_of(test::plane(28, 28, is_hole).mesh(), 30);
  const auto to_edge = [](const glm::dvec3& p) {
    const double outside = std::min({p.x, p.y, 28 - p.x, 28 - p.y});
    const double hole = glm::length(glm::max(glm::abs(glm::dvec2(p) - 14.0) - 2.0, glm::dvec2(0)));
    return std::min(outside, hole);
  };
  bool some = false;
  for (const Arc& arc : complex.arcs) {
    if (arc.firm) {
      EXPECT_TRUE(arc.room.empty());
      continue;
    }
    ASSERT_EQ(arc.room.size(), arc.points.size());
    for (size_t i = 0; i < arc.points.size(); ++i) {
      // Of an edge that is beside none of its cells an arc knows nothing.
      EXPECT_GE(arc.room[i], to_edge(complex.mesh.position(arc.points[i])) - 1e-12);
      some = some || std::abs(arc.room[i] - to_edge(complex.mesh.position(arc.points[i]))) < 1e-12;
      if (to_edge(complex.mesh.position(arc.points[i])) == 0) {
        EXPECT_EQ(arc.room[i], 0);
      }
    }
  }
  EXPECT_TRUE(some);
}

TEST(Complex, IsTheSameOnAnyNumberOfThreads) {
  for (const test::Sample& sample : test::all_samples()) {
    set_thread_count(1);
    const BaseComplex first = complex_of(sample.mesh, 12);
    for (const uint32_t threads : {2u, 7u}) {
      set_thread_count(threads);
      const BaseComplex again = complex_of(sample.mesh, 12);
      ASSERT_EQ(again.arcs.size(), first.arcs.size());
      for (size_t a = 0; a < first.arcs.size(); ++a) EXPECT_EQ(again.arcs[a].points, first.arcs[a].points);
      ASSERT_EQ(again.cells.size(), first.cells.size());
      for (size_t c = 0; c < first.cells.size(); ++c) {
        EXPECT_EQ(again.cells[c].corners, first.cells[c].corners);
        EXPECT_EQ(again.cells[c].faces, first.cells[c].faces);
      }
    }
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace lodestone::base_complex
