// SPDX-License-Identifier: MIT
#include "lodestone/layout/camera.h"

#include "lodestone/cpu_fallback/passes/passes.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class Camera : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const layout::Ray ray =
        layout::camera_ray(frames_[0], push_.first_ray + index, push_.sample_index, push_.centered);
    this->store(rays_, 2 * uint64_t(index), as_bits(ray.origin, layout::floatBitsToUint(ray.tmin)));
    this->store(rays_, 2 * uint64_t(index) + 1, as_bits(ray.direction, layout::floatBitsToUint(ray.tmax)));
  }

 private:
  Structs<layout::FrameRecord> frames_ = this->template structs<layout::FrameRecord>(0);
  Quads rays_ = this->quads(1);
  layout::RayPush push_ = this->template push<layout::RayPush>();
};

}  // namespace

void camera(const CpuDispatch& dispatch) {
  run_pass<Camera>(dispatch, 2048);
}

}  // namespace lodestone::cpu_fallback
