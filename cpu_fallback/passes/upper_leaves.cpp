// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/boxes.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class UpperLeaves : public BoxesKernel<Probe> {
 public:
  using BoxesKernel<Probe>::BoxesKernel;

  void operator()(uint32_t index) {
    const layout::Box children[4] = {leaf_box(4 * index), leaf_box(4 * index + 1), leaf_box(4 * index + 2),
                                     leaf_box(4 * index + 3)};
    this->store_record(boxes_, this->push_.depth - 1, index, children);
  }

 private:
  layout::Box leaf_box(uint32_t leaf) {
    if (leaf >= this->push_.count) return layout::empty_box();
    const uint32_t instance = this->load(keys_, 2 * uint64_t(leaf) + 1);
    const glm::vec3 lo = as_vec3(this->load(instance_lo_, instance)),
                    hi = as_vec3(this->load(instance_hi_, instance));
    if (!(lo.x <= hi.x)) return layout::empty_box();
    return layout::bound_box(lo, hi, this->push_.grid, per_step_);
  }

  Words keys_ = this->words(0);
  Quads instance_lo_ = this->quads(1), instance_hi_ = this->quads(2), boxes_ = this->quads(3);
  glm::vec3 per_step_ = glm::vec3(1, 1, 1) / this->push_.grid.step;
};

LODESTONE_BLOCK_FUNCTION(static, upper_leaves, UpperLeaves)

}  // namespace

void upper_leaves(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, upper_leaves_block);
}

}  // namespace lodestone::cpu_fallback
