// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/arc_smoothing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base_complex/arc_places.h"
#include "surfaces.h"

namespace lodestone::base_complex {
namespace {

// Two cells of a plane whose border goes up in steps between x = 12 and x = 13.
BaseComplex zigzag(const std::function<bool(uint32_t, uint32_t)>& hole = {}) {
  HalfEdgeMesh mesh = test::plane(24, 20, hole).mesh();
  Cells cells;
  for (uint32_t f = 0; f < mesh.faces(); ++f) {
    const glm::dvec3 at = mesh.centroid(f);
    cells.of_face.push_back(at.x < 12 + int(at.y) % 2 ? 0 : 1);
  }
  cells.count = 2;
  return build_complex(std::move(mesh), std::move(cells));
}

glm::dvec3 position_of(const BaseComplex& complex, const PlaceOnFace& place) {
  const auto [a, b, c] = complex.mesh.corners(place.face);
  return complex.mesh.position(a) * place.barycentrics.x + complex.mesh.position(b) * place.barycentrics.y +
         complex.mesh.position(c) * place.barycentrics.z;
}

TEST(ArcSmoothing, StraightensAZigzag) {
  const BaseComplex complex = zigzag();
  const ArcSmoother smoother(complex);
  uint32_t moved_places = 0;
  for (uint32_t a = 0; a < complex.arcs.size(); ++a) {
    const Arc& arc = complex.arcs[a];
    const auto segments = static_cast<uint32_t>(arc.length / 2);
    const std::vector<double> places = arc_places(complex, a, segments);
    const std::vector<PlaceOnFace> moved = smoother.smooth(a, places);
    ASSERT_EQ(moved.size(), places.size());
    EXPECT_EQ(moved.front().face, none);
    EXPECT_EQ(moved.back().face, none);
    if (arc.firm) {
      for (const PlaceOnFace& place : moved) EXPECT_EQ(place.face, none);
      continue;
    }
    for (size_t i = 1; i + 1 < moved.size(); ++i) {
      // The plane's border is firm.
      const double y = complex.mesh.position(arc.points.front()).y;
      const double up = complex.mesh.position(arc.points.back()).y > y ? 1 : -1;
      const double about = y + up * 0.5 * places[i];
      if (about < 2.5 || about > 17.5) continue;
      ASSERT_NE(moved[i].face, none);
      const glm::dvec3& w = moved[i].barycentrics;
      EXPECT_GE(std::min({w.x, w.y, w.z}), 0);
      EXPECT_NEAR(w.x + w.y + w.z, 1, 1e-12);
      EXPECT_NEAR(position_of(complex, moved[i]).x, 12.5, 0.25)
          << "its points are 0.5 away, its mean over a step half of that";
      ++moved_places;
    }
  }
  EXPECT_GT(moved_places, 5u);
}

TEST(ArcSmoothing, StaysOnABentSurface) {
  HalfEdgeMesh mesh = test::sphere(24).mesh();
  CellOptions options;
  options.cells = 12;
  Cells cells = grow_cells(mesh, options);
  const BaseComplex complex = build_complex(std::move(mesh), std::move(cells));
  const ArcSmoother smoother(complex);
  for (uint32_t a = 0; a < complex.arcs.size(); ++a) {
    const std::vector<double> places = arc_places(complex, a, 8);
    const std::vector<PlaceOnFace> moved = smoother.smooth(a, places);
    for (size_t i = 0; i < moved.size(); ++i) {
      if (moved[i].face == none) continue;
      const double radius = glm::length(position_of(complex, moved[i]));
      EXPECT_GT(radius, 0.98) << "chords of faces are no deeper";
      EXPECT_LE(radius, 1 + 1e-12);
    }
  }
}

// A firm arc is nearer than what a sample would be moved by: there is no telling on which side it ends.
TEST(ArcSmoothing, LeavesSamplesBesideAFirmArcAlone) {
  const auto with_hole = [](uint32_t x, uint32_t y) { return (x == 13 || x == 11) && y >= 3 && y < 9; };
  const BaseComplex complex = zigzag(with_hole);
  const ArcSmoother smoother(complex);
  for (uint32_t a = 0; a < complex.arcs.size(); ++a) {
    const Arc& arc = complex.arcs[a];
    const std::vector<double> places = arc_places(complex, a, 2 * static_cast<uint32_t>(arc.points.size()));
    for (const PlaceOnFace& place : smoother.smooth(a, places)) {
      if (place.face == none) continue;
      const double y = position_of(complex, place).y;
      EXPECT_TRUE(y <= 3 || y >= 9) << y;
    }
  }
}

}  // namespace
}  // namespace lodestone::base_complex
