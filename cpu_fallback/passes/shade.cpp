// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/surface_kernel.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;
using glm::vec3;
using glm::vec4;
using layout::floatBitsToUint;
using layout::uintBitsToFloat;

template <class Probe>
class Shade : public SurfaceKernel<Probe> {
 public:
  using SurfaceKernel<Probe>::SurfaceKernel;

  void operator()(uint32_t index) {
    const uvec4 hit = this->load(this->hits, index);
    const uvec4 along = this->load(rays_, 2 * uint64_t(index) + 1);
    const layout::FrameRecord& frame = this->frames[0];
    const vec3 direction = as_vec3(along);
    vec3 emitted = layout::sky_radiance(frame, direction);
    float alpha = 0;
    uvec4 contribution(0), shadow_from(0), shadow_along(0, 0, 0, floatBitsToUint(-1.0f));
    if (hit.w != layout::no_index) {
      const auto point = this->locate(hit.w, uintBitsToFloat(hit.y), uintBitsToFloat(hit.z));
      const layout::Surface surface = this->surface_at(point, direction);
      emitted = surface.emission;
      alpha = 1;
      uint32_t px = 0, py = 0;
      layout::ray_pixel(push_.first_ray + index, frame.width, frame.height, px, py);
      const glm::vec2 xi = layout::sample_2d(frame.seed, py * frame.width + px, push_.sample_index,
                                             layout::pair_sky + push_.light);
      const layout::LightSample light = layout::sample_light(lights_[push_.light], frame, surface, xi);
      if (layout::dot3(light.direction, surface.geometric) > 0.0f &&
          layout::max_component(light.radiance) > 0.0f) {
        const layout::Ray shadow = layout::shadow_ray(surface, light);
        contribution = as_bits(light.radiance, 0);
        shadow_from = as_bits(shadow.origin, floatBitsToUint(shadow.tmin));
        shadow_along = as_bits(shadow.direction, floatBitsToUint(shadow.tmax));
      }
    }
    this->store(contributions_, index, contribution);
    this->store(shadow_rays_, 2 * uint64_t(index), shadow_from);
    this->store(shadow_rays_, 2 * uint64_t(index) + 1, shadow_along);
    if (push_.light != 0) return;
    vec4 sum(emitted, alpha);
    if (uintBitsToFloat(along.w) < 0.0f) sum = vec4(0);
    if (push_.first == 0) sum = sum + as_vec4(this->load(radiance_, index));
    this->store(radiance_, index, as_bits(sum));
  }

 private:
  Quads rays_ = this->quads(16);
  Structs<layout::LightRecord> lights_ = this->template structs<layout::LightRecord>(17);
  Quads contributions_ = this->quads(18), shadow_rays_ = this->quads(19), radiance_ = this->quads(20);
  layout::RayPush push_ = this->template push<layout::RayPush>();
};

}  // namespace

void shade(const CpuDispatch& dispatch) {
  run_pass<Shade>(dispatch, 512);
}

}  // namespace lodestone::cpu_fallback
