// SPDX-License-Identifier: MIT
#include "lodestone/layout/links.h"

#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/atlas.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class Links : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const uint32_t address = layout::level_base(push_.depth) + index;
    uint32_t hit = 4 * address + 1;
    if (push_.depth == push_.leaf_depth) hit = layout::leaf_flag | this->load(leaf_map_, 2 * uint64_t(index));
    this->store(links_, 2 * uint64_t(address), hit);
    this->store(links_, 2 * uint64_t(address) + 1, miss(index));
  }

 private:
  // The next node that holds a quad and is no descendant; 0: none.
  uint32_t miss(uint32_t index) {
    uint32_t depth = push_.depth;
    uint32_t next = index + 1;
    for (;;) {
      const auto up = static_cast<uint32_t>(layout::findLSB(next)) >> 1;
      if (up >= depth) return 0;
      const uint32_t place = next >> (2 * up);
      depth -= up;
      if (place << (2 * (push_.leaf_depth - depth)) >= push_.slots) return 0;
      if (depth != push_.leaf_depth || this->load(leaf_map_, 2 * uint64_t(place)) != layout::empty_slot) {
        return layout::level_base(depth) + place;
      }
      next = place + 1;
    }
  }

  Words leaf_map_ = this->words(0), links_ = this->words(1);
  layout::LinksPush push_ = this->template push<layout::LinksPush>();
};

}  // namespace

void links(const CpuDispatch& dispatch) {
  run_pass<Links>(dispatch, 4096);
}

}  // namespace lodestone::cpu_fallback
