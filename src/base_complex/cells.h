// SPDX-License-Identifier: MIT
// The faces of a surface in cells, each of which is a disc: the patches of a base complex. Cells grow from
// seeds by distance and by how far the surface has turned away from the seed's normal (as the charts of
// Sander, Wood, Gortler, Snyder and Hoppe, Multi-Chart Geometry Images, 2003), never across a barrier, and
// are split until they are what a complex needs.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/half_edge_mesh.h"

namespace lodestone::base_complex {

struct CellOptions {
  uint32_t cells = 128;      // about how many a flat surface of the same area would get, at least 1
  double normal_weight = 2;  // how much dearer a step is that turns away from the seed's normal
  uint32_t relaxations = 4;  // times that seeds move to the middle of their cells
};

// The radius of a round cell of a surface of that area.
double cell_radius(double area, const CellOptions& options);
// Of a cell of the mesh: that, but where the surface is thin for its extent half the length of a cell if they
// lay in a row from end to end.
double cell_radius(const HalfEdgeMesh& mesh, const CellOptions& options);

// The cell of each face, 0 .. count - 1, every one used. Each cell is connected, has no barrier inside, a
// boundary of one loop that comes to no point twice, and Euler characteristic 1.
struct Cells {
  std::vector<uint32_t> of_face;
  uint32_t count = 0;
  // Splits may cut through faces while the mesh has fewer than this; then they part cells between faces, so
  // that they come to an end whatever the surface is.
  uint32_t most_faces = 0;
};
// Edges of the mesh are split where straight borders need it.
Cells grow_cells(HalfEdgeMesh& mesh, const CellOptions& options);

// Splits one cell in two between two of its faces: each goes to the one it is nearer to. The new cell gets
// the next number.
void split_cell(const HalfEdgeMesh& mesh, Cells& cells, const std::vector<uint32_t>& faces, uint32_t first,
                uint32_t second);

// Splits a cell in two or a few, between the faces that are farthest apart. `faces` lists the faces of each
// cell, and is kept true. False where it has but one.
bool halve_cell(HalfEdgeMesh& mesh, Cells& cells, std::vector<std::vector<uint32_t>>& faces, uint32_t cell);

// Splits cells until each is a disc as said above, and edges of the mesh as above.
void make_discs(HalfEdgeMesh& mesh, Cells& cells);

// The half-edge behind another one on the boundary of its cell: round its end, through the cell's faces.
uint32_t next_on_boundary(const HalfEdgeMesh& mesh, const std::vector<uint32_t>& cell_of_face,
                          uint32_t half_edge);

// Faces by cell, ascending.
std::vector<std::vector<uint32_t>> faces_by_cell(const Cells& cells);

}  // namespace lodestone::base_complex
