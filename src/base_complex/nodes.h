// SPDX-License-Identifier: MIT
// The borders between cells, and which of their points are nodes: where arcs meet, and as many more as it
// takes that arcs have two different ends.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/cells.h"
#include "lodestone/base_complex/half_edge_mesh.h"

namespace lodestone::base_complex {

// Of each cell the half-edges of its boundary, in order.
using Boundaries = std::vector<std::vector<uint32_t>>;

// Splits edges of the mesh (and faces, which stay in their cell) until every boundary has at least four edges
// and no edge leads through a cell from one point of its boundary to another: mapped onto one side of a
// rectangle, the faces beside such an edge would have no area.
void split_for_boundaries(HalfEdgeMesh& mesh, Cells& cells);
Boundaries trace_boundaries(const HalfEdgeMesh& mesh, const Cells& cells);

// Whether each point of the mesh is a node. Every boundary gets at least three of them, and no arc will start
// and end at one node, nor two arcs at the same two.
std::vector<bool> find_nodes(const HalfEdgeMesh& mesh, const Cells& cells, const Boundaries& boundaries);

}  // namespace lodestone::base_complex
