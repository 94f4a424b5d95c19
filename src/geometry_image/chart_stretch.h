// SPDX-License-Identifier: MIT
// The L2 stretch of whole charts, over the surface's area in the rest pose.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/cell_map.h"
#include "lodestone/base_complex/stretch.h"

namespace lodestone::geometry_image {

struct StretchedFace {
  double stretch, area;
};

// A chart's faces that have an area, and how many quads it has.
struct ChartStretch {
  std::vector<StretchedFace> faces;
  uint64_t quads = 0;

  // The root mean square over the area, for the best width and height of the rectangle: 1 for an isometry
  // up to those, more where samples are closer in one place than in another.
  double unevenness = 1;
};

// `rest` are the shapes of the map's faces in the rest pose, whatever the map was made for.
ChartStretch chart_stretch(const base_complex::CellMap& map,
                           const std::vector<base_complex::TriangleShape>& rest, uint64_t quads);

struct StretchSummary {
  double mean = 0, high = 0;  // as in AtlasReport
};
StretchSummary sum_up(const std::vector<ChartStretch>& charts);

}  // namespace lodestone::geometry_image
