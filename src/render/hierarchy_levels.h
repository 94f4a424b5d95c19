// SPDX-License-Identifier: MIT
// How many nodes each level of the hierarchy has in memory; shaders/layout/atlas.h has the addresses.
#pragma once

#include <algorithm>
#include <cstdint>

#include "lodestone/layout/atlas.h"

namespace lodestone::render {

class HierarchyLevels {
 public:
  HierarchyLevels(uint32_t depth, uint32_t slots) : depth_(depth), slots_(slots) {}

  uint32_t depth() const { return depth_; }
  uint32_t slots() const { return slots_; }

  // Places of a level that are written: those above a slot in use, and their siblings.
  uint32_t places(uint32_t level) const {
    const uint32_t shift = 2 * (depth_ - level);
    const uint64_t used = (uint64_t(slots_) + (uint64_t(1) << shift) - 1) >> shift;
    return static_cast<uint32_t>(std::min<uint64_t>(uint64_t(1) << (2 * level), (used + 3) / 4 * 4));
  }

  uint64_t nodes() const { return uint64_t(layout::level_base(depth_)) + places(depth_); }

 private:
  uint32_t depth_, slots_;
};

}  // namespace lodestone::render
