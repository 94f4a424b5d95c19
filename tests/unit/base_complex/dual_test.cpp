// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/dual.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lodestone/base/disjoint_sets.h"
#include "surfaces.h"

namespace lodestone::base_complex {
namespace {

using Pair = std::pair<uint32_t, uint32_t>;

// Of each two cells, in how many pieces their common border is: from its edges alone.
std::map<Pair, size_t> pieces_of_borders(const BaseComplex& complex) {
  std::map<Pair, std::vector<uint32_t>> edges;
  for (uint32_t h = 0; h < 3 * complex.mesh.faces(); ++h) {
    std::vector<uint32_t> cells = {complex.cell_of_face[face_of(h)]};
    for (uint32_t i = complex.mesh.next_on_edge(h); i != h; i = complex.mesh.next_on_edge(i))
      cells.push_back(complex.cell_of_face[face_of(i)]);
    if (cells.size() == 2 && cells[0] < cells[1]) edges[{cells[0], cells[1]}].push_back(h);
  }
  std::map<Pair, size_t> pieces;
  for (const auto& [pair, list] : edges) {
    DisjointSets sets(complex.mesh.points());
    for (const uint32_t h : list) sets.join(complex.mesh.from(h), complex.mesh.to(h));
    std::set<uint32_t> names;
    for (const uint32_t h : list) names.insert(sets.find(complex.mesh.from(h)));
    pieces[pair] = names.size();
  }
  return pieces;
}

BaseComplex grown(HalfEdgeMesh& mesh, Cells& cells, uint32_t count) {
  CellOptions options;
  options.cells = count;
  cells = grow_cells(mesh, options);
  return build_complex(mesh, cells);
}

TEST(Dual, IsProperOnceTheCellsAgainstItAreSplit) {
  for (const test::Sample& sample : test::all_samples()) {
    for (const uint32_t count : {1u, 12u}) {
      SCOPED_TRACE(sample.name + ", " + std::to_string(count));
      HalfEdgeMesh mesh = sample.mesh;
      Cells cells;
      BaseComplex complex = grown(mesh, cells, count);
      std::vector<uint32_t> against;
      for (int round = 0; round < 12; ++round) {
        against = cells_against_proper_dual(complex);
        std::erase_if(against, [&](uint32_t c) { return complex.cells[c].faces.size() < 2; });
        if (against.empty()) break;
        std::vector<std::vector<uint32_t>> faces = faces_by_cell(cells);
        for (const uint32_t cell : against) halve_cell(mesh, cells, faces, cell);
        make_discs(mesh, cells);
        complex = build_complex(mesh, cells);
      }
      EXPECT_TRUE(against.empty());
      if (!cells_against_proper_dual(complex).empty()) continue;  // those left are single faces
      for (const auto& [pair, pieces] : pieces_of_borders(complex))
        EXPECT_EQ(pieces, 1u) << pair.first << " and " << pair.second;
    }
  }
}

TEST(Dual, NamesTheLargerOfTwoCellsThatMeetTwice) {
  // A ring in two parts, one of them a third.
  HalfEdgeMesh mesh = test::annulus(24, 6).mesh();
  Cells cells;
  cells.count = 2;
  for (uint32_t f = 0; f < mesh.faces(); ++f) cells.of_face.push_back(f / 12 < 8 ? 0 : 1);
  const BaseComplex complex = build_complex(mesh, cells);
  EXPECT_EQ(cells_against_proper_dual(complex), std::vector<uint32_t>{1});
  for (const auto& [pair, pieces] : pieces_of_borders(complex)) EXPECT_EQ(pieces, 2u);
}

TEST(Dual, NamesOneOfThreeCellsThatMeetTwice) {
  // Three segments of a sphere, from pole to pole.
  HalfEdgeMesh mesh = test::sphere(12).mesh();
  Cells cells;
  cells.count = 3;
  for (uint32_t f = 0; f < mesh.faces(); ++f) {
    const glm::dvec3 at = mesh.centroid(f);
    const double turn = std::atan2(at.y, at.x) / (2 * test::pi) + 0.5;
    cells.of_face.push_back(std::min(static_cast<uint32_t>(3 * turn), 2u));
  }
  EXPECT_EQ(cells_against_proper_dual(build_complex(mesh, cells)).size(), 1u);
}

TEST(Dual, OfAPlaneInFourIsProper) {
  HalfEdgeMesh mesh = test::plane(8, 8).mesh();
  Cells cells;
  cells.count = 4;
  for (uint32_t f = 0; f < mesh.faces(); ++f) {
    const glm::dvec3 at = mesh.centroid(f);
    cells.of_face.push_back((at.x > 4 ? 1u : 0u) + (at.y > 4 ? 2u : 0u));
  }
  EXPECT_TRUE(cells_against_proper_dual(build_complex(mesh, cells)).empty());
}

}  // namespace
}  // namespace lodestone::base_complex
