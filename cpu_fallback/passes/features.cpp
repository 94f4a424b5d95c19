// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/denoise.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/features.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/surface_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe, uint32_t source_count>
class Features : public SurfaceKernel<Probe, source_count> {
 public:
  using SurfaceKernel<Probe, source_count>::SurfaceKernel;

  HWY_ATTR void operator()() {
    const uvec4 hit = this->load_own(this->hits);
    vec4 tint(1.0f, 1.0f, 1.0f, 0.0f), normal(0.0f, 0.0f, 0.0f, 0.0f), position = normal;
    if (const Where here(*this, hit.w != no_index); here.any()) {
      const Surface surface = this->surface_of(hit, as_vec3(this->load_own(rays_, 2, 1)));
      const vec3 dimmed = push_.tinted == 0 ? vec3(1.0f, 1.0f, 1.0f) : demodulator(surface.albedo);
      const vec3 from_camera = surface.position - this->frames[0].origin;
      tint = select(this->active(), with_w(dimmed, 1.0f), tint);
      normal = select(this->active(), with_w(surface.normal, 0.0f), normal);
      position = select(this->active(), with_w(from_camera, 0.0f), position);
    }
    if (push_.first == 0) {
      tint = tint + as_vec4(this->load_own(features_, 3));
      normal = normal + as_vec4(this->load_own(features_, 3, 1));
      position = position + as_vec4(this->load_own(features_, 3, 2));
    }
    this->store_own(features_, as_bits(tint), 3);
    this->store_own(features_, as_bits(normal), 3, 1);
    this->store_own(features_, as_bits(position), 3, 2);
  }

 private:
  HWY_ATTR static vec4 with_w(const vec3& v, vec1 w) { return {v.x, v.y, v.z, w}; }

  Quads rays_ = this->quads(19), features_ = this->quads(20);
  FeaturesPush push_ = this->template push<FeaturesPush>();
};

LODESTONE_SURFACE_BLOCK_FUNCTION(features, Features)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(features_block);

void features(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 512, HWY_DYNAMIC_DISPATCH(features_block));
}

}  // namespace lodestone::cpu_fallback
#endif
