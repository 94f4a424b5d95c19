// SPDX-License-Identifier: MIT
#include "lodestone/layout/camera.h"
#include "lodestone/cpu_fallback/passes/passes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/camera.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Camera : public VaryingKernel<Probe> {
 public:
  using VaryingKernel<Probe>::VaryingKernel;

  HWY_ATTR void operator()() {
    const uvec1 index = this->own_index();
    const Ray ray =
        camera_ray(frames_[0], push_.first_ray + index, push_.sample_index, push_.centered, push_.pinhole);
    this->store_own(rays_, as_bits(ray.origin, floatBitsToUint(ray.tmin)), 2);
    this->store_own(rays_, as_bits(ray.direction, floatBitsToUint(ray.tmax)), 2, 1);
  }

 private:
  Structs<FrameRecord> frames_ = this->template structs<FrameRecord>(0);
  Quads rays_ = this->quads(1);
  RayPush push_ = this->template push<RayPush>();
};

LODESTONE_VARYING_BLOCK_FUNCTION(camera, Camera)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(camera_block);

void camera(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 2048, HWY_DYNAMIC_DISPATCH(camera_block));
}

}  // namespace lodestone::cpu_fallback
#endif
