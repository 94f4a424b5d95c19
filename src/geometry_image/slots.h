// SPDX-License-Identifier: MIT
// Where every chart, and every quad of it, stands among the leaves of the hierarchy.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "lodestone/geometry_image/chart_order.h"
#include "lodestone/geometry_image/slot_tree.h"
#include "lodestone/layout/atlas.h"

namespace lodestone::geometry_image {

// Gives every chart its block. Where some are mapped, by place (slot_tree.h). Else large nodes before small
// ones, so that each starts at a multiple of its size without a gap; those of one size in the given order.
// Charts of half a node are neighbours two by two, and such a pair stands among the charts of its size; one
// that is left over comes behind those a size below. `boxes` has one a chart; it may be empty where there is
// only one chart. Returns the number of slots. Throws Error(bad_input), naming `subject`, where they are more
// than the tree has.
uint64_t assign_slots(std::vector<layout::ChartRecord>& charts, const std::vector<ChartBox>& boxes,
                      ChartOrder order, const std::string& subject);

// The leaves' level: the lowest d >= 1 with 4^d >= slots.
uint32_t tree_depth(uint64_t slots);

// Entry of the leaf map for slot `slot` of a chart, counted from the start of its block.
glm::uvec2 leaf_entry(const layout::ChartRecord& chart, uint32_t slot);

std::vector<glm::uvec2> make_leaf_map(const std::vector<layout::ChartRecord>& charts, uint64_t slots);

}  // namespace lodestone::geometry_image
