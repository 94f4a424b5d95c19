// SPDX-License-Identifier: MIT
// The Utah teapot as M. E. Newell modelled it in 1975: bicubic Bezier patches. 28 of them are his (rim, body,
// lid, handle, spout); the four of the bottom are F. Crow's (The Origins of the Teapot, IEEE CG&A 7(1),
// 1987). +Y up, standing on y = 0, spout towards +X; it is 6.525 long and 3.15 high. These are the
// proportions that everyone knows: J. Blinn divided Newell's heights by about 1.3, and the data have been
// passed on like that.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace lodestone::scene::builtin {

// 4 x 4 control points, row by row; columns x rows points outwards.
using BezierPatch = std::array<glm::vec3, 16>;

// Patches that join smoothly: `columns` of them side by side, the last one beside the first, and rows of
// these one below the other. Equal control points have equal bits.
struct PatchSheet {
  std::string name;
  uint32_t columns = 0;
  std::vector<BezierPatch> patches;  // row by row
};

// `body` (rim, body and bottom; ends in a pole) and `lid` (begins in one) of 4 columns, `handle` and `spout`
// of 2. At a pole a row of control points is one point.
std::vector<PatchSheet> teapot_patches();

struct PatchSample {
  glm::vec3 position, along_u, along_v;  // the latter two the derivatives
};

// u along the columns, v along the rows, both 0 to 1. Depends on the control points of a border alone where
// it is 0 or 1, to the bit.
PatchSample sample_patch(const BezierPatch& patch, float u, float v);

}  // namespace lodestone::scene::builtin
