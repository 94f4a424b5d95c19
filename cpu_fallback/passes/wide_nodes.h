// SPDX-License-Identifier: MIT
// The hierarchy as the CPU's `wide` sees it: each record holds the 16 grandchildren of a node, planes side by
// side, in 16 bits each, so that one step reads three cache lines and no vector has to be transposed.
//
// Records form a 16-ary tree: child c of record r is record 16 r + 1 + c, and the last level's children are
// the leaves. Where the tree's depth is odd the root record has the 4 nodes of level 1 (render::WideLevels).
// Planes are steps of the object's grid (layout/boxes.h), rounded outwards: a ray that enters a node's bound
// enters that of its record, never the other way round. What a hit is, the quad's own bound decides
// (layout/trace.h).
#pragma once

#include <cstdint>

#include "lodestone/cpu_fallback/kernel.h"
#include "lodestone/render/hierarchy_levels.h"

namespace lodestone::cpu_fallback {

using render::wide_fan;

struct alignas(64) WideNode {
  uint16_t planes[3][2][wide_fan];  // [axis][0: low, 1: high][child]; low > high: no such child
};
static_assert(sizeof(WideNode) == render::wide_node_bytes);

// How many levels of records are made at once, from the leaves up: one of the highest of them a task.
inline constexpr uint32_t wide_levels_at_once = 3, wide_records_a_task = wide_fan * wide_fan;

// The pass, an invocation a record above leaves: all records of one hierarchy, the first of which is
// BoxesPush::first_node, from the geometry image; `count`: leaf slots. Buffer 2 says which quads are below
// each of those records (render::sixteen_slots).
void wide_nodes(const CpuDispatch& dispatch);

}  // namespace lodestone::cpu_fallback
