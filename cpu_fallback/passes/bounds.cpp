// SPDX-License-Identifier: MIT
#include "lodestone/layout/bounds.h"
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/bounds.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/bound_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Bounds : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  HWY_ATTR void operator()(uint32_t index) {
    if (push_.written_above == 0) {
      if (index < push_.written) bound_parent(index);
      return;
    }
    const BoundLanes p0 = bound_parent(4 * index), p1 = bound_parent(4 * index + 1),
                     p2 = bound_parent(4 * index + 2), p3 = bound_parent(4 * index + 3);
    store_node(2, index, p0, p1, p2, p3);
  }

 private:
  HWY_ATTR BoundLanes load_bound(uint32_t index) {
    if (index >= push_.count) return empty_bound();
    const uint32_t address = push_.first_node + layout::level_base(push_.depth) + index;
    return {load_lanes(this->loaded(nodes_lo_, address)), load_lanes(this->loaded(nodes_hi_, address))};
  }

  HWY_ATTR BoundLanes bound_parent(uint32_t index) {
    const BoundLanes c0 = load_bound(4 * index), c1 = load_bound(4 * index + 1),
                     c2 = load_bound(4 * index + 2), c3 = load_bound(4 * index + 3);
    if (index < push_.written) return store_node(1, index, c0, c1, c2, c3);
    return join(join(c0, c1), join(c2, c3));
  }

  // The parent of c0 to c3, `levels` above the level that was read.
  HWY_ATTR BoundLanes store_node(uint32_t levels, uint32_t index, const BoundLanes& c0, const BoundLanes& c1,
                                 const BoundLanes& c2, const BoundLanes& c3) {
    const BoundLanes node = join(join(c0, c1), join(c2, c3));
    const uint32_t address = push_.first_node + layout::level_base(push_.depth - levels) + index;
    store_lanes(node.lo, child_order(c0, c1, c2, c3), this->stored(nodes_lo_, address));
    store_lanes(node.hi, 0, this->stored(nodes_hi_, address));
    return node;
  }

  Quads nodes_lo_ = this->quads(0), nodes_hi_ = this->quads(1);
  layout::BoundsPush push_ = this->template push<layout::BoundsPush>();
};

LODESTONE_BLOCK_FUNCTION(HWY_ATTR, bounds, Bounds)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(bounds_block);

void bounds(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, HWY_DYNAMIC_DISPATCH(bounds_block));
}

}  // namespace lodestone::cpu_fallback
#endif
