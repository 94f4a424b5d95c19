// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/shading.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/aov.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/varying/surface_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe, uint32_t source_count>
class Aov : public SurfaceKernel<Probe, source_count> {
 public:
  using SurfaceKernel<Probe, source_count>::SurfaceKernel;

  HWY_ATTR void operator()() {
    const uvec1 index = this->own_index();
    const FrameRecord& frame = this->frames[0];
    uvec1 px, py;
    const Where inside(*this, ray_pixel(push_.first_ray + index, frame.width, frame.height, px, py));
    const uvec4 hit = this->load_own(this->hits);
    const uvec1 visited = this->load(steps_, index);
    const uvec1 pixel = py * frame.width + px;
    uvec4 first(0x7f800000u, 0u, 0u, 0u), second(0u, 0u, 0u, 0u), third(0u, 0u, no_index, no_index);
    vec1 level = 0.0f;
    if (const Where here(*this, hit.w != no_index); here.any()) {
      const vec3 direction = as_vec3(this->load_own(rays_, 2, 1));
      const auto point = this->locate_hit(hit);
      level = select(this->active(), this->detail_of(hit.w, point), level);
      this->for_each_part(point, [&](const PartRecord& part, const MaterialRecord& material) HWY_ATTR {
        const Surface surface = this->surface_at(material, point, direction);
        const uvec4 normal = as_bits(surface.normal, 0u);
        first = select(this->active(), uvec4(hit.x, normal.x, normal.y, normal.z), first);
        second = select(this->active(), as_bits(surface.albedo, 0u), second);
        uvec1 triangle = point.source[0].triangle;
        if ((this->placing & placing_found) != 0)
          triangle =
              select(this->active(), this->load(this->positions, point.source[0].vertex[0]).w, triangle);
        third = select(this->active(),
                       uvec4(floatBitsToUint(surface.texcoord.x), floatBitsToUint(surface.texcoord.y),
                             part.mesh, part.first_mesh_triangle + (triangle - part.first_triangle)),
                       third);
      });
    }
    this->store(aovs_, pixel, first, 4, 0);
    this->store(aovs_, pixel, second, 4, 1);
    this->store(aovs_, pixel, third, 4, 2);
    this->store(aovs_, pixel, uvec4(floatBitsToUint(level), visited, 0u, 0u), 4, 3);
  }

 private:
  Quads rays_ = this->quads(19);
  Words steps_ = this->words(20);
  Quads aovs_ = this->quads(21);
  RayPush push_ = this->template push<RayPush>();
};

LODESTONE_SURFACE_BLOCK_FUNCTION(aov, Aov)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(aov_block);

void aov(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 512, HWY_DYNAMIC_DISPATCH(aov_block));
}

}  // namespace lodestone::cpu_fallback
#endif
