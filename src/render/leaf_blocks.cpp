// SPDX-License-Identifier: MIT
#include "lodestone/render/leaf_blocks.h"

#include <optional>

#include "lodestone/layout/atlas.h"

namespace lodestone::render {
namespace {

constexpr uint32_t group_slots = 16, block_side = 4;

std::optional<glm::uvec4> find_block(std::span<const glm::uvec2> leaf_map, uint32_t group) {
  const auto slot = [&](uint32_t x, uint32_t y) {
    const uint64_t place =
        uint64_t(group_slots) * group + (layout::spread_bits(x) | layout::spread_bits(y) << 1);
    return place < leaf_map.size() ? leaf_map[place] : glm::uvec2(layout::empty_slot, 0);
  };
  const auto is_quad = [&](uint32_t x, uint32_t y) { return slot(x, y).x != layout::empty_slot; };
  uint32_t width = 0, height = 0;
  while (width < block_side && is_quad(width, 0)) ++width;
  while (height < block_side && is_quad(0, height)) ++height;
  const glm::uvec2 first = slot(0, 0);
  for (uint32_t y = 0; y < block_side; ++y) {
    for (uint32_t x = 0; x < block_side; ++x) {
      const bool inside = x < width && y < height;
      if (is_quad(x, y) != inside) return {};
      if (inside && slot(x, y) != glm::uvec2(first.x + x + y * first.y, first.y)) return {};
    }
  }
  if (width == 0) return glm::uvec4(group, 0, 0, 0);
  return glm::uvec4(group, first.x, first.y, width | height << 8);
}

}  // namespace

LeafBlocks find_leaf_blocks(std::span<const glm::uvec2> leaf_map, const HierarchyLevels& levels) {
  LeafBlocks found;
  if (levels.depth() < 2) return found;
  for (uint32_t group = 0; group < levels.places(levels.depth() - 2); ++group) {
    if (const auto block = find_block(leaf_map, group)) {
      found.blocks.push_back(*block);
    } else {
      found.others.push_back(group);
    }
  }
  return found;
}

std::vector<glm::uvec4> sixteen_slots(std::span<const glm::uvec2> leaf_map) {
  std::vector<glm::uvec4> groups((leaf_map.size() + group_slots - 1) / group_slots, glm::uvec4(0));
  for (uint32_t group = 0; group < groups.size(); ++group) {
    if (const auto block = find_block(leaf_map, group)) groups[group] = {1, block->y, block->z, block->w};
  }
  return groups;
}

}  // namespace lodestone::render
