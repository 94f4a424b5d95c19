// SPDX-License-Identifier: MIT
// Charts of a resampled surface (section 3.1 of the paper): patches of a base complex, each mapped onto a
// rectangle and sampled at its lattice points.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/layout/atlas.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

struct MappedCharts {
  std::vector<layout::ChartRecord> charts;  // first_texel counts from the first of them
  std::vector<glm::uvec4> texels;           // as in the texel map; charts numbered from 0
  ChartMaps maps;                           // where they are to be kept
  std::vector<uint32_t> left_out;           // triangles that have to become exact charts, ascending
  uint64_t repeated_texels = 0;
  double mean_stretch = 0, high_stretch = 0;  // as in AtlasReport
};

// Charts for the listed triangles (ascending, each of three different welded vertices), in the order of their
// first triangle. Of a connected surface either all triangles are mapped or all are left out.
MappedCharts map_charts(const scene::Scene& scene, const scene::Assembly& assembly,
                        const std::vector<uint32_t>& welded, std::vector<uint32_t> triangles,
                        const ChartSettings& settings, const OnStage& on_stage);

}  // namespace lodestone::geometry_image
