// SPDX-License-Identifier: MIT
// The order in which the blocks of charts of one size follow one another. The tree over them is implicit (a
// node has the next four nodes below it, four of four above that), so the order alone decides how tight its
// boxes are.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace lodestone::geometry_image {

enum class ChartOrder : uint32_t {
  // Split along the longest axis near the middle, again and again, always where subtrees meet.
  median,
  // Along a Hilbert curve. On meshes of one triangle a chart the boxes of the median order have 12 to 42 %
  // less
  // area.
  hilbert
};

struct ChartCenter {
  glm::vec3 center{0};
  uint32_t chart = 0;
};

// Orders a run of blocks of `block` slots each, a power of 2; the first stands at `first_slot`, a multiple of
// that. Neither the order in which they are given nor the number of threads shows. Centers must be finite,
// charts different.
void order_charts(std::span<ChartCenter> run, uint64_t first_slot, uint64_t block, ChartOrder order);

// For a run of `count` > 1 such blocks: after how many to split it. A border of the largest subtrees that the
// run spans, the one nearest to the middle. Where two blocks are a node, those of one node part last.
uint64_t aligned_split(uint64_t first_slot, uint64_t block, uint64_t count);

// Place on the 3D Hilbert curve of 2^bits cells a side (bits at most 21); coordinates below 2^bits.
uint64_t hilbert_index(glm::uvec3 cell, uint32_t bits);

}  // namespace lodestone::geometry_image
