// SPDX-License-Identifier: MIT
// How many samples each patch of a base complex gets, within a budget for all.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/geometry_image/arc_errors.h"
#include "lodestone/geometry_image/chart_profile.h"

namespace lodestone::geometry_image {

struct ChartSize {
  uint32_t width = 1, height = 1;  // quads
  // Of each passage of the cell how many segments of its side belong to it, at least 1.
  std::vector<uint32_t> segments;

  uint64_t texels() const { return uint64_t(width + 1) * (height + 1); }
};

struct Quads {
  uint32_t width = 0, height = 0;  // 0: open
  bool operator==(const Quads&) const = default;
};

// What is to be small everywhere: how far charts are expected to be from the surface. That is `share` of the
// profile's error, but at least `flattest` and at most `roughest` times the spacing of the samples: so flat
// charts get samples too, and a chart whose error does not fall does not take them all. Both equal: even
// spacing. Of arcs it is at least `flattest` times the length of a segment and their own error, of which for
// arcs that are not firm only `share` counts.
struct Need {
  double flattest = 1, roughest = 1, share = 1;
  // One a chart, or empty: of a chart that has been found to be farther from the surface than expected, how
  // far, by the spacing of the samples; else 0. Counts where it is more, and arcs of such a chart count in
  // full.
  std::vector<double> found;
  std::vector<Quads> fixed;           // one a chart, or empty: where not open, the chart's size
  std::vector<double> chart_weights;  // one a chart, or empty: all 1. The expected error is multiplied by it
};

// Makes one side of the chart in greatest need longer, again and again, while the texels of all are at most
// `budget`: by one quad up to 8, then to the next power of 2. A side has at least a segment for each of its
// arcs, even where that takes more than the budget.
// Segments of a side go where arcs are in greatest need: by length, and firm arcs by how far they would be
// from their samples.
std::vector<ChartSize> choose_sizes(const base_complex::BaseComplex& complex,
                                    const std::vector<ChartProfile>& profiles, const ArcErrors& arc_errors,
                                    const Need& need, uint64_t budget);

// The texels of all where each side has a segment for each of its arcs and no more.
uint64_t least_texels(const base_complex::BaseComplex& complex);

// How wide and how high a cell's rectangle is: of the cell's area, and as much wider than high as its sides
// are.
glm::dvec2 extent_of(const base_complex::BaseComplex& complex, const base_complex::Cell& cell);

// Of each arc the number of its segments: as many as the coarsest of the charts beside it has there. Finer
// charts snap their samples to these.
std::vector<uint32_t> arc_segments(const base_complex::BaseComplex& complex,
                                   const std::vector<ChartSize>& sizes);

}  // namespace lodestone::geometry_image
