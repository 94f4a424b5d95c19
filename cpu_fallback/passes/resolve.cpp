// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/shading.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/resolve.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Resolve : public VaryingKernel<Probe> {
 public:
  using VaryingKernel<Probe>::VaryingKernel;

  HWY_ATTR void operator()() {
    const uvec1 index = this->own_index();
    const FrameRecord& frame = frames_[0];
    uvec1 px, py;
    const bvec1 inside = ray_pixel(push_.first_ray + index, frame.width, frame.height, px, py);
    const Where here(*this, inside);
    const vec4 mean = as_vec4(this->load_own(radiance_)) / static_cast<float>(frame.spp);
    const vec3 seen = display_color(frame, vec3(mean.x, mean.y, mean.z));
    const uvec1 pixel = py * frame.width + px;
    this->store(beauty_, pixel, as_bits(mean));
    this->store(display_, pixel, as_bits(seen, floatBitsToUint(mean.w)));
  }

 private:
  Structs<FrameRecord> frames_ = this->template structs<FrameRecord>(0);
  Quads radiance_ = this->quads(1), beauty_ = this->quads(2), display_ = this->quads(3);
  ResolvePush push_ = this->template push<ResolvePush>();
};

LODESTONE_VARYING_BLOCK_FUNCTION(resolve, Resolve)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(resolve_block);

void resolve(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 2048, HWY_DYNAMIC_DISPATCH(resolve_block));
}

}  // namespace lodestone::cpu_fallback
#endif
