// SPDX-License-Identifier: MIT
// Scenes made of grids, at other resolutions.
#pragma once

#include <cstdint>

#include "lodestone/scene/scene.h"

namespace lodestone::test {

// The same with every grid resampled bilinearly, all by one factor a side, so that all that is placed has
// about `quads` quads; a grid keeps at least one. Throws std::invalid_argument where a mesh is not made of
// grids, or has blendshapes or a skin.
scene::Scene regridded(scene::Scene scene, uint64_t quads);

}  // namespace lodestone::test
