// SPDX-License-Identifier: MIT
// What the passes that make records of boxes share (shaders/geometry_image/boxes.glsl).
#pragma once

#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/boxes.h"

namespace lodestone::cpu_fallback {

void boxes_blocks(const CpuDispatch& dispatch);

template <class Probe>
class BoxesKernel : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

 protected:
  // Record `index`, of a node of level `depth`. Returns what holds its boxes.
  layout::Box store_record(Quads boxes, uint32_t depth, uint32_t index, const layout::Box (&c)[4]) {
    const uint64_t record = 3 * (uint64_t(push_.first_node) + layout::level_base(depth) + index);
    for (int axis = 0; axis < 3; ++axis) {
      this->store(boxes, record + static_cast<uint64_t>(axis),
                  layout::pack_planes(c[0].lo[axis], c[1].lo[axis], c[2].lo[axis], c[3].lo[axis],
                                      c[0].hi[axis], c[1].hi[axis], c[2].hi[axis], c[3].hi[axis]));
    }
    return join(c);
  }

  static layout::Box join(const layout::Box (&c)[4]) {
    return layout::join_boxes(layout::join_boxes(c[0], c[1]), layout::join_boxes(c[2], c[3]));
  }

  layout::BoxesPush push_ = this->template push<layout::BoxesPush>();
};

}  // namespace lodestone::cpu_fallback
