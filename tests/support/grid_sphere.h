// SPDX-License-Identifier: MIT
#pragma once

#include "lodestone/scene/scene.h"

namespace lodestone::test {

// A closed bumpy sphere of radius about 1 as one grid of quads x quads quads: longitude along x (first and
// last column are one), latitude along y (the first and the last row are poles).
scene::Scene grid_sphere(uint32_t quads);

}  // namespace lodestone::test
