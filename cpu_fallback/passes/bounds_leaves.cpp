// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/bounds.h"
#include "lodestone/layout/frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/bounds_leaves.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/bound_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class BoundsLeaves : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  HWY_ATTR void operator()(uint32_t index) {
    const BoundLanes c0 = bound_leaf(4 * index), c1 = bound_leaf(4 * index + 1),
                     c2 = bound_leaf(4 * index + 2), c3 = bound_leaf(4 * index + 3);
    const BoundLanes parent = join(join(c0, c1), join(c2, c3));
    const uint32_t address = push_.first_node + layout::level_base(push_.depth - 1) + index;
    store_lanes(parent.lo, child_order(c0, c1, c2, c3), this->stored(nodes_lo_, address));
    store_lanes(parent.hi, 0, this->stored(nodes_hi_, address));
  }

 private:
  HWY_ATTR BoundLanes bound_quad(uint64_t texel, uint32_t stride) {
    const Lanes4 a = load_lanes(this->loaded(geometry_, texel)),
                 b = load_lanes(this->loaded(geometry_, texel + 1)),
                 c = load_lanes(this->loaded(geometry_, texel + stride)),
                 e = load_lanes(this->loaded(geometry_, texel + stride + 1));
    return {min(min(a, b), min(c, e)), max(max(a, b), max(c, e))};
  }

  HWY_ATTR BoundLanes bound_leaf(uint32_t slot) {
    BoundLanes bound = empty_bound();
    uint32_t texel = layout::empty_slot, stride = 0;
    if (slot < push_.count) {
      const uint64_t entry = 2 * (uint64_t(push_.first_slot) + slot);
      texel = this->load(leaf_map_, entry);
      stride = this->load(leaf_map_, entry + 1);
    }
    if (texel != layout::empty_slot) {
      bound = bound_quad(uint64_t(push_.image) + texel, stride);
      if (moving_) bound = join(bound, bound_quad(uint64_t(push_.next_image) + texel, stride));
    }
    if (slot < push_.written) {
      const uint32_t address = push_.first_node + layout::level_base(push_.depth) + slot;
      store_lanes(bound.lo, layout::leaf_flag | texel, this->stored(nodes_lo_, address));
      store_lanes(bound.hi, stride, this->stored(nodes_hi_, address));
    }
    return bound;
  }

  Words leaf_map_ = this->words(0);
  Quads geometry_ = this->quads(1), nodes_lo_ = this->quads(2), nodes_hi_ = this->quads(3);
  layout::BoundsPush push_ = this->template push<layout::BoundsPush>();
  bool moving_ = this->constant(0) != 0;
};

LODESTONE_BLOCK_FUNCTION(HWY_ATTR, bounds_leaves, BoundsLeaves)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(bounds_leaves_block);

void bounds_leaves(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 1024, HWY_DYNAMIC_DISPATCH(bounds_leaves_block));
}

}  // namespace lodestone::cpu_fallback
#endif
