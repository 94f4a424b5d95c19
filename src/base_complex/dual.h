// SPDX-License-Identifier: MIT
// The dual of a complex: a vertex a cell, an edge a stretch of border between two cells, a face a node where
// cells meet. It is proper, and so can be a mesh, if no two edges have the same ends and no two triangles the
// same corners.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/base_complex.h"

namespace lodestone::base_complex {

// Cells that must be split for a proper dual, ascending: of two beside each other along several stretches, or
// of three that meet at several nodes, the largest. Borders of more than two cells do not count.
std::vector<uint32_t> cells_against_proper_dual(const BaseComplex& complex);

}  // namespace lodestone::base_complex
