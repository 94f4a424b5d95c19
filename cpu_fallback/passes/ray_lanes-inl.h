// SPDX-License-Identifier: MIT
// Sixteen rays against a quad, a ray a lane; the arithmetic of each is that of layout/trace.h. Included once
// a SIMD target.

#if defined(LODESTONE_RAY_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_RAY_LANES_INL_H_
#undef LODESTONE_RAY_LANES_INL_H_
#else
#define LODESTONE_RAY_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/kernel.h"
#include "lodestone/layout/trace.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr uint32_t bundle_rays = 16;

using Lanes = hn::CappedTag<float, bundle_rays>;
using Floats = hn::Vec<Lanes>;
using Mask = hn::Mask<Lanes>;
using Ids = hn::Vec<hn::RebindToUnsigned<Lanes>>;

struct Vec3 {
  Floats x, y, z;
};

HWY_ATTR inline Vec3 sub(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_ATTR inline Floats edge_function(const Vec3& p, const Vec3& q) {
  return hn::Sub(hn::Mul(p.x, q.y), hn::Mul(p.y, q.x));
}

// Hits so far, structure of arrays; u and v are these over `sum`, which one division in the end says as well
// as one a hit.
struct BestHits {
  alignas(64) float t[bundle_rays], u[bundle_rays], v[bundle_rays], sum[bundle_rays];
  alignas(64) uint32_t primitive[bundle_rays];

  HWY_ATTR void begin(uint32_t lane, Floats tmax) {
    const Lanes d;
    const hn::RebindToUnsigned<Lanes> du;
    hn::Store(tmax, d, t + lane);
    hn::Store(hn::Zero(d), d, u + lane);
    hn::Store(hn::Zero(d), d, v + lane);
    hn::Store(hn::Set(d, 1.0f), d, sum + lane);
    hn::Store(hn::Set(du, layout::no_index), du, primitive + lane);
  }
};

HWY_ATTR inline Vec3 load3(const float (&a)[3][bundle_rays], uint32_t lane) {
  const Lanes d;
  return {hn::Load(d, a[0] + lane), hn::Load(d, a[1] + lane), hn::Load(d, a[2] + lane)};
}

// Both triangles of a quad for the lanes from `lane` on that entered its bound.
struct QuadTest {
  const Lanes d;
  const hn::RebindToUnsigned<Lanes> du;
  Floats tmin, enter, best_t, best_u, best_v, best_sum;
  Ids best_primitive;

  HWY_ATTR QuadTest(const BestHits& best, uint32_t lane, Floats ray_tmin, Floats quad_enter)
      : tmin(ray_tmin),
        enter(quad_enter),
        best_t(hn::Load(d, best.t + lane)),
        best_u(hn::Load(d, best.u + lane)),
        best_v(hn::Load(d, best.v + lane)),
        best_sum(hn::Load(d, best.sum + lane)),
        best_primitive(hn::Load(du, best.primitive + lane)) {}

  // `any_hit`: rays that have one enter nothing any more.
  HWY_ATTR void store(BestHits& best, uint32_t lane, bool any_hit) const {
    const Mask missed = hn::RebindMask(d, hn::Eq(best_primitive, hn::Set(du, layout::no_index)));
    hn::Store(any_hit ? hn::IfThenElse(missed, best_t, hn::Set(d, -1.0f)) : best_t, d, best.t + lane);
    hn::Store(best_u, d, best.u + lane);
    hn::Store(best_v, d, best.v + lane);
    hn::Store(best_sum, d, best.sum + lane);
    hn::Store(best_primitive, du, best.primitive + lane);
  }

  HWY_ATTR void accept(const Vec3& p0, const Vec3& p1, const Vec3& p2, Floats w0, Floats w1, Floats w2,
                       Mask entered, uint32_t primitive) {
    const auto zero = hn::Zero(d);
    const Mask positive = hn::And(hn::And(hn::Ge(w0, zero), hn::Ge(w1, zero)), hn::Ge(w2, zero));
    const Mask negative = hn::And(hn::And(hn::Le(w0, zero), hn::Le(w1, zero)), hn::Le(w2, zero));
    const Floats sum = hn::Add(hn::Add(w0, w1), w2);
    Mask hit = hn::And(hn::And(hn::Or(positive, negative), entered), hn::Ne(sum, zero));
    if (hn::AllFalse(d, hit)) return;
    Floats t = hn::Div(hn::Add(hn::Add(hn::Mul(w0, p0.z), hn::Mul(w1, p1.z)), hn::Mul(w2, p2.z)), sum);
    hit = hn::And(hit, hn::Gt(t, tmin));
    t = hn::IfThenElse(hn::Lt(t, enter), enter, t);
    const Ids ids = hn::Set(du, primitive);
    const Mask lower = hn::RebindMask(d, hn::Lt(ids, best_primitive));
    hit = hn::And(hit, hn::Or(hn::Lt(t, best_t), hn::And(hn::Eq(t, best_t), lower)));
    best_t = hn::IfThenElse(hit, t, best_t);
    best_u = hn::IfThenElse(hit, w1, best_u);
    best_v = hn::IfThenElse(hit, w2, best_v);
    best_sum = hn::IfThenElse(hit, sum, best_sum);
    best_primitive = hn::IfThenElse(hn::RebindMask(du, hit), ids, best_primitive);
  }
};

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
