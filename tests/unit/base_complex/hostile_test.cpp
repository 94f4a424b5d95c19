// SPDX-License-Identifier: MIT
// Inputs that nobody would make, but some file will hold: they take no longer than others of their size.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lodestone/base_complex/base_complex.h"
#include "surfaces.h"

namespace lodestone::base_complex {
namespace {

constexpr uint32_t many = 100000;

BaseComplex complex_of(HalfEdgeMesh mesh) {
  CellOptions options;
  Cells grown = grow_cells(mesh, options);
  return build_complex(std::move(mesh), std::move(grown));
}

TEST(Hostile, ManySheetsAtOneEdge) {
  EXPECT_EQ(complex_of(test::sheets(many).mesh()).cells.size(), many);
}

TEST(Hostile, ManyTrianglesThatHaveNothingInCommon) {
  test::Surface s;
  for (uint32_t i = 0; i < many; ++i) s.append(test::single_triangle(), {2.0 * i, 0, 0});
  EXPECT_EQ(complex_of(s.mesh()).cells.size(), many);
}

TEST(Hostile, ManyTrianglesRoundOnePoint) {
  test::Surface s;
  const uint32_t middle = s.add({0, 0, 0});
  for (uint32_t i = 0; i < many; ++i)
    s.add({std::cos(2 * test::pi * i / many), std::sin(2 * test::pi * i / many), 0});
  for (uint32_t i = 0; i < many; ++i) s.triangles.emplace_back(middle, 1 + i, 1 + (i + 1) % many);
  EXPECT_GE(complex_of(s.mesh()).cells.size(), 1u);
}

TEST(Hostile, ManyTrianglesThatTouchInOnePoint) {
  test::Surface s;
  const uint32_t middle = s.add({0, 0, 0});
  for (uint32_t i = 0; i < many; ++i) {
    const uint32_t a = s.add({std::cos(double(i)), std::sin(double(i)), 1}), b = s.add({double(i), 1, 0});
    s.triangles.emplace_back(middle, a, b);
  }
  EXPECT_EQ(complex_of(s.mesh()).cells.size(), many);
}

// Nothing has an area, so nothing has a measure by which a cell were small enough.
TEST(Hostile, ManyTrianglesOnALine) {
  test::Surface s;
  for (uint32_t i = 0; i < many; ++i) s.add({i, 0, 0});
  for (uint32_t i = 0; i + 2 < many; ++i) s.triangles.emplace_back(i, i + 1 + i % 2, i + 2 - i % 2);
  EXPECT_GE(complex_of(s.mesh()).cells.size(), 1u);
}

TEST(Hostile, AllPositionsEqual) {
  test::Surface s = test::torus(40, 30);
  for (glm::dvec3& p : s.positions) p = {1, 2, 3};
  const BaseComplex complex = complex_of(s.mesh());
  EXPECT_GE(complex.cells.size(), 2u);
  for (const Cell& cell : complex.cells) EXPECT_GE(cell.boundary.size(), 4u);
}

TEST(Hostile, CoordinatesThatAreNoNumbers) {
  for (const double what : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    test::Surface s = test::sphere(12);
    for (size_t i = 0; i < s.positions.size(); i += 3) s.positions[i].x = what;
    for (const Cell& cell : complex_of(s.mesh()).cells) EXPECT_TRUE(std::isfinite(cell.area));
  }
}

TEST(Hostile, HugeAndTinyCoordinates) {
  for (const double size : {1e-45, 1e-30, 1e30, 3e38}) {
    test::Surface s = test::sphere(12);
    for (glm::dvec3& p : s.positions) p *= size;
    EXPECT_GE(complex_of(s.mesh()).cells.size(), 2u) << size;
  }
}

}  // namespace
}  // namespace lodestone::base_complex
