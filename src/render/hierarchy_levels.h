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

inline constexpr uint32_t wide_fan = 16, wide_node_bytes = 192;

// The same tree two levels at a time, as the CPU's `wide` sees it (cpu_fallback/passes/wide_nodes.h):
// child c of record r is record 16 r + 1 + c. The children of the last level's records are the leaves; where
// the depth is odd the root record has the 4 nodes of level 1.
class WideLevels {
 public:
  WideLevels(uint32_t depth, uint32_t slots) : levels_(depth, slots), count_((depth + 1) / 2) {}

  uint32_t count() const { return count_; }
  // The level of the tree that the records of level `k` have their children on, and how many those are.
  uint32_t child_level(uint32_t k) const { return levels_.depth() - 2 * (count_ - 1 - k); }
  uint32_t children(uint32_t k) const { return levels_.places(child_level(k)); }
  uint32_t records(uint32_t k) const { return (children(k) + wide_fan - 1) / wide_fan; }
  static uint32_t first(uint32_t k) { return static_cast<uint32_t>(((uint64_t(1) << (4 * k)) - 1) / 15); }
  uint32_t end() const { return first(count_ - 1) + records(count_ - 1); }

 private:
  HierarchyLevels levels_;
  uint32_t count_;
};

}  // namespace lodestone::render
