// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/shading.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class Resolve : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const layout::FrameRecord& frame = frames_[0];
    uint32_t px = 0, py = 0;
    if (!layout::ray_pixel(push_.first_ray + index, frame.width, frame.height, px, py)) return;
    const glm::vec4 mean = as_vec4(this->load(radiance_, index)) / static_cast<float>(frame.spp);
    const glm::vec3 seen = layout::display_color(frame, glm::vec3(mean));
    const uint64_t pixel = uint64_t(py) * frame.width + px;
    this->store(beauty_, pixel, as_bits(mean));
    this->store(display_, pixel, as_bits(seen, layout::floatBitsToUint(mean.w)));
  }

 private:
  Structs<layout::FrameRecord> frames_ = this->template structs<layout::FrameRecord>(0);
  Quads radiance_ = this->quads(1), beauty_ = this->quads(2), display_ = this->quads(3);
  layout::ResolvePush push_ = this->template push<layout::ResolvePush>();
};

}  // namespace

void resolve(const CpuDispatch& dispatch) {
  run_pass<Resolve>(dispatch, 2048);
}

}  // namespace lodestone::cpu_fallback
