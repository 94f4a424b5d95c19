// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/denoise.h"
#include "lodestone/layout/shading.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/denoise_end.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class End : public VaryingKernel<Probe> {
 public:
  using VaryingKernel<Probe>::VaryingKernel;

  HWY_ATTR void operator()() {
    const uvec4 guide = this->load_own(guides_, 3), filtered = this->load_own(light_),
                before = this->load_own(noisy_);
    const bvec1 valid = uintBitsToFloat(guide.w) != 0.0f;
    const uvec4 color = select(valid, as_bits(as_vec3(filtered) * as_vec3(guide), before.w), before);
    this->store_own(beauty_, color);
    this->store_own(display_, as_bits(display_color(frames_[0], as_vec3(color)), before.w));
  }

 private:
  Structs<FrameRecord> frames_ = this->template structs<FrameRecord>(0);
  Quads guides_ = this->quads(1), light_ = this->quads(2), noisy_ = this->quads(3), beauty_ = this->quads(4),
        display_ = this->quads(5);
};

LODESTONE_VARYING_BLOCK_FUNCTION(denoise_end, End)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(denoise_end_block);

void denoise_end(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 2048, HWY_DYNAMIC_DISPATCH(denoise_end_block));
}

}  // namespace lodestone::cpu_fallback
#endif
