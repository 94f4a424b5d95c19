// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/denoise.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/denoise_moments.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Moments : public VaryingKernel<Probe> {
 public:
  using VaryingKernel<Probe>::VaryingKernel;

  HWY_ATTR void operator()() {
    const uvec4 now = this->load_own(radiance_);
    vec3 added = as_vec3(now), squares(0.0f, 0.0f, 0.0f);
    if (push_.first == 0) {
      added = added - as_vec3(this->load_own(moments_, 2, 1));
      squares = as_vec3(this->load_own(moments_, 2));
    }
    this->store_own(moments_, as_bits(squares + flush_lost3(added * added), 0u), 2);
    this->store_own(moments_, now, 2, 1);
  }

 private:
  Quads radiance_ = this->quads(0), moments_ = this->quads(1);
  MomentsPush push_ = this->template push<MomentsPush>();
};

LODESTONE_VARYING_BLOCK_FUNCTION(denoise_moments, Moments)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(denoise_moments_block);

void denoise_moments(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 4096, HWY_DYNAMIC_DISPATCH(denoise_moments_block));
}

}  // namespace lodestone::cpu_fallback
#endif
