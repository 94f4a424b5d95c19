// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/unfold.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/geometry_image/map_lookup.h"
#include "surfaces.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::BaseComplex;
using base_complex::Cell;
using base_complex::CellMap;
using base_complex::Side;

// One cell, and its map onto a rectangle of 12 x 12.
struct Sheet {
  static constexpr uint32_t quads = 12, columns = quads + 1;

  explicit Sheet(const base_complex::test::Surface& surface) : complex(complex_of(surface)) {
    base_complex::Rectangle rectangle;
    rectangle.width = rectangle.height = quads;
    const Cell& cell = complex.cells[0];
    for (const Side& side : sides_of(complex, cell))
      for (size_t p = side.first; p < side.end; ++p)
        rectangle.segments.push_back(quads * complex.arcs[cell.boundary[p].arc].length / side.length);
    map = map_cell(complex, 0, rectangle, face_shapes(complex, 0), {});
    points = find_lattice(map, columns, columns, 1);
    for (const FacePoint& point : points) samples.push_back(facet_at(complex, 0, map, point));
  }

  static BaseComplex complex_of(const base_complex::test::Surface& surface) {
    base_complex::HalfEdgeMesh mesh = surface.mesh();
    base_complex::Cells one;
    one.of_face.assign(mesh.faces(), 0);
    one.count = 1;
    return build_complex(std::move(mesh), std::move(one));
  }

  BaseComplex complex;
  CellMap map;
  std::vector<FacePoint> points;
  std::vector<Facet> samples;
};

base_complex::test::Surface hills() {
  base_complex::test::Surface surface = base_complex::test::plane(30, 30);
  for (glm::dvec3& p : surface.positions) p.z = 2 * std::sin(0.3 * p.x) * std::cos(0.2 * p.y);
  return surface;
}

TEST(Unfold, LeavesASmoothChartAsItIs) {
  for (const base_complex::test::Surface& surface : {base_complex::test::plane(20, 20), hills()}) {
    Sheet sheet(surface);
    EXPECT_FALSE(has_folds(Sheet::columns, sheet.samples));
    const std::vector<FacePoint> before = sheet.points;
    unfold(sheet.complex, 0, sheet.map, Sheet::columns, sheet.samples, sheet.points);
    for (size_t i = 0; i < before.size(); ++i)
      EXPECT_EQ(sheet.points[i].barycentrics, before[i].barycentrics);
  }
}

TEST(Unfold, MovesSamplesAwayFromARaggedBorder) {
  for (const base_complex::test::Surface& surface : {base_complex::test::plane(24, 24), hills()}) {
    Sheet sheet(surface);
    // Every other sample of a side is drawn in, farther than its neighbours inside are.
    for (uint32_t x = 1; x < Sheet::quads; x += 2) {
      const FacePoint inside = FaceWalk(sheet.map).find({x, 1.4}, sheet.points[x].face);
      ASSERT_NE(inside.face, base_complex::none);
      sheet.samples[x] = facet_at(sheet.complex, 0, sheet.map, inside);
    }
    const std::vector<Facet> before = sheet.samples;
    ASSERT_TRUE(has_folds(Sheet::columns, sheet.samples));
    unfold(sheet.complex, 0, sheet.map, Sheet::columns, sheet.samples, sheet.points);
    EXPECT_FALSE(has_folds(Sheet::columns, sheet.samples));
    for (uint32_t y = 0; y < Sheet::columns; ++y) {
      for (uint32_t x = 0; x < Sheet::columns; ++x) {
        const size_t i = size_t(y) * Sheet::columns + x;
        const bool border = x == 0 || y == 0 || x == Sheet::quads || y == Sheet::quads;
        if (border) {
          EXPECT_EQ(sheet.samples[i].position, before[i].position);
        } else {
          EXPECT_EQ(sheet.samples[i].position,
                    facet_at(sheet.complex, 0, sheet.map, sheet.points[i]).position);
        }
        if (y > 9) {
          EXPECT_EQ(sheet.samples[i].position, before[i].position) << "far from all folds";
        }
      }
    }
  }
}

TEST(Unfold, EndsWhereNothingHelps) {
  // A border that is folded over the whole chart.
  Sheet sheet(base_complex::test::plane(24, 24));
  for (uint32_t x = 0; x < Sheet::columns; ++x) sheet.samples[x].position.y += 40;
  unfold(sheet.complex, 0, sheet.map, Sheet::columns, sheet.samples, sheet.points);
  EXPECT_TRUE(has_folds(Sheet::columns, sheet.samples));
  for (const FacePoint& point : sheet.points) {
    const glm::dvec2 at = place_in(sheet.map, point);
    EXPECT_TRUE(at.x >= -1e-9 && at.y >= -1e-9 && at.x <= Sheet::quads + 1e-9 && at.y <= Sheet::quads + 1e-9);
  }
}

TEST(FaceWalk, FindsWhatTheLatticeDoes) {
  const Sheet sheet(hills());
  const FaceWalk walk(sheet.map);
  for (size_t i = 0; i < sheet.points.size(); ++i) {
    const glm::dvec2 at(i % Sheet::columns, i / Sheet::columns);
    const FacePoint found = walk.find(at, static_cast<uint32_t>((i * 37) % sheet.map.faces.size()));
    ASSERT_NE(found.face, base_complex::none);
    EXPECT_NEAR(glm::distance(place_in(sheet.map, found), at), 0, 1e-6);
    EXPECT_NEAR(glm::distance(place_in(sheet.map, sheet.points[i]), at), 0, 1e-6);
  }
  EXPECT_EQ(walk.find({-1, 3}, 0).face, base_complex::none);
}

TEST(FaceWalk, KnowsWhatIsBesideEveryEdge) {
  const Sheet sheet(base_complex::test::plane(5, 4));
  const FaceWalk walk(sheet.map);
  uint32_t border = 0;
  for (uint32_t f = 0; f < sheet.map.faces.size(); ++f) {
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t other = walk.beside(f, k);
      if (other == base_complex::none) {
        ++border;
        continue;
      }
      bool back = false;
      for (uint32_t j = 0; j < 3; ++j) back = back || walk.beside(other, j) == f;
      EXPECT_TRUE(back);
    }
  }
  EXPECT_EQ(border, sheet.map.boundary_points);
}

}  // namespace
}  // namespace lodestone::geometry_image
