// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/atlas.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/accumulate.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Accumulate : public VaryingKernel<Probe> {
 public:
  explicit Accumulate(const CpuDispatch& dispatch) : VaryingKernel<Probe>(dispatch) {
    if (this->constant(0) != 0) this->stand_for(this->words(3).words + 1);
  }

  HWY_ATTR void operator()() {
    const uvec4 hit = this->load_own(shadow_hits_);
    const Where unblocked(*this, hit.w == no_index);
    if (!unblocked.any()) return;
    const uvec4 contribution = this->load_own(contributions_), before = this->load_own(radiance_);
    this->store_own(radiance_, as_bits(as_vec3(before) + as_vec3(contribution), before.w));
  }

 private:
  Quads shadow_hits_ = this->quads(0), contributions_ = this->quads(1), radiance_ = this->quads(2);
};

LODESTONE_VARYING_BLOCK_FUNCTION(accumulate, Accumulate)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(accumulate_block);

void accumulate(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 4096, HWY_DYNAMIC_DISPATCH(accumulate_block));
}

}  // namespace lodestone::cpu_fallback
#endif
