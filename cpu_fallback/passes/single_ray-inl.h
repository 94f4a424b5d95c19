// SPDX-License-Identifier: MIT
// One ray against the 16 grandchildren of a node at once: they stand side by side in memory.
// Included once a SIMD target.

#if defined(LODESTONE_SINGLE_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_SINGLE_RAY_INL_H_
#undef LODESTONE_SINGLE_RAY_INL_H_
#else
#define LODESTONE_SINGLE_RAY_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/trace_block.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Boxes = hn::CappedTag<float, 16>;

// A ray in all lanes. Planes are chosen by masks: a choice by branch goes through memory.
struct RayLanes {
  hn::Vec<Boxes> near_x, near_y, near_z, far_x, far_y, far_z, inverse_x, inverse_y, inverse_z, tmin;
  hn::Mask<Boxes> back_x, back_y, back_z;  // the direction's component is negative
};

HWY_ATTR inline RayLanes make_lanes(const layout::Ray& ray, const layout::Slabs& s) {
  const Boxes d;
  const auto zero = hn::Zero(d);
  return {hn::Set(d, s.near_origin.x),
          hn::Set(d, s.near_origin.y),
          hn::Set(d, s.near_origin.z),
          hn::Set(d, s.far_origin.x),
          hn::Set(d, s.far_origin.y),
          hn::Set(d, s.far_origin.z),
          hn::Set(d, s.inverse.x),
          hn::Set(d, s.inverse.y),
          hn::Set(d, s.inverse.z),
          hn::Set(d, ray.tmin),
          hn::Lt(hn::Set(d, ray.direction.x), zero),
          hn::Lt(hn::Set(d, ray.direction.y), zero),
          hn::Lt(hn::Set(d, ray.direction.z), zero)};
}

// Tests `count` (at most 16) nodes from `address` on; returns the bits of those entered before `tmax` and
// their distances.
template <class Block>
HWY_ATTR inline uint32_t test_boxes(const Block& block, const RayLanes& ray, uint32_t address, uint32_t count,
                                    float tmax, float* HWY_RESTRICT enter) {
  const Boxes d;
  const auto limit = hn::Set(d, tmax);
  const size_t lanes = hn::Lanes(d);
  uint32_t hits = 0;
  for (uint32_t first = 0; first < count; first += lanes) {
    hn::Vec<Boxes> lo_x, lo_y, lo_z, hi_x, hi_y, hi_z, unused;
    hn::LoadInterleaved4(d, block.nodes_lo(address + first), lo_x, lo_y, lo_z, unused);
    hn::LoadInterleaved4(d, block.nodes_hi(address + first), hi_x, hi_y, hi_z, unused);
    const auto enter_x = hn::Mul(hn::Sub(hn::IfThenElse(ray.back_x, hi_x, lo_x), ray.near_x), ray.inverse_x);
    const auto enter_y = hn::Mul(hn::Sub(hn::IfThenElse(ray.back_y, hi_y, lo_y), ray.near_y), ray.inverse_y);
    const auto enter_z = hn::Mul(hn::Sub(hn::IfThenElse(ray.back_z, hi_z, lo_z), ray.near_z), ray.inverse_z);
    const auto exit_x = hn::Mul(hn::Sub(hn::IfThenElse(ray.back_x, lo_x, hi_x), ray.far_x), ray.inverse_x);
    const auto exit_y = hn::Mul(hn::Sub(hn::IfThenElse(ray.back_y, lo_y, hi_y), ray.far_y), ray.inverse_y);
    const auto exit_z = hn::Mul(hn::Sub(hn::IfThenElse(ray.back_z, lo_z, hi_z), ray.far_z), ray.inverse_z);
    const auto from = hn::Max(hn::Max(enter_x, enter_y), hn::Max(enter_z, ray.tmin));
    const auto to = hn::Min(hn::Min(exit_x, exit_y), hn::Min(exit_z, limit));
    hn::StoreU(from, d, enter + first);
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Le(from, to), bits);
    hits |= (uint32_t(bits[0]) | uint32_t(bits[1]) << 8) << first;
  }
  return hits & ((1u << count) - 1);
}

struct StackEntry {
  float enter;
  uint32_t index;
  uint32_t level;
};

// Puts the entered nodes on the stack, the nearest last.
HWY_ATTR inline uint32_t push_sorted(StackEntry* stack, uint32_t size, uint32_t hits, const float* enter,
                                     uint32_t index, uint32_t level) {
  const uint32_t bottom = size;
  for (; hits != 0; hits &= hits - 1) {
    const auto child = static_cast<uint32_t>(std::countr_zero(hits));
    const StackEntry entry{enter[child], index + child, level};
    uint32_t place = size++;
    for (; place > bottom && stack[place - 1].enter < entry.enter; --place) stack[place] = stack[place - 1];
    stack[place] = entry;
  }
  return size;
}

// layout::intersect_quad with the four corners in four lanes.
template <class Block>
HWY_ATTR inline void test_quad(Block& block, const layout::Ray& ray, const layout::Shear& shear,
                               uint32_t address, float enter, layout::Hit& best) {
  const uint32_t texel = block.leaf_texel(address), stride = block.leaf_stride(address);
  block.count_quad(1);
#if HWY_TARGET == HWY_SCALAR
  layout::intersect_quad(block.texel(texel), block.texel(texel + 1), block.texel(texel + stride),
                         block.texel(texel + stride + 1), ray, shear, enter, texel, best);
#else
  const hn::FixedTag<float, 4> d;
  const auto a = hn::LoadU(d, block.texels(texel)), b = hn::LoadU(d, block.texels(texel + 1));
  const auto c = hn::LoadU(d, block.texels(texel + stride)),
             e = hn::LoadU(d, block.texels(texel + stride + 1));
  const auto ab = hn::InterleaveLower(d, a, b), ce = hn::InterleaveLower(d, c, e);
  const auto x = hn::Sub(hn::ConcatLowerLower(d, ce, ab), hn::Set(d, ray.origin.x));
  const auto y = hn::Sub(hn::ConcatUpperUpper(d, ce, ab), hn::Set(d, ray.origin.y));
  const auto z = hn::Sub(hn::ConcatLowerLower(d, hn::InterleaveUpper(d, c, e), hn::InterleaveUpper(d, a, b)),
                         hn::Set(d, ray.origin.z));
  const hn::RebindToUnsigned<decltype(d)> du;
  const auto axis = hn::Set(du, shear.axis);
  const auto along_x = hn::RebindMask(d, hn::Eq(axis, hn::Zero(du))),
             along_y = hn::RebindMask(d, hn::Eq(axis, hn::Set(du, 1)));
  const auto depth = hn::IfThenElse(along_x, x, hn::IfThenElse(along_y, y, z));
  const auto px =
      hn::Sub(hn::IfThenElse(along_x, y, hn::IfThenElse(along_y, z, x)), hn::Mul(hn::Set(d, shear.x), depth));
  const auto py =
      hn::Sub(hn::IfThenElse(along_x, z, hn::IfThenElse(along_y, x, y)), hn::Mul(hn::Set(d, shear.y), depth));
  // Edges a b, b c, c a and d c at once; b d by itself.
  alignas(16) static constexpr int32_t ends[4] = {1, 2, 0, 2};
  const auto to = hn::SetTableIndices(d, ends);
  const auto edges =
      hn::Sub(hn::Mul(px, hn::TableLookupLanes(py, to)), hn::Mul(py, hn::TableLookupLanes(px, to)));
  alignas(16) float w[4], corner_x[4], corner_y[4], t[4];
  hn::Store(edges, d, w);
  hn::Store(px, d, corner_x);
  hn::Store(py, d, corner_y);
  const float bd = corner_x[1] * corner_y[3] - corner_y[1] * corner_x[3];
  const bool first = layout::one_sided(w[1], w[2], w[0]), second = layout::one_sided(-w[1], bd, w[3]);
  if (!first && !second) return;
  hn::Store(hn::Mul(hn::Set(d, shear.z), depth), d, t);
  const glm::vec3 ta(0, 0, t[0]), tb(0, 0, t[1]), tc(0, 0, t[2]), td(0, 0, t[3]);
  layout::accept_triangle(ta, tb, tc, w[1], w[2], w[0], ray.tmin, enter, 2 * texel, best);
  layout::accept_triangle(td, tc, tb, -w[1], bd, w[3], ray.tmin, enter, 2 * texel + 1, best);
#endif
}

template <class Block>
HWY_ATTR inline void trace_single(Block& block, uint32_t index) {
  if (!block.wanted(index)) return;
  const layout::Ray ray = block.ray(index);
  layout::Hit best{ray.tmax, 0, 0, layout::no_index};
  uint32_t visits = 0;
  if (!(ray.tmax < 0.0f)) {
    const RayLanes slabs = make_lanes(ray, layout::make_slabs(ray, block.extent()));
    const layout::Shear shear = layout::make_shear(ray);
    const uint32_t depth = block.depth();
    // Two levels a step, so that the last step ends on the leaves: from the root's children where the depth
    // is odd.
    StackEntry stack[16 * (layout::max_depth / 2 + 1)];
    uint32_t size = 0;
    alignas(64) float enter[16];
    uint32_t level = depth % 2 == 0 ? 2 : 1, first = 0;
    for (;;) {
      const uint32_t fan = level == 1 ? 4 : 16;
      const uint32_t count = std::min(fan, block.places(level) - first);
      uint32_t hits = test_boxes(block, slabs, layout::level_base(level) + first, count, best.t, enter);
      block.count_step(count, count, 1, 1);
      ++visits;
      if (level == depth) {
        for (uint32_t rest = hits; rest != 0; rest &= rest - 1) {
          const uint32_t leaf =
              layout::level_base(level) + first + static_cast<uint32_t>(std::countr_zero(rest));
          hwy::Prefetch(block.texels(block.leaf_texel(leaf)));
          hwy::Prefetch(block.texels(block.leaf_texel(leaf) + block.leaf_stride(leaf)));
        }
        while (hits != 0) {
          // Nearest first: often the others then lie behind the hit.
          uint32_t nearest = static_cast<uint32_t>(std::countr_zero(hits));
          for (uint32_t rest = hits & (hits - 1); rest != 0; rest &= rest - 1) {
            const auto other = static_cast<uint32_t>(std::countr_zero(rest));
            if (enter[other] < enter[nearest]) nearest = other;
          }
          hits &= ~(1u << nearest);
          if (enter[nearest] > best.t) break;
          test_quad(block, ray, shear, layout::level_base(level) + first + nearest, enter[nearest], best);
        }
        if (block.any_hit() && best.primitive != layout::no_index) break;
      } else {
        size = push_sorted(stack, size, hits, enter, first, level);
      }
      while (size != 0 && stack[size - 1].enter > best.t) --size;
      if (size == 0) break;
      const StackEntry next = stack[--size];
      level = next.level + 2;
      first = 16 * next.index;
    }
  }
  block.finish(index, ray, best, visits);
}

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
