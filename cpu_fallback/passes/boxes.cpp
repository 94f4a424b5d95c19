// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/boxes.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class Boxes : public BoxesKernel<Probe> {
 public:
  using BoxesKernel<Probe>::BoxesKernel;

  void operator()(uint32_t index) {
    if (this->push_.written_above == 0) {
      if (index < this->push_.written) bound_record(index);
    } else if (index < this->push_.written_above) {
      const layout::Box parents[4] = {bound_record(4 * index), bound_record(4 * index + 1),
                                      bound_record(4 * index + 2), bound_record(4 * index + 3)};
      this->store_record(boxes_, this->push_.depth - 2, index, parents);
    }
  }

 private:
  layout::Box load_box(uint32_t index) {
    if (index >= this->push_.count) return layout::empty_box();
    const uint64_t record =
        3 * (uint64_t(this->push_.first_node) + layout::level_base(this->push_.depth) + index);
    return layout::record_box(this->load(boxes_, record), this->load(boxes_, record + 1),
                              this->load(boxes_, record + 2));
  }

  layout::Box bound_record(uint32_t index) {
    const layout::Box children[4] = {load_box(4 * index), load_box(4 * index + 1), load_box(4 * index + 2),
                                     load_box(4 * index + 3)};
    if (index >= this->push_.written) return this->join(children);
    return this->store_record(boxes_, this->push_.depth - 1, index, children);
  }

  Quads boxes_ = this->quads(0);
};

LODESTONE_BLOCK_FUNCTION(static, boxes, Boxes)

}  // namespace

void boxes(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, boxes_block);
}

}  // namespace lodestone::cpu_fallback
