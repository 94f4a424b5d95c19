// SPDX-License-Identifier: MIT
// Which sixteen slots of the leaf map are neighbouring quads of a chart, so that their bounds can be had from
// few texels.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lodestone/render/hierarchy_levels.h"

namespace lodestone::render {

struct LeafBlocks {
  // Slots 16 g to 16 g + 15 are, in Morton order, the quads of w x h <= 4 x 4 from texel t on in rows of
  // `stride` texels, and nothing else: { g, t, stride, w | h << 8 }; w = h = 0: no quads.
  std::vector<glm::uvec4> blocks;
  std::vector<uint32_t> others;  // numbers of all other groups
};

// Of the groups above which `levels` writes records.
LeafBlocks find_leaf_blocks(std::span<const glm::uvec2> leaf_map, const HierarchyLevels& levels);

// The same for every sixteen slots there are, one after the other: { 1, t, stride, w | h << 8 } of a block,
// all zero of other groups.
std::vector<glm::uvec4> sixteen_slots(std::span<const glm::uvec2> leaf_map);

}  // namespace lodestone::render
