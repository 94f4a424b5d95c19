// SPDX-License-Identifier: MIT
// The map of a cell onto its rectangle: one to one, and of little L2 stretch (section 3.1 of the geometry
// image paper).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/base_complex/stretch.h"

namespace lodestone::base_complex {

// Where the boundary of a cell goes: corner 0 to (0, 0), the next ones counterclockwise to (width, 0),
// (width, height) and (0, height); passage i of the cell takes `segments[i]` (> 0) of the side that it is
// part of, whose sum is the side's length. Along it the arc's points are placed by distance or, where
// `places[i]` is not empty, so that these distances along the arc are evenly spaced.
struct Rectangle {
  double width = 1, height = 1;
  std::vector<double> segments;
  std::vector<std::vector<double>> places;
};

struct CellMap {
  std::vector<uint32_t> points;                // of the mesh
  std::vector<std::array<uint32_t, 3>> faces;  // indices into `points`, in the order of Cell::faces
  std::vector<TriangleShape> shapes;           // of the faces
  std::vector<glm::dvec2> at;                  // of each point, in the rectangle
  uint32_t boundary_points = 0;                // they come first, in order

  double squared_stretch_of(size_t face) const {
    const auto& [a, b, c] = faces[face];
    return squared_stretch(shapes[face], at[b] - at[a], at[c] - at[a]);
  }
};

struct MapOptions {
  uint32_t sweeps = 30;      // of the relaxation at most
  double least_gain = 1e-3;  // it ends when a sweep lowers the stretch by less, relatively
};

// A convex combination map (Tutte 1963, Floater 2003), then relaxed. Every face is counterclockwise, exactly.
// `shapes` are those of the cell's faces, in order: of the surface as it is, or of what the stretch is to be
// low for. Throws NotMappable where rounding prevents that.
struct NotMappable {};
CellMap map_cell(const BaseComplex& complex, uint32_t cell, const Rectangle& rectangle,
                 std::vector<TriangleShape> shapes, const MapOptions& options);

// The shapes of the cell's faces on the surface as it is.
std::vector<TriangleShape> face_shapes(const BaseComplex& complex, uint32_t cell);

}  // namespace lodestone::base_complex
