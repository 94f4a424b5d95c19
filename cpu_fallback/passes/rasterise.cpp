// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/arithmetic.h"
#include "lodestone/layout/frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/rasterise.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Rasterise : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  HWY_ATTR void operator()(uint32_t index) {
    const uint32_t texel = push_.first + index;
    const glm::uvec4 source = this->load(texel_map_, texel);
    uint32_t* point = this->stored(geometry_, uint64_t(push_.image) + texel);
    uint32_t* direction = this->stored(normal_map_, uint64_t(push_.image) + texel);
    if (source.w == 0) {
      store_lanes(all_lanes(0), 0, point);
      store_lanes(all_lanes(0), 0, direction);
      return;
    }
    const glm::uvec4 triangle = this->load(triangles_, source.x);
    const float b1 = layout::uintBitsToFloat(source.y), b2 = layout::uintBitsToFloat(source.z);
    const float b0 = 1.0f - b1 - b2;
    store_lanes(flush_tiny(weighted(positions_, triangle, b0, b1, b2)), source.w, point);
    store_lanes(weighted(normals_, triangle, b0, b1, b2), 0, direction);
  }

 private:
  HWY_ATTR Lanes4 weighted(const Quads& vertices, const glm::uvec4& triangle, float b0, float b1, float b2) {
    const Lanes4 v0 = load_lanes(this->loaded(vertices, triangle.x)),
                 v1 = load_lanes(this->loaded(vertices, triangle.y)),
                 v2 = load_lanes(this->loaded(vertices, triangle.z));
    return v0 * all_lanes(b0) + v1 * all_lanes(b1) + v2 * all_lanes(b2);
  }

  Quads texel_map_ = this->quads(0), triangles_ = this->quads(1);
  Quads positions_ = this->quads(2), normals_ = this->quads(3);
  Quads geometry_ = this->quads(4), normal_map_ = this->quads(5);
  layout::RasterisePush push_ = this->template push<layout::RasterisePush>();
};

LODESTONE_BLOCK_FUNCTION(HWY_ATTR, rasterise, Rasterise)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(rasterise_block);

void rasterise(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 4096, HWY_DYNAMIC_DISPATCH(rasterise_block));
}

}  // namespace lodestone::cpu_fallback
#endif
