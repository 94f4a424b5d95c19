// SPDX-License-Identifier: MIT
#pragma once

#include "lodestone/scene/scene.h"

namespace lodestone::test {

// The unit sphere, six sides of quads x quads quads, with a morph target "bulge" that blows a cap of it, half
// a radian from the axis (1, 1, 1) to its rim, up to a bulb of about six times its area. The scene has a
// camera that looks at it from the side.
scene::Scene bulging_sphere(uint32_t quads);

}  // namespace lodestone::test
