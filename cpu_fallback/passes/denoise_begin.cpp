// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/denoise.h"
#include "lodestone/layout/shading.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/denoise_begin.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Begin : public VaryingKernel<Probe> {
 public:
  using VaryingKernel<Probe>::VaryingKernel;

  HWY_ATTR void operator()() {
    const FrameRecord& frame = frames_[0];
    uvec1 px, py;
    const Where inside(*this,
                       ray_pixel(push_.first_ray + this->own_index(), frame.width, frame.height, px, py));
    const auto samples = static_cast<float>(frame.spp);
    const PixelFeatures pixel =
        pixel_features(as_vec4(this->load_own(features_, 3)), as_vec3(this->load_own(features_, 3, 1)),
                       as_vec3(this->load_own(features_, 3, 2)), samples);
    const PixelLight mean = pixel_light(as_vec3(this->load_own(radiance_)),
                                        as_vec3(this->load_own(moments_, 2)), pixel.tint, samples);
    const uvec1 place = py * frame.width + px;
    this->store(guides_, place, as_bits(pixel.tint, floatBitsToUint(mean.valid)), 3);
    this->store(guides_, place, as_bits(pixel.normal, floatBitsToUint(pixel.coverage)), 3, 1);
    this->store(guides_, place, as_bits(pixel.position, 0u), 3, 2);
    this->store(light_, place, as_bits(mean.color, floatBitsToUint(mean.variance)));
  }

 private:
  Structs<FrameRecord> frames_ = this->template structs<FrameRecord>(0);
  Quads radiance_ = this->quads(1), features_ = this->quads(2), moments_ = this->quads(3),
        guides_ = this->quads(4), light_ = this->quads(5);
  ResolvePush push_ = this->template push<ResolvePush>();
};

LODESTONE_VARYING_BLOCK_FUNCTION(denoise_begin, Begin)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(denoise_begin_block);

void denoise_begin(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 2048, HWY_DYNAMIC_DISPATCH(denoise_begin_block));
}

}  // namespace lodestone::cpu_fallback
#endif
