// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/arithmetic.h"
#include "lodestone/layout/frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/blend.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

template <class Probe>
class Blend : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  HWY_ATTR void operator()(uint32_t invocation) {
    const uint32_t vertex = push_.first + invocation;
    const glm::uvec4 range = this->load(vertex_ranges_, vertex);
    const float* base_normal = this->loaded(base_normals_, vertex);
    Lanes4 position = load_lanes(this->loaded(base_positions_, vertex));
    Lanes4 normal = load_lanes(base_normal);
    const float* base_tangent = push_.tangents != 0 ? this->loaded(base_tangents_, vertex) : nullptr;
    Lanes4 tangent = base_tangent != nullptr ? load_lanes(base_tangent) : all_lanes(0);
    for (uint32_t i = range.x; i < range.y; ++i) {
      // { bits of the weight's index, delta x, y, z }
      const float* entry = this->loaded(morph_positions_, i);
      const uint32_t index = layout::floatBitsToUint(entry[0]);
      const Lanes4 weight = all_lanes(layout::uintBitsToFloat(this->load(weights_, index)));
      const Lanes4 delta = without_first(load_lanes(entry));
      position = position + weight * delta;
      normal = normal + weight * load_lanes(this->loaded(morph_normals_, i));
      if (base_tangent != nullptr) {
        tangent = tangent + weight * load_lanes(this->loaded(morph_tangents_, i));
      }
    }

    Rows rows = weighted_matrix(range.z);
    for (uint32_t i = range.z + 1; i < range.w; ++i) {
      const Rows more = weighted_matrix(i);
      rows.r0 = rows.r0 + more.r0;
      rows.r1 = rows.r1 + more.r1;
      rows.r2 = rows.r2 + more.r2;
    }
    const Columns m(rows.r0, rows.r1, rows.r2);
    store_lanes(flush_tiny(m.dot(position) + m.w), 0, this->stored(positions_, vertex));

    // The cofactors: row i is the cross product of the rows i + 1 and i + 2.
    const Lanes4 x1 = turned_once(m.x), x2 = turned_twice(m.x), y1 = turned_once(m.y), y2 = turned_twice(m.y),
                 z1 = turned_once(m.z), z2 = turned_twice(m.z);
    const Lanes4 cx = y1 * z2 - z1 * y2, cy = z1 * x2 - x1 * z2, cz = x1 * y2 - y1 * x2;
    Lanes4 turned = cx * lane<0>(normal) + cy * lane<1>(normal) + cz * lane<2>(normal);
    const float determinant = first_lane(m.x * cx + m.y * cy + m.z * cz);
    const bool mirrored = determinant < 0.0f;
    if (mirrored) turned = turned * all_lanes(-1.0f);
    alignas(16) static constexpr float up[4] = {0, 0, 1, 0};
    store_lanes(normalize_or(turned, load_lanes(up)), layout::floatBitsToUint(base_normal[3]),
                this->stored(normals_, vertex));
    if (base_tangent != nullptr) {
      const uint32_t side = layout::floatBitsToUint(base_tangent[3]);
      store_lanes(normalize_or(m.dot(tangent), all_lanes(0)), mirrored ? side ^ 0x80000000u : side,
                  this->stored(tangents_, vertex));
    }
  }

 private:
  struct Rows {
    Lanes4 r0, r1, r2;
  };

  HWY_ATTR Rows weighted_matrix(uint32_t influence) {
    const uint64_t matrix = this->load(influences_, 2 * uint64_t(influence));
    const Lanes4 weight =
        all_lanes(layout::uintBitsToFloat(this->load(influences_, 2 * uint64_t(influence) + 1)));
    return {load_lanes(this->loaded(matrices_, 3 * matrix)) * weight,
            load_lanes(this->loaded(matrices_, 3 * matrix + 1)) * weight,
            load_lanes(this->loaded(matrices_, 3 * matrix + 2)) * weight};
  }

  Quads base_positions_ = this->quads(0), base_normals_ = this->quads(1), base_tangents_ = this->quads(2);
  Quads vertex_ranges_ = this->quads(3);
  Quads morph_positions_ = this->quads(4), morph_normals_ = this->quads(5), morph_tangents_ = this->quads(6);
  Words influences_ = this->words(7), weights_ = this->words(8);
  Quads matrices_ = this->quads(9);
  Quads positions_ = this->quads(10), normals_ = this->quads(11), tangents_ = this->quads(12);
  layout::BlendPush push_ = this->template push<layout::BlendPush>();
};

LODESTONE_BLOCK_FUNCTION(HWY_ATTR, blend, Blend)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(blend_block);

void blend(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 2048, HWY_DYNAMIC_DISPATCH(blend_block));
}

}  // namespace lodestone::cpu_fallback
#endif
