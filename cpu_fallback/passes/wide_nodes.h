// SPDX-License-Identifier: MIT
// A copy of the hierarchy's bounds for the CPU's single rays: each record holds the 16 grandchildren of a
// node, planes side by side, in 16 bits each, so that one step reads three cache lines and no vector has to
// be transposed.
//
// Records form a 16-ary tree: child c of record r is record 16 r + 1 + c, and the last level's children are
// the leaves. Where the tree's depth is odd the root record has the 4 nodes of level 1 (render::WideLevels).
// Planes are steps of a grid over the root's bound, rounded outwards: a ray that enters a node's bound enters
// that of its record, never the other way round. What a hit is, the quad's own bound decides
// (layout/trace.h).
#pragma once

#include <algorithm>
#include <cstdint>

#include "lodestone/cpu_fallback/kernel.h"
#include "lodestone/layout/arithmetic.h"
#include "lodestone/render/hierarchy_levels.h"

namespace lodestone::cpu_fallback {

using render::wide_fan;

struct alignas(64) WideNode {
  uint16_t planes[3][2][wide_fan];  // [axis][0: low, 1: high][child]; low > high: no such child
};
static_assert(sizeof(WideNode) == render::wide_node_bytes);

// A plane q stands for base + q * step.
struct WideGrid {
  glm::vec4 base, step{0, 0, 0, 0};  // w: 0

  // `lo`, `hi`: bound of the whole hierarchy. A flat axis gets a thousandth of the largest one, so that an
  // empty child, whose low plane is 65535 and whose high plane is 0, is empty along every axis.
  WideGrid(const glm::vec3& lo, const glm::vec3& hi) : base(lo, 0) {
    const glm::vec3 size = hi - lo;
    const float largest = std::max(layout::max_component(size), 1e-30f);
    for (int axis = 0; axis < 3; ++axis) {
      step[axis] = std::max(size[axis], largest * 0x1p-10f) * (1.0f / 65000);  // rounding stays below 65535
    }
  }
};

// The pass: all records of one hierarchy, from nodes_lo and nodes_hi (layout::BoundsPush: depth, count: leaf
// slots, and where it begins).
void wide_nodes(const CpuDispatch& dispatch);

}  // namespace lodestone::cpu_fallback
