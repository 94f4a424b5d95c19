// SPDX-License-Identifier: MIT
// Which charts there are and which point of the surface each of their texels samples.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/geometry_image/triangle_survey.h"
#include "lodestone/layout/atlas.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

// Throws Error(bad_input), naming the mesh, unless its grids are as scene.h says and cover its triangles.
void check_grids(const scene::Scene& scene, const scene::Mesh& mesh);

// Charts in the order of the triangles: one a grid of the placements that `as_grid` names, one a triangle
// that the survey keeps of the others. Slots are not assigned yet. Throws Error(bad_input) where they need
// 2^31 texels or more.
std::vector<layout::ChartRecord> make_charts(const scene::Scene& scene, const scene::Assembly& assembly,
                                             const TriangleSurvey& survey, const std::vector<bool>& as_grid);

inline uint64_t texel_count(const layout::ChartRecord& chart) {
  return uint64_t(chart.width) * chart.height;
}
inline uint64_t quad_count(const layout::ChartRecord& chart) {
  return uint64_t(chart.width - 1) * (chart.height - 1);
}
// Input triangles that a chart stands for, one after the other from its first; none is its own where each
// texel says which it samples.
inline uint64_t triangle_count(const layout::ChartRecord& chart) {
  if (chart.kind == layout::chart_mapped) return 0;
  return chart.kind == layout::chart_exact ? 1 : 2 * quad_count(chart);
}

// What the charts are: all grid, all exact, or automatic: anything else.
AtlasKind kind_of(const std::vector<layout::ChartRecord>& charts);

// Entry of the texel map for sample (x, y) of a grid or exact chart.
glm::uvec4 texel_entry(const layout::ChartRecord& chart, uint32_t chart_index, uint32_t x, uint32_t y);

// The whole texel map of such charts. They must follow one another without gaps.
std::vector<glm::uvec4> make_texel_map(const std::vector<layout::ChartRecord>& charts);

}  // namespace lodestone::geometry_image
