// SPDX-License-Identifier: MIT
// How many samples each patch of a base complex gets: sides of 2^a and 2^b quads, so that its MIP pyramid is
// full, within a budget for all.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/geometry_image/chart_profile.h"

namespace lodestone::geometry_image {

struct ChartSize {
  ChartPowers powers;
  // Of each passage of the cell how many segments of its side belong to it, at least 1.
  std::vector<uint32_t> segments;

  uint32_t width() const { return 1u << powers.width; }  // quads
  uint32_t height() const { return 1u << powers.height; }
  uint64_t texels() const { return uint64_t(width() + 1) * (height() + 1); }
};

// What is to be small everywhere: the error, but counted as at least `flattest` and at most `roughest` times
// the spacing of the samples, times the chart's own weight. So flat charts get samples too, and a chart whose
// error does not fall does not take them all. Both equal: even spacing.
struct Need {
  double flattest = 1, roughest = 1;
  std::vector<double> chart_weights;  // one a chart, or empty: all 1
};

// Doubles one side of the chart in greatest need, again and again, while the texels of all are at most
// `budget`. A side has at least a segment for each of its arcs, even where that takes more than the budget.
std::vector<ChartSize> choose_sizes(const base_complex::BaseComplex& complex,
                                    const std::vector<ChartProfile>& profiles, const Need& need,
                                    uint64_t budget);

// How wide and how high a cell's rectangle is: of the cell's area, and as much wider than high as its sides
// are.
glm::dvec2 extent_of(const base_complex::BaseComplex& complex, const base_complex::Cell& cell);

// Of each arc the number of its segments: as many as the coarsest of the charts beside it has there. Finer
// charts snap their samples to these.
std::vector<uint32_t> arc_segments(const base_complex::BaseComplex& complex,
                                   const std::vector<ChartSize>& sizes);

}  // namespace lodestone::geometry_image
