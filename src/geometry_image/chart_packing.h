// SPDX-License-Identifier: MIT
// Charts side by side in one picture. The tracer needs none: its charts are runs of texels in one long array.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lodestone::geometry_image {

struct ChartPacking {
  uint32_t width = 0, height = 0;  // of the picture
  std::vector<glm::uvec2> places;  // of each chart's first texel: column and row
  double filled = 0;               // the share of the picture that charts are
};

// Places rectangles of these sizes (at least 1 x 1; their cells, gutter included, fewer than 2^32 texels in
// all) as they are, not turned, in a picture that is as nearly square as they allow, with `gutter` texels at
// least between any two of them and none around them all. Equal sizes give equal places.
ChartPacking pack_charts(const std::vector<glm::uvec2>& sizes, uint32_t gutter = 1);

}  // namespace lodestone::geometry_image
