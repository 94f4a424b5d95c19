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
    const FrameRecord& frame = frames_[0];
    CameraAxes axes = HWY_NAMESPACE::camera_axes(frame);  // not that of layout
    if (frame.segments != 0) {
      const vec1 time = shutter_time(frame, push_.first_ray + index, push_.sample_index, push_.instant);
      this->store(times_, index, floatBitsToUint(time));
      const Moment moment = moment_of(time, frame.segments);
      vec3* const axis[] = {&axes.origin,  &axes.right,      &axes.up,
                            &axes.forward, &axes.lens_right, &axes.lens_up};
      for (uint32_t i = 0; i < camera_quads; ++i) {
        const uvec1 at = moment.segment * camera_quads + i;
        *axis[i] = moved3(as_vec3(this->load(cameras_, at)), as_vec3(this->load(cameras_, at + camera_quads)),
                          moment.fraction);
      }
    }
    const Ray ray =
        camera_ray(frame, axes, push_.first_ray + index, push_.sample_index, push_.centered, push_.pinhole);
    this->store_own(rays_, as_bits(ray.origin, floatBitsToUint(ray.tmin)), 2);
    this->store_own(rays_, as_bits(ray.direction, floatBitsToUint(ray.tmax)), 2, 1);
  }

 private:
  Structs<FrameRecord> frames_ = this->template structs<FrameRecord>(0);
  Quads rays_ = this->quads(1), cameras_ = this->quads(2);
  Words times_ = this->words(3);
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
