// SPDX-License-Identifier: MIT
// Where the samples of an arc lie.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/base_complex.h"

namespace lodestone::base_complex {

// The distances from the arc's first point, 0 to its length, of `segments` + 1 samples, ascending: evenly
// spaced, but that samples first go to the points where the arc bends most (D. H. Douglas and T. K. Peucker,
// 1973). So a corner of a boundary or a crease stays a corner. Of arcs that are not firm only what is across
// the surface counts as a bend, and only clear ones.
std::vector<double> arc_places(const BaseComplex& complex, uint32_t arc, uint32_t segments);

// How far, at most, points of the arc are from the polyline through those samples; across the surface where
// the arc is not firm.
double arc_error(const BaseComplex& complex, uint32_t arc, uint32_t segments);

}  // namespace lodestone::base_complex
