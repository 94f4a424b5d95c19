// SPDX-License-Identifier: MIT
// Cutting a cell in two along a plane, through its faces: the border is as straight as the surface is flat,
// whatever the faces are.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/cells.h"

namespace lodestone::base_complex {

// Cuts a cell by the plane half way between two of its faces, which end on different sides. Each connected
// piece but the first is a cell with a new number. `faces` lists the faces of each cell, and is kept true.
// False, with the cell as it was but perhaps for more faces, where the plane does not part it into few pieces
// of some size.
bool cut_cell(HalfEdgeMesh& mesh, Cells& cells, std::vector<std::vector<uint32_t>>& faces, uint32_t cell,
              uint32_t first, uint32_t second);

}  // namespace lodestone::base_complex
