// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_boxes.h"

#include <cmath>
#include <limits>

#include "lodestone/base/parallel.h"
#include "lodestone/geometry_image/charts.h"

namespace lodestone::geometry_image {
namespace {

ChartBox box_of(const std::vector<glm::uvec4>& triangles, const std::vector<glm::vec3>& positions,
                const layout::ChartRecord& chart, const std::vector<glm::uvec4>& texel_map) {
  glm::vec3 lo(std::numeric_limits<float>::infinity()), hi = -lo;
  const auto include = [&](uint32_t triangle) {
    for (glm::length_t corner = 0; corner < 3; ++corner) {
      lo = glm::min(lo, positions[triangles[triangle][corner]]);
      hi = glm::max(hi, positions[triangles[triangle][corner]]);
    }
  };
  if (chart.kind == layout::chart_mapped) {
    for (uint64_t i = 0; i < texel_count(chart); ++i) include(texel_map[chart.first_texel + i].x);
  } else {
    for (uint64_t i = 0; i < triangle_count(chart); ++i)
      include(static_cast<uint32_t>(chart.first_triangle + i));
  }
  // A transform may overflow; where the chart is put then does not matter, but numbers must have an order.
  for (glm::length_t axis = 0; axis < 3; ++axis)
    if (!std::isfinite(lo[axis]) || !std::isfinite(hi[axis])) lo[axis] = hi[axis] = 0;
  return {lo, hi};
}

}  // namespace

std::vector<ChartBox> chart_boxes(const std::vector<glm::uvec4>& triangles,
                                  const std::vector<glm::vec3>& positions,
                                  const std::vector<layout::ChartRecord>& charts,
                                  const std::vector<glm::uvec4>& texel_map) {
  constexpr uint64_t grain = 1u << 10;
  std::vector<ChartBox> boxes(charts.size());
  parallel_for(boxes.size(), grain, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) boxes[i] = box_of(triangles, positions, charts[i], texel_map);
  });
  return boxes;
}

}  // namespace lodestone::geometry_image
