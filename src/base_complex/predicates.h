// SPDX-License-Identifier: MIT
// Orientation in the plane, exact whatever the rounding (J. R. Shewchuk, Adaptive Precision Floating-Point
// Arithmetic and Fast Robust Geometric Predicates, 1997).
#pragma once

#include <glm/glm.hpp>

namespace lodestone::base_complex {

// +1 where a, b, c turn counterclockwise, -1 clockwise, 0 on a line. Exact as long as no product of two
// coordinates overflows or underflows.
int orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

}  // namespace lodestone::base_complex
