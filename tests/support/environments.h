// SPDX-License-Identifier: MIT
// Environment maps made for tests.
#pragma once

#include "lodestone/scene/scene.h"

namespace lodestone::test {

// The direction at (u, v) of a map that is not rotated, by the formula in layout/environment.h.
glm::dvec3 direction_at(double u, double v);

// A sky and a ground, a belt of squares between them, a sun of `sun` x `sun` texels a third of the way from
// -Z to +X, and a black stripe from pole to pole around -X.
scene::Environment sunny_environment(uint32_t width, uint32_t height, uint32_t sun = 1);

scene::Environment even_environment(uint32_t width, uint32_t height, const glm::vec3& radiance);

// A scene of nothing else.
scene::Scene scene_in(scene::Environment environment);

}  // namespace lodestone::test
