// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/denoise.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/denoise_filter.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/denoise_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Filter : public DenoiseKernel<Probe> {
 public:
  using DenoiseKernel<Probe>::DenoiseKernel;

  HWY_ATTR void operator()() {
    const auto level = this->filtered_light(this->own_x(), this->own_y());
    this->store_own(this->filtered, as_bits(level.color, floatBitsToUint(level.variance)));
  }
};

LODESTONE_VARYING_BLOCK_FUNCTION(denoise_filter, Filter)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(denoise_filter_block);

void denoise_filter(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, HWY_DYNAMIC_DISPATCH(denoise_filter_block));
}

}  // namespace lodestone::cpu_fallback
#endif
