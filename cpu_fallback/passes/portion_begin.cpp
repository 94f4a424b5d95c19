// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/portion.h"
#include "lodestone/layout/trace.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class PortionBegin : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const layout::Ray ray = layout::stored_ray(this->load(rays_, 2 * uint64_t(index)),
                                               this->load(rays_, 2 * uint64_t(index) + 1));
    uvec4 state(0, 0, layout::trace_unfinished, layout::no_index);
    bool begins = !(ray.tmax < 0.0f);
    if (push_.restarted != 0) {
      state = this->load(states_, index);
      begins = layout::trace_status(state) == layout::trace_restart;
      if (begins) state = uvec4(0, 0, layout::trace_unfinished, this->load(hits_, index).w + 1);
    }
    if (!begins && layout::trace_status(state) != layout::trace_judged) state.z = layout::trace_finished;
    this->store(states_, index, state);
    if (begins || push_.restarted == 0) {
      const uvec4 miss(layout::floatBitsToUint(ray.tmax), 0, 0, layout::no_index);
      this->store(hits_, index, miss);
      this->store(found_hits_, index, miss);
    }
    if (push_.restarted == 0) {
      if (this->constant(1) != 0) this->store(steps_, index, 0);
      if (begins) this->probe.ray();
    }
  }

 private:
  Quads rays_ = this->quads(0), hits_ = this->quads(1), states_ = this->quads(2);
  Words steps_ = this->words(3);
  Quads found_hits_ = this->quads(4);
  layout::PortionPush push_ = this->template push<layout::PortionPush>();
};

LODESTONE_BLOCK_FUNCTION(static, portion_begin, PortionBegin)

}  // namespace

void portion_begin(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 1024, portion_begin_block);
}

}  // namespace lodestone::cpu_fallback
