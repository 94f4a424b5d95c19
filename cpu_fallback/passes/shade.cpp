// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/recursion.h"
#include "lodestone/layout/shading.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/shade.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/environment_kernel-inl.h"
#include "lodestone/cpu_fallback/varying/surface_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe, uint32_t source_count, bool is_layered>
class Shade : public EnvironmentKernel<SurfaceKernel<Probe, source_count, is_layered>, 24> {
 public:
  explicit Shade(const CpuDispatch& dispatch)
      : EnvironmentKernel<SurfaceKernel<Probe, source_count, is_layered>, 24>(dispatch) {
    if (push_.vertex != 0) this->stand_for(this->words(27).words + 1);
  }

  HWY_ATTR void operator()() {
    const uvec4 hit = this->load_own(this->hits), along = this->load_own(rays_, 2, 1);
    const vec3 direction = as_vec3(along);
    vec3 emitted(0.0f, 0.0f, 0.0f);
    if (const Where missed(*this, hit.w == no_index); missed.any()) {
      emitted = this->environment_radiance(direction);
    }
    const uint recursion = this->constant(3);
    this->scattered = push_.vertex != 0;
    Branch branch = first_branch();
    if (recursion != recursion_none && push_.vertex != 0) branch = stored_branch(this->load_own(paths_));
    vec1 alpha = 0.0f;
    uvec4 contribution(0u, 0u, 0u, 0u), shadow_from = contribution;
    uvec4 shadow_along(0u, 0u, 0u, floatBitsToUint(vec1(-1.0f)));
    if (const Where here(*this, hit.w != no_index); here.any()) {
      const Surface surface = this->surface_of(hit, direction);
      if (recursion != recursion_none && is_layered) {
        const vec3 passed = branch.throughput * transmittance(surface, uintBitsToFloat(hit.x));
        branch.throughput = select(this->active(), passed, branch.throughput);
      }
      emitted = select(this->active(), emitted_radiance(surface), emitted);
      alpha = select(this->active(), 1.0f, alpha);
      const vec2 xi = this->draw(push_, sky_pair(push_.vertex, push_.light));
      const LightRecord& source = lights_[push_.light];
      const Traced traced = traced_lobes(recursion, surface, branch.depth < push_.last_vertex);
      LightSample light = source.kind == light_sky ? this->sample_sky(surface, xi, traced)
                                                   : sample_light(source, surface, traced);
      if (recursion != recursion_none) light.radiance = light.radiance * branch.throughput;
      const bvec1 lit = this->active() && dot3(light.direction, surface.geometric) > 0.0f &&
                        max_component(light.radiance) > 0.0f;
      const Ray shadow = leaving_ray(surface, light.direction, 1.0f, light.distance);
      contribution = select(lit, as_bits(light.radiance, 0u), contribution);
      shadow_from = select(lit, as_bits(shadow.origin, floatBitsToUint(shadow.tmin)), shadow_from);
      shadow_along = select(lit, as_bits(shadow.direction, floatBitsToUint(shadow.tmax)), shadow_along);
    }
    this->store_own(contributions_, contribution);
    this->store_own(shadow_rays_, shadow_from, 2);
    this->store_own(shadow_rays_, shadow_along, 2, 1);
    if (push_.light != 0) return;
    const vec4 none(0.0f, 0.0f, 0.0f, 0.0f);
    if (recursion != recursion_none) emitted = emitted * branch.throughput;
    vec4 sum(emitted.x, emitted.y, emitted.z, push_.vertex == 0 ? alpha : vec1(0.0f));
    sum = select(uintBitsToFloat(along.w) < 0.0f, none, sum);
    if (push_.first == 0) sum = sum + as_vec4(this->load_own(radiance_));
    this->store_own(radiance_, as_bits(sum));
  }

 private:
  Quads rays_ = this->quads(19);
  Structs<LightRecord> lights_ = this->template structs<LightRecord>(20);
  Quads contributions_ = this->quads(21), shadow_rays_ = this->quads(22), radiance_ = this->quads(23);
  Quads paths_ = this->quads(26);
  RayPush push_ = this->template push<RayPush>();
};

LODESTONE_LAYERED_SURFACE_BLOCK_FUNCTION(shade, Shade)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(shade_block);

void shade(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 512, HWY_DYNAMIC_DISPATCH(shade_block));
}

}  // namespace lodestone::cpu_fallback
#endif
