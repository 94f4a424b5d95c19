// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/objects.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class UpperLeaves : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const layout::Bound c0 = bound_leaf(4 * index), c1 = bound_leaf(4 * index + 1),
                        c2 = bound_leaf(4 * index + 2), c3 = bound_leaf(4 * index + 3);
    const layout::Bound parent = layout::join(layout::join(c0, c1), layout::join(c2, c3));
    const uint32_t address = layout::level_base(push_.depth - 1) + index;
    this->store(upper_lo_, address, as_bits(parent.lo, layout::child_order(c0, c1, c2, c3)));
    this->store(upper_hi_, address, as_bits(parent.hi, 0));
  }

 private:
  layout::Bound bound_leaf(uint32_t leaf) {
    layout::Bound bound = layout::empty_bound();
    uint32_t instance = layout::empty_slot;
    if (leaf < push_.instances) {
      instance = this->load(keys_, 2 * uint64_t(leaf) + 1);
      bound = {as_vec3(this->load(instance_lo_, instance)), as_vec3(this->load(instance_hi_, instance))};
    }
    const uint32_t address = layout::level_base(push_.depth) + leaf;
    this->store(upper_lo_, address, as_bits(bound.lo, layout::leaf_flag | instance));
    this->store(upper_hi_, address, as_bits(bound.hi, 0));
    return bound;
  }

  Words keys_ = this->words(0);
  Quads instance_lo_ = this->quads(1), instance_hi_ = this->quads(2);
  Quads upper_lo_ = this->quads(3), upper_hi_ = this->quads(4);
  layout::UpperPush push_ = this->template push<layout::UpperPush>();
};

LODESTONE_BLOCK_FUNCTION(static, upper_leaves, UpperLeaves)

}  // namespace

void upper_leaves(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, upper_leaves_block);
}

}  // namespace lodestone::cpu_fallback
