// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/surface_kernel.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;
using layout::floatBitsToUint;
using layout::uintBitsToFloat;

template <class Probe>
class Aov : public SurfaceKernel<Probe> {
 public:
  using SurfaceKernel<Probe>::SurfaceKernel;

  void operator()(uint32_t index) {
    const layout::FrameRecord& frame = this->frames[0];
    uint32_t px = 0, py = 0;
    if (!layout::ray_pixel(push_.first_ray + index, frame.width, frame.height, px, py)) return;
    const uvec4 hit = this->load(this->hits, index);
    const uint32_t visited = this->load(steps_, index);
    const uint64_t pixel = uint64_t(py) * frame.width + px;
    uvec4 first(0x7f800000u, 0, 0, 0), second(0), third(0, 0, layout::no_index, layout::no_index);
    if (hit.w != layout::no_index) {
      const uvec4 along = this->load(rays_, 2 * uint64_t(index) + 1);
      const auto point = this->locate(hit.w, uintBitsToFloat(hit.y), uintBitsToFloat(hit.z));
      const layout::Surface surface = this->surface_at(point, as_vec3(along));
      const layout::PartRecord& part = this->parts[point.part];
      const uvec4 normal = as_bits(surface.normal, 0);
      first = uvec4(hit.x, normal.x, normal.y, normal.z);
      second = as_bits(surface.albedo, 0);
      third = uvec4(floatBitsToUint(surface.texcoord.x), floatBitsToUint(surface.texcoord.y), part.mesh,
                    part.first_mesh_triangle + (point.triangle - part.first_triangle));
    }
    this->store(aovs_, 4 * pixel, first);
    this->store(aovs_, 4 * pixel + 1, second);
    this->store(aovs_, 4 * pixel + 2, third);
    this->store(aovs_, 4 * pixel + 3, uvec4(0, visited, 0, 0));
  }

 private:
  Quads rays_ = this->quads(16);
  Words steps_ = this->words(17);
  Quads aovs_ = this->quads(18);
  layout::RayPush push_ = this->template push<layout::RayPush>();
};

}  // namespace

void aov(const CpuDispatch& dispatch) {
  run_pass<Aov>(dispatch, 512);
}

}  // namespace lodestone::cpu_fallback
