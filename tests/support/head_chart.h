// SPDX-License-Identifier: MIT
// The character of the paper's tables: one chart of any resolution, with blendshapes.
#pragma once

#include <cstdint>

#include "lodestone/scene/scene.h"

namespace lodestone::test {

// The skin of builtin:head, its openings closed, as one closed chart of quads x quads quads (an octahedron
// unfolded, its front in the middle); with the head's blendshapes, clip, camera and lights. `quads`: even, 4
// to 4096; else throws std::invalid_argument.
scene::Scene head_chart(uint32_t quads);

}  // namespace lodestone::test
