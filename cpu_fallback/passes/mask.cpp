// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/shading.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/mask.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/surface_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe, uint32_t source_count>
class Mask : public SurfaceKernel<Probe, source_count> {
 public:
  using SurfaceKernel<Probe, source_count>::SurfaceKernel;

  HWY_ATTR void operator()() {
    const uvec4 hit = this->load_own(this->hits);
    const Where hit_something(*this, hit.w != no_index);
    if (!hit_something.any()) return;
    const Where unjudged(*this, trace_status(this->load_own(states_)) != trace_judged);
    if (!unjudged.any()) return;
    const bvec1 cut_out = is_cut_out(hit);
    if (const Where here(*this, cut_out); here.any()) {
      uvec4 from = this->load_own(rays_, 2);
      from.w = hit.x;
      this->store_own(rays_, from, 2);
      this->store_own(states_, uvec4(0u, this->placed_by(), trace_restart, hit.w + 1u));
      this->add(pending_, 0, this->active_count());
    }
    const Where here(*this, !cut_out);
    this->store_own(states_, uvec4(0u, 0u, trace_judged, no_index));
  }

 private:
  HWY_ATTR bvec1 is_cut_out(const uvec4& hit) {
    bvec1 cut_out = false;
    const auto point = this->locate_hit(hit);
    this->for_each_part(point, [&](const PartRecord&, const MaterialRecord& material) HWY_ATTR {
      if (material.alpha_mask == 0) return;
      const vec4 color = this->base_color_at(material, point, this->texcoords_at(point));
      cut_out = cut_out || (this->active() && color.w < material.alpha_cutoff);
    });
    return cut_out;
  }

  Quads rays_ = this->quads(19), states_ = this->quads(20);
  Words pending_ = this->words(21);
};

LODESTONE_SURFACE_BLOCK_FUNCTION(mask, Mask)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(mask_block);

void mask(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 512, HWY_DYNAMIC_DISPATCH(mask_block));
}

}  // namespace lodestone::cpu_fallback
#endif
