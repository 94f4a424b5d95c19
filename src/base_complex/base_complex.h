// SPDX-License-Identifier: MIT
// A surface as patches: every cell is a disc whose boundary is a ring of arcs, and an arc is shared whole by
// all the cells beside it. Arcs end at nodes. So whatever is sampled along arcs once fits on all sides.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "lodestone/base_complex/cells.h"
#include "lodestone/base_complex/half_edge_mesh.h"

namespace lodestone::base_complex {

// Points of the mesh from one node to another, neighbours joined by edges.
struct Arc {
  std::vector<uint32_t> points;
  double length = 0;
  uint32_t cells = 0;  // beside it: 1 on a boundary, 2, or more where the input is not a manifold
  // Whether it is an edge of the surface itself (a boundary, a crease), not only one between cells.
  bool firm = false;
  // Of one that is not, how far each point is from the nearest firm arc of the cells beside it: so far it may
  // be moved along the surface and is still on it.
  std::vector<double> room;
};

// A cell's passage along an arc; backwards where it runs from the arc's last point to its first.
struct Passage {
  uint32_t arc = 0;
  bool backwards = false;
  uint32_t first_half_edge = none;  // of the cell, where the passage starts
};

struct Cell {
  std::vector<uint32_t> faces;
  std::vector<Passage> boundary;  // counterclockwise as the faces are, at least four
  // The passages at whose start the four corners of the cell's rectangle are, ascending.
  std::array<uint32_t, 4> corners{};
  double area = 0;
};

struct BaseComplex {
  explicit BaseComplex(HalfEdgeMesh surface) : mesh(std::move(surface)) {}
  HalfEdgeMesh mesh;
  std::vector<glm::dvec3> normals;  // of the points: unit length, or zero
  std::vector<uint32_t> cell_of_face;
  std::vector<Arc> arcs;
  std::vector<Cell> cells;
};

inline uint32_t next_on_boundary(const BaseComplex& complex, uint32_t half_edge) {
  return next_on_boundary(complex.mesh, complex.cell_of_face, half_edge);
}

// Of each arc the cells beside it, ascending; a cell that passes it twice is there twice.
std::vector<std::vector<uint32_t>> cells_beside_arcs(const BaseComplex& complex);

// A side of a cell's rectangle, from one corner to the next.
struct Side {
  size_t first = 0, end = 0;  // of Cell::boundary
  double length = 0;
};
std::array<Side, 4> sides_of(const BaseComplex& complex, const Cell& cell);

// The complex of the given cells, which must be discs as cells.h says. Edges of the mesh are split where a
// cell needs it.
BaseComplex build_complex(HalfEdgeMesh mesh, Cells cells);

}  // namespace lodestone::base_complex
