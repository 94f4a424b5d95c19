// SPDX-License-Identifier: MIT
// Boxes round charts, by which these are put in order.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "lodestone/geometry_image/slot_tree.h"
#include "lodestone/layout/atlas.h"

namespace lodestone::geometry_image {

// Round the triangles that each chart samples. `positions`: of the vertices that `triangles` name.
std::vector<ChartBox> chart_boxes(const std::vector<glm::uvec4>& triangles,
                                  const std::vector<glm::vec3>& positions,
                                  const std::vector<layout::ChartRecord>& charts,
                                  const std::vector<glm::uvec4>& texel_map);

}  // namespace lodestone::geometry_image
