// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/shading.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/ambient.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/surface_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe, uint32_t source_count>
class Ambient : public SurfaceKernel<Probe, source_count> {
 public:
  using SurfaceKernel<Probe, source_count>::SurfaceKernel;

  HWY_ATTR void operator()() {
    const uvec4 hit = this->load_own(this->hits), along = this->load_own(rays_, 2, 1);
    const vec4 none(0.0f, 0.0f, 0.0f, 0.0f);
    vec4 added(1.0f, 1.0f, 1.0f, 0.0f);
    vec1 contribution = 0.0f;
    Ray shadow = no_ray();
    if (const Where here(*this, hit.w != no_index); here.any()) {
      const Surface surface = this->surface_of(hit, as_vec3(along));
      const vec3 outward = cosine_direction(surface.normal, this->draw(push_, pair_ambient));
      const bvec1 open = this->active() && dot3(outward, surface.geometric) > 0.0f;
      shadow = select(open, leaving_ray(surface, outward, 1.0f, push_.distance), shadow);
      contribution = select(open, 1.0f, contribution);
      added = select(this->active(), vec4(0.0f, 0.0f, 0.0f, 1.0f), added);
    }
    added = select(uintBitsToFloat(along.w) < 0.0f, none, added);
    this->store_own(contributions_, as_bits(vec3(contribution, contribution, contribution), 0u));
    this->store_own(shadow_rays_, as_bits(shadow.origin, floatBitsToUint(shadow.tmin)), 2);
    this->store_own(shadow_rays_, as_bits(shadow.direction, floatBitsToUint(shadow.tmax)), 2, 1);
    if (push_.first == 0) added = added + as_vec4(this->load_own(radiance_));
    this->store_own(radiance_, as_bits(added));
  }

 private:
  Quads rays_ = this->quads(19), contributions_ = this->quads(20), shadow_rays_ = this->quads(21),
        radiance_ = this->quads(22);
  AmbientPush push_ = this->template push<AmbientPush>();
};

LODESTONE_SURFACE_BLOCK_FUNCTION(ambient, Ambient)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(ambient_block);

void ambient(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 512, HWY_DYNAMIC_DISPATCH(ambient_block));
}

}  // namespace lodestone::cpu_fallback
#endif
