// SPDX-License-Identifier: MIT
// What the host knows of trees of 16-bit boxes (shaders/layout/boxes.h).
#pragma once

#include <algorithm>

#include "lodestone/layout/boxes.h"
#include "lodestone/render/hierarchy_levels.h"
#include "lodestone/scene/pose.h"

namespace lodestone::render {

// A flat axis gets a thousandth of the largest one. Rounded outwards, all planes stay below 65535.
inline layout::BoxGrid make_grid(const scene::Bounds& box) {
  const glm::vec3 size = box.hi - box.lo;
  const float largest = std::max(layout::max_component(size), 1e-30f);
  layout::BoxGrid grid{};
  grid.base = box.lo;
  grid.step = glm::max(size, glm::vec3(largest * 0x1p-10f)) * (1.0f / 65000);
  return grid;
}

// The largest absolute coordinate of a box.
inline float extent_of(const scene::Bounds& box) {
  return std::max(layout::largest_abs(box.lo), layout::largest_abs(box.hi));
}

// Blocks of slots write four records each, also those past the last slot.
inline uint64_t box_records(const HierarchyLevels& levels) {
  const uint32_t depth = levels.depth();
  const uint64_t last_level = depth >= 2 ? 4 * uint64_t(levels.places(depth - 2)) : 1;
  return layout::level_base(depth - 1) + last_level;
}

}  // namespace lodestone::render
