// SPDX-License-Identifier: MIT
// Which four points of a cell's boundary become the corners of its rectangle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lodestone/base_complex/nodes.h"

namespace lodestone::base_complex {

// Indices into each boundary, ascending. Nodes are preferred; other points that were chosen become nodes.
std::vector<std::array<uint32_t, 4>> choose_corners(const HalfEdgeMesh& mesh, const Cells& cells,
                                                    const Boundaries& boundaries, std::vector<bool>& is_node);

}  // namespace lodestone::base_complex
