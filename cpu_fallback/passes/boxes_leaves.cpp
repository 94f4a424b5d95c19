// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/boxes.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class BoxesLeaves : public BoxesKernel<Probe> {
 public:
  using BoxesKernel<Probe>::BoxesKernel;

  void operator()(uint32_t index) {
    if (this->push_.depth == 1) {
      if (index < this->push_.written) bound_record(index);
    } else if (index < this->push_.written_above) {
      const uint32_t group = this->load(groups_, this->push_.first_item + index);
      const layout::Box parents[4] = {bound_record(4 * group), bound_record(4 * group + 1),
                                      bound_record(4 * group + 2), bound_record(4 * group + 3)};
      this->store_record(boxes_, this->push_.depth - 2, group, parents);
    }
  }

 private:
  layout::Bound bound_quad(uint64_t texel, uint32_t stride) {
    return layout::quad_bound(
        as_vec3(this->load(geometry_, texel)), as_vec3(this->load(geometry_, texel + 1)),
        as_vec3(this->load(geometry_, texel + stride)), as_vec3(this->load(geometry_, texel + stride + 1)));
  }

  layout::Box bound_leaf(uint32_t slot) {
    if (slot >= this->push_.count) return layout::empty_box();
    const uint64_t entry = 2 * (uint64_t(this->push_.first_slot) + slot);
    const uint32_t texel = this->load(leaf_map_, entry), stride = this->load(leaf_map_, entry + 1);
    if (texel == layout::empty_slot) return layout::empty_box();
    layout::Bound bound = bound_quad(uint64_t(this->push_.image) + texel, stride);
    if (moving_) bound = layout::join(bound, bound_quad(uint64_t(this->push_.next_image) + texel, stride));
    return layout::bound_box(bound.lo, bound.hi, this->push_.grid, per_step_);
  }

  layout::Box bound_record(uint32_t index) {
    const layout::Box children[4] = {bound_leaf(4 * index), bound_leaf(4 * index + 1),
                                     bound_leaf(4 * index + 2), bound_leaf(4 * index + 3)};
    if (index >= this->push_.written) return this->join(children);
    return this->store_record(boxes_, this->push_.depth - 1, index, children);
  }

  Words leaf_map_ = this->words(0);
  Quads geometry_ = this->quads(1), boxes_ = this->quads(2);
  Words groups_ = this->words(3);
  bool moving_ = this->constant(0) != 0;
  glm::vec3 per_step_ = glm::vec3(1, 1, 1) / this->push_.grid.step;
};

LODESTONE_BLOCK_FUNCTION(static, boxes_leaves, BoxesLeaves)

}  // namespace

void boxes_leaves(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, boxes_leaves_block);
}

}  // namespace lodestone::cpu_fallback
