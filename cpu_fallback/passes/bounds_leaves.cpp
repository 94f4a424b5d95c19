// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/bounds.h"
#include "lodestone/layout/frame.h"

namespace lodestone::cpu_fallback {
namespace {

using layout::Bound;

template <class Probe>
class BoundsLeaves : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const Bound c0 = bound_leaf(4 * index), c1 = bound_leaf(4 * index + 1), c2 = bound_leaf(4 * index + 2),
                c3 = bound_leaf(4 * index + 3);
    const Bound parent = layout::join(layout::join(c0, c1), layout::join(c2, c3));
    const uint32_t address = layout::level_base(push_.depth - 1) + index;
    this->store(nodes_lo_, address, as_bits(parent.lo, layout::child_order(c0, c1, c2, c3)));
    this->store(nodes_hi_, address, as_bits(parent.hi, 0));
  }

 private:
  Bound bound_leaf(uint32_t slot) {
    Bound bound = layout::empty_bound();
    uint32_t texel = layout::empty_slot, stride = 0;
    if (slot < push_.count) {
      texel = this->load(leaf_map_, 2 * uint64_t(slot));
      stride = this->load(leaf_map_, 2 * uint64_t(slot) + 1);
    }
    if (texel != layout::empty_slot) {
      bound = layout::quad_bound(
          as_vec3(this->load(geometry_, texel)), as_vec3(this->load(geometry_, texel + 1)),
          as_vec3(this->load(geometry_, texel + stride)), as_vec3(this->load(geometry_, texel + stride + 1)));
    }
    if (slot < push_.written) {
      const uint32_t address = layout::level_base(push_.depth) + slot;
      this->store(nodes_lo_, address, as_bits(bound.lo, layout::leaf_flag | texel));
      this->store(nodes_hi_, address, as_bits(bound.hi, stride));
    }
    return bound;
  }

  Words leaf_map_ = this->words(0);
  Quads geometry_ = this->quads(1), nodes_lo_ = this->quads(2), nodes_hi_ = this->quads(3);
  layout::BoundsPush push_ = this->template push<layout::BoundsPush>();
};

}  // namespace

void bounds_leaves(const CpuDispatch& dispatch) {
  run_pass<BoundsLeaves>(dispatch, 1024);
}

}  // namespace lodestone::cpu_fallback
