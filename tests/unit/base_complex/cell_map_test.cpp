// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/cell_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lodestone/base_complex/predicates.h"
#include "surfaces.h"

namespace lodestone::base_complex {
namespace {

BaseComplex complex_of(HalfEdgeMesh mesh, uint32_t cells) {
  CellOptions options;
  options.cells = cells;
  Cells grown = grow_cells(mesh, options);
  return build_complex(std::move(mesh), std::move(grown));
}

BaseComplex one_cell(const HalfEdgeMesh& mesh) {
  Cells cells;
  cells.of_face.assign(mesh.faces(), 0);
  cells.count = 1;
  return build_complex(mesh, cells);
}

// As wide and as high as the sides are on average; each passage has its share of its side.
Rectangle rectangle_of(const BaseComplex& complex, const Cell& cell) {
  std::array<double, 4> length{};
  std::vector<size_t> side(cell.boundary.size());
  for (size_t p = 0; p < cell.boundary.size(); ++p) {
    for (size_t s = 0; s < 4; ++s)
      if (p >= cell.corners[s]) side[p] = s;
    length[side[p]] += complex.arcs[cell.boundary[p].arc].length;
  }
  Rectangle rectangle;
  rectangle.width = (length[0] + length[2]) / 2;
  rectangle.height = (length[1] + length[3]) / 2;
  for (size_t p = 0; p < cell.boundary.size(); ++p) {
    const double whole = side[p] % 2 == 0 ? rectangle.width : rectangle.height;
    rectangle.segments.push_back(whole * complex.arcs[cell.boundary[p].arc].length / length[side[p]]);
  }
  return rectangle;
}

double energy_of(const CellMap& map) {
  double sum = 0;
  for (size_t f = 0; f < map.faces.size(); ++f) sum += map.shapes[f].area * map.squared_stretch_of(f);
  return sum;
}

// 1 for an isometry up to scale; what the map's mean density of texels makes of the stretch is taken out.
double stretch_of(const CellMap& map, const Rectangle& rectangle) {
  double area = 0;
  for (const TriangleShape& shape : map.shapes) area += shape.area;
  return std::sqrt(energy_of(map) / area * rectangle.width * rectangle.height / area);
}

CellMap map_of(const BaseComplex& complex, uint32_t cell, const Rectangle& rectangle,
               const MapOptions& options = {}) {
  return map_cell(complex, cell, rectangle, face_shapes(complex, cell), options);
}

// Every inner point at the mean of its neighbours, by plain iteration.
CellMap tutte(CellMap map) {
  std::vector<std::set<uint32_t>> neighbours(map.points.size());
  for (const auto& f : map.faces) {
    for (size_t k = 0; k < 3; ++k) {
      neighbours[f[k]].insert(f[(k + 1) % 3]);
      neighbours[f[k]].insert(f[(k + 2) % 3]);
    }
  }
  for (int i = 0; i < 4000; ++i) {
    for (auto p = map.boundary_points; p < map.points.size(); ++p) {
      glm::dvec2 sum(0);
      for (const uint32_t n : neighbours[p]) sum += map.at[n];
      map.at[p] = sum / double(neighbours[p].size());
    }
  }
  return map;
}

void expect_one_to_one(const CellMap& map) {
  for (const auto& [a, b, c] : map.faces) EXPECT_EQ(orientation(map.at[a], map.at[b], map.at[c]), 1);
}

// Walks round the rectangle: sides, corners and the borders between passages are where they were asked for.
void expect_boundary(const BaseComplex& complex, uint32_t index, const Rectangle& rectangle,
                     const CellMap& map) {
  const Cell& cell = complex.cells[index];
  const glm::dvec2 size(rectangle.width, rectangle.height);
  const glm::dvec2 corners[4] = {{0, 0}, {size.x, 0}, size, {0, size.y}};
  const glm::dvec2 directions[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  const double tolerance = 1e-12 * (size.x + size.y);
  size_t point = 0;
  glm::dvec2 start = corners[0];
  for (size_t p = 0, side = 0; p < cell.boundary.size(); ++p) {
    while (side < 3 && p == cell.corners[side + 1]) {
      ++side;
      EXPECT_LT(glm::distance(start, corners[side]), tolerance) << "segments that are not the side's length";
    }
    const glm::dvec2 end = start + rectangle.segments[p] * directions[side];
    uint32_t h = cell.boundary[p].first_half_edge;
    double before = 0;
    for (size_t i = 0; i + 1 < complex.arcs[cell.boundary[p].arc].points.size(); ++i, ++point) {
      ASSERT_LT(point, map.boundary_points);
      EXPECT_EQ(map.points[point], complex.mesh.from(h));
      const double along = glm::dot(map.at[point] - start, directions[side]);
      EXPECT_LT(glm::distance(map.at[point], start + along * directions[side]), tolerance);
      if (i == 0) {
        EXPECT_NEAR(along, 0, tolerance);
      } else {
        EXPECT_GT(along, before);
      }
      EXPECT_LT(along, rectangle.segments[p] + tolerance);
      before = along;
      h = next_on_boundary(complex, h);
    }
    start = end;
  }
  EXPECT_EQ(point, map.boundary_points);
  for (size_t p = 0; p < map.points.size(); ++p) {
    EXPECT_TRUE(map.at[p].x >= -tolerance && map.at[p].x <= size.x + tolerance);
    EXPECT_TRUE(map.at[p].y >= -tolerance && map.at[p].y <= size.y + tolerance);
  }
}

TEST(CellMap, IsOneToOneOntoTheRectangleWhateverTheSurface) {
  for (const test::Sample& sample : test::all_samples()) {
    for (const uint32_t cells : {1u, 20u}) {
      SCOPED_TRACE(sample.name + ", " + std::to_string(cells));
      const BaseComplex complex = complex_of(sample.mesh, cells);
      for (uint32_t c = 0; c < complex.cells.size(); ++c) {
        const Rectangle rectangle = rectangle_of(complex, complex.cells[c]);
        const CellMap map = map_of(complex, c, rectangle);
        ASSERT_EQ(map.faces.size(), complex.cells[c].faces.size());
        for (size_t f = 0; f < map.faces.size(); ++f) {
          for (uint32_t k = 0; k < 3; ++k)
            EXPECT_EQ(map.points[map.faces[f][k]], complex.mesh.corners(complex.cells[c].faces[f])[k]);
        }
        expect_one_to_one(map);
        expect_boundary(complex, c, rectangle, map);
        if (HasFailure()) return;
      }
    }
  }
}

TEST(CellMap, IsOneToOneOntoAVeryLongRectangle) {
  const BaseComplex complex = one_cell(test::plane(9, 9).mesh());
  for (const double factor : {1e-6, 1e-3, 1e3, 1e6}) {
    Rectangle rectangle = rectangle_of(complex, complex.cells[0]);
    rectangle.width *= factor;
    for (size_t p = 0; p < rectangle.segments.size(); ++p) {
      const std::array<uint32_t, 4>& corners = complex.cells[0].corners;
      if (p < corners[1] || (p >= corners[2] && p < corners[3])) rectangle.segments[p] *= factor;
    }
    const CellMap map = map_of(complex, 0, rectangle);
    expect_one_to_one(map);
    expect_boundary(complex, 0, rectangle, map);
  }
}

TEST(CellMap, StretchesNoMoreThanThePlainMap) {
  for (const test::Sample& sample : test::all_samples()) {
    const BaseComplex complex = complex_of(sample.mesh, 6);
    for (uint32_t c = 0; c < complex.cells.size(); c += 7) {
      const CellMap map = map_of(complex, c, rectangle_of(complex, complex.cells[c]));
      EXPECT_LE(energy_of(map), energy_of(tutte(map)) * (1 + 1e-9)) << sample.name << ", cell " << c;
    }
  }
}

TEST(CellMap, RelaxingNeverStretchesMore) {
  const BaseComplex complex = complex_of(test::plate_with_holes(2, 4).mesh(), 4);
  MapOptions options;
  options.least_gain = 0;
  for (uint32_t c = 0; c < complex.cells.size(); ++c) {
    double before = std::numeric_limits<double>::infinity();
    for (const uint32_t sweeps : {0u, 1u, 2u, 5u, 20u}) {
      options.sweeps = sweeps;
      const double energy = energy_of(map_of(complex, c, rectangle_of(complex, complex.cells[c]), options));
      EXPECT_LE(energy, before * (1 + 1e-12));
      before = energy;
    }
  }
}

TEST(CellMap, OfAFlatRegularPatchIsNearlyAnIsometry) {
  for (const glm::uvec2 size : {glm::uvec2(12, 12), glm::uvec2(24, 6), glm::uvec2(3, 17)}) {
    const BaseComplex complex = one_cell(test::plane(size.x, size.y).mesh());
    const Rectangle rectangle = rectangle_of(complex, complex.cells[0]);
    EXPECT_NEAR(stretch_of(map_of(complex, 0, rectangle), rectangle), 1, 0.1);
    MapOptions patient;
    patient.sweeps = 2000;
    patient.least_gain = 1e-9;
    EXPECT_NEAR(stretch_of(map_of(complex, 0, rectangle, patient), rectangle), 1, 1e-4);
  }
}

// A deep cup: of its bottom a plain map makes a spot.
TEST(CellMap, OfWhatIsStronglyStretchedGetsMuchBetter) {
  test::Surface cup = test::tube(24, 40, 8);
  const uint32_t bottom = cup.add({0, 0, 0});
  for (uint32_t x = 0; x < 24; ++x) cup.triangles.emplace_back(41 * ((x + 1) % 24), 41 * x, bottom);
  const BaseComplex complex = one_cell(cup.mesh());
  const Rectangle rectangle = rectangle_of(complex, complex.cells[0]);
  const CellMap map = map_of(complex, 0, rectangle);
  expect_one_to_one(map);
  EXPECT_LT(energy_of(map), 0.5 * energy_of(tutte(map)));
}

TEST(CellMap, PutsThePlacesOfAnArcAtEvenDistances) {
  const BaseComplex complex = one_cell(test::plane(16, 16).mesh());
  const Cell& cell = complex.cells[0];
  Rectangle rectangle;
  // Squeezed towards the start of each arc: places at 0, 1/16, 4/16, 9/16 and 16/16 of its length.
  std::vector<double> sides(4, 0);
  for (size_t p = 0, side = 0; p < cell.boundary.size(); ++p) {
    while (side < 3 && p == cell.corners[side + 1]) ++side;
    const double length = complex.arcs[cell.boundary[p].arc].length;
    rectangle.segments.push_back(length);
    sides[side] += length;
    std::vector<double>& places = rectangle.places.emplace_back();
    for (const double x : {0.0, 0.0625, 0.25, 0.5625, 1.0}) places.push_back(x * length);
  }
  rectangle.width = sides[0];
  rectangle.height = sides[1];
  ASSERT_EQ(sides[2], sides[0]);
  const CellMap map = map_of(complex, 0, rectangle);
  expect_one_to_one(map);
  expect_boundary(complex, 0, rectangle, map);
  size_t point = 0;
  for (size_t p = 0; p < cell.boundary.size(); ++p) {
    const Arc& arc = complex.arcs[cell.boundary[p].arc];
    const size_t first = point;
    for (size_t i = 0; i + 1 < arc.points.size(); ++i, ++point) {
      const double from_start = glm::distance(map.at[point], map.at[first]) / rectangle.segments[p];
      const double in_arc = cell.boundary[p].backwards ? 1 - from_start : from_start;
      const uint32_t of_arc = arc.points[cell.boundary[p].backwards ? arc.points.size() - 1 - i : i];
      const double distance =
          glm::distance(complex.mesh.position(of_arc), complex.mesh.position(arc.points.front()));
      for (size_t k = 0; k < 5; ++k) {
        if (std::abs(distance - rectangle.places[p][k]) < 1e-9) {
          EXPECT_NEAR(in_arc, double(k) / 4, 1e-5);
        }
      }
    }
  }
}

TEST(CellMap, TakesShapesThatAreNotTheSurfaces) {
  // As if the surface were twice as long: what is shorter then is stretched less.
  const test::Surface plane = test::plane(10, 10);
  const BaseComplex complex = one_cell(plane.mesh());
  const Rectangle rectangle = rectangle_of(complex, complex.cells[0]);
  std::vector<TriangleShape> shapes;
  for (const uint32_t face : complex.cells[0].faces) {
    glm::dvec3 at[3];
    for (size_t k = 0; k < 3; ++k) {
      at[k] = complex.mesh.position(complex.mesh.corners(face)[k]);
      at[k].x = at[k].x < 5 ? at[k].x : 5 + 4 * (at[k].x - 5);
    }
    shapes.push_back(shape_of(at[0], at[1], at[2]));
  }
  const CellMap map = map_cell(complex, 0, rectangle, shapes, {}), plain = map_of(complex, 0, rectangle);
  CellMap plain_with_shapes = plain;
  plain_with_shapes.shapes = shapes;
  EXPECT_LT(energy_of(map), 0.9 * energy_of(plain_with_shapes));
  expect_one_to_one(map);
}

TEST(CellMap, OfACellWithoutAreaIsStillOneToOne) {
  const std::vector<glm::dvec3> nowhere(9, glm::dvec3(1, 2, 3));
  const BaseComplex complex = one_cell(HalfEdgeMesh(nowhere, test::plane(2, 2).triangles));
  Rectangle rectangle;
  rectangle.width = rectangle.height = 4;
  const Cell& cell = complex.cells[0];
  for (size_t s = 0; s < 4; ++s) {
    const size_t end = s < 3 ? cell.corners[s + 1] : cell.boundary.size();
    for (size_t p = cell.corners[s]; p < end; ++p)
      rectangle.segments.push_back(4.0 / double(end - cell.corners[s]));
  }
  const CellMap map = map_of(complex, 0, rectangle);
  expect_one_to_one(map);
  expect_boundary(complex, 0, rectangle, map);
}

}  // namespace
}  // namespace lodestone::base_complex
