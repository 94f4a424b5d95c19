// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/portion.h"
#include "lodestone/layout/trace.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class PortionEnter : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const uvec4 from = this->load(rays_, 2 * uint64_t(index)), state = this->load(states_, index),
                hit = this->load(hits_, index);
    uvec4 along = this->load(rays_, 2 * uint64_t(index) + 1);
    const layout::Ray ray = layout::stored_ray(from, along);
    const layout::Slabs slabs = layout::make_slabs(ray, push_.extent);
    const bool enters = layout::trace_status(state) == layout::trace_unfinished &&
                        layout::slab_enter(slabs, push_.lo, push_.hi, ray.tmin) <=
                            layout::slab_exit(slabs, push_.lo, push_.hi, layout::uintBitsToFloat(hit.x));
    if (enters) std::atomic_ref<uint32_t>(wanted_.words[0]).store(1, std::memory_order_relaxed);
    if (enters) {
      along.w = hit.x;
      this->store(local_rays_, 2 * uint64_t(index), from);
      this->store(local_rays_, 2 * uint64_t(index) + 1, along);
      this->store(
          local_states_, index,
          uvec4(0, 0, layout::trace_restart, push_.runs != 0 ? local_primitive(state.w) : layout::no_index));
    } else {
      this->store(local_states_, index, uvec4(0, 0, layout::trace_finished, layout::no_index));
      this->store(local_hits_, index, uvec4(0, 0, 0, layout::no_index));
    }
    if (this->constant(1) != 0) this->store(local_steps_, index, 0);
  }

 private:
  // The first primitive of the portion that is not before one of the whole.
  uint32_t local_primitive(uint32_t primitive) {
    if (primitive == layout::no_index) return layout::no_index;
    const uint32_t texel = primitive >> 1;
    uint32_t first = 0, end = push_.runs;
    while (first < end) {
      const uint32_t middle = (first + end) >> 1;
      if (this->load(runs_, 2 * uint64_t(middle) + 1) <= texel) {
        first = middle + 1;
      } else {
        end = middle;
      }
    }
    if (first == 0) return 0;
    const uint32_t local = this->load(runs_, 2 * uint64_t(first) - 2),
                   whole = this->load(runs_, 2 * uint64_t(first) - 1),
                   behind = this->load(runs_, 2 * uint64_t(first)), place = local + (texel - whole);
    return place < behind ? 2 * place + (primitive & 1) : 2 * behind;
  }

  Quads rays_ = this->quads(0), hits_ = this->quads(1), states_ = this->quads(2);
  Words runs_ = this->words(3);
  Quads local_rays_ = this->quads(4), local_states_ = this->quads(5), local_hits_ = this->quads(6);
  Words local_steps_ = this->words(7), wanted_ = this->words(8);
  layout::PortionPush push_ = this->template push<layout::PortionPush>();
};

LODESTONE_BLOCK_FUNCTION(static, portion_enter, PortionEnter)

}  // namespace

void portion_enter(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 1024, portion_enter_block);
}

}  // namespace lodestone::cpu_fallback
