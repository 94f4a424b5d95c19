// SPDX-License-Identifier: MIT
// layout/bounds.h with a corner of a bound in four lanes. Included once a SIMD target.

#if defined(LODESTONE_BOUND_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_BOUND_LANES_INL_H_
#undef LODESTONE_BOUND_LANES_INL_H_
#else
#define LODESTONE_BOUND_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/lanes-inl.h"
#include "lodestone/layout/bounds.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

struct BoundLanes {
  Lanes4 lo, hi;  // lane w is anything
};

HWY_ATTR inline BoundLanes empty_bound() {
  return {all_lanes(layout::infinity_bits_as_max), all_lanes(-layout::infinity_bits_as_max)};
}

HWY_ATTR inline BoundLanes join(const BoundLanes& a, const BoundLanes& b) {
  return {min(a.lo, b.lo), max(a.hi, b.hi)};
}

// Whether v lies before 0 along a ray of each octant: a bit an octant.
HWY_ATTR inline uint32_t before_by_octant(Lanes4 v) {
  const hn::CappedTag<float, 8> d;
  alignas(32) static constexpr float x[8] = {1, -1, 1, -1, 1, -1, 1, -1}, y[8] = {1, 1, -1, -1, 1, 1, -1, -1},
                                     z[8] = {1, 1, 1, 1, -1, -1, -1, -1};
  alignas(16) float at[4];
  store_lanes(v, at);
  const auto vx = hn::Set(d, at[0]), vy = hn::Set(d, at[1]), vz = hn::Set(d, at[2]);
  uint32_t octants = 0;
  for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
    const auto sum = hn::Add(hn::Add(hn::Mul(vx, hn::Load(d, x + i)), hn::Mul(vy, hn::Load(d, y + i))),
                             hn::Mul(vz, hn::Load(d, z + i)));
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Lt(sum, hn::Zero(d)), bits);
    octants |= uint32_t(bits[0]) << i;
  }
  return octants;
}

HWY_ATTR inline uint32_t child_order(const BoundLanes& c0, const BoundLanes& c1, const BoundLanes& c2,
                                     const BoundLanes& c3) {
  const Lanes4 s0 = c0.lo + c0.hi, s1 = c1.lo + c1.hi, s2 = c2.lo + c2.hi, s3 = c3.lo + c3.hi;
  const Lanes4 odd = (s1 + s3) - (s0 + s2), upper = (s2 + s3) - (s0 + s1);
  return layout::spread_bits(before_by_octant(odd)) | layout::spread_bits(before_by_octant(upper)) << 1;
}

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
