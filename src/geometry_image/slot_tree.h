// SPDX-License-Identifier: MIT
// Places in the hierarchy for charts of unequal sizes that lie here and there on a surface: what is near in
// space is near in the tree, whatever its size.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lodestone::geometry_image {

struct ChartBox {
  glm::vec3 lo{0}, hi{0};  // finite

  glm::vec3 center() const { return 0.5f * lo + 0.5f * hi; }
};

struct Block {
  uint64_t first_slot = 0, slots = 0;  // a power of 2 of them, which the first is a multiple of
};

// One block for each chart, together all slots from 0 on without a gap: at most a quarter more than the
// charts need, and the tree not deeper. Parts of the tree are split where that makes boxes and slots least
// (the surface area heuristic), among the splits that powers of 2 allow; a chart that is alone in a part gets
// all of it. `needed` are the slots that each chart fills, powers of 2. Empty where the largest chart is more
// than an eighth of all, so that it would leave no choice.
std::vector<Block> slots_by_place(const std::vector<uint64_t>& needed, const std::vector<ChartBox>& boxes);

}  // namespace lodestone::geometry_image
