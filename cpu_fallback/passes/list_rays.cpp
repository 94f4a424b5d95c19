// SPDX-License-Identifier: MIT
#include <algorithm>

#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/ray_list.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class ListRays : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t block) {
    const uint64_t begin = uint64_t(block) * push_.block;
    const uint64_t end = std::min<uint64_t>(begin + push_.block, push_.count);
    if (begin >= end) return;
    uint32_t place = lists_ ? this->load(block_starts_, block) : 0;
    uint32_t wanted = 0;
    for (uint64_t i = begin; i < end; ++i) {
      const uint64_t index = among_ ? this->load(some_, i + 1) : i;
      layout::Ray ray = layout::no_ray();
      uvec4 hit(0), state(0);
      if (resume_ == layout::resume_nothing) {
        const uvec4 from = this->load(rays_, 2 * index), along = this->load(rays_, 2 * index + 1);
        ray = layout::stored_ray(from, along);
      } else if (resume_ == layout::resume_unanswered) {
        hit = this->load(hits_, index);
      } else {
        state = this->load(states_, index);
      }
      const bool goes = layout::ray_is_wanted(ray, hit, state, resume_);
      if (lists_ && goes) this->store(list_, uint64_t(place) + wanted + 1, static_cast<uint32_t>(index));
      if (lists_ && !goes) pass_over(index, ray.tmax);
      wanted += goes ? 1 : 0;
    }
    if (!lists_) block_counts_.store1(block, wanted);
  }

 private:
  void pass_over(uint64_t i, float tmax) {
    if (ending_) {
      this->store(shadow_rays_, 2 * i + 1, {0, 0, 0, layout::floatBitsToUint(-1.0f)});
      return;
    }
    if (resume_ == layout::resume_nothing) this->store(hits_, i, as_bits({tmax, 0, 0}, layout::no_index));
    if (resume_ != layout::resume_states && resumable_)
      this->store(states_, i, {0, 0, layout::trace_finished, layout::no_index});
  }

  Quads rays_ = this->quads(0), hits_ = this->quads(1), states_ = this->quads(2);
  Words block_counts_ = this->words(3), block_starts_ = this->words(4), some_ = this->words(5),
        list_ = this->words(6);
  Quads shadow_rays_ = this->quads(7);
  layout::ListPush push_ = this->template push<layout::ListPush>();
  bool lists_ = this->constant(0) == layout::list_place;
  uint32_t resume_ = this->constant(1);
  bool resumable_ = this->constant(2) != 0, among_ = this->constant(3) != 0, ending_ = this->constant(4) != 0;
};

LODESTONE_BLOCK_FUNCTION(static, list_rays, ListRays)

}  // namespace

void list_rays(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 64, list_rays_block);
}

}  // namespace lodestone::cpu_fallback
