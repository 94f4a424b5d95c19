// SPDX-License-Identifier: MIT
// A point or a direction in four lanes, with the arithmetic of layout/arithmetic.h. Included once a SIMD
// target.

#if defined(LODESTONE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_LANES_INL_H_
#undef LODESTONE_LANES_INL_H_
#else
#define LODESTONE_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

#include "lodestone/cpu_fallback/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

// A processor without vectors. (Highway's own emulation of them is switched off for g++ before 12.3.)
struct Lanes4 {
  float at[4];
};

template <class Operation>
inline Lanes4 each_lane(Operation operation) {
  return {operation(0), operation(1), operation(2), operation(3)};
}
inline Lanes4 load_lanes(const float* from) {
  return each_lane([&](int i) { return from[i]; });
}
inline Lanes4 all_lanes(float value) {
  return {value, value, value, value};
}
inline Lanes4 operator+(Lanes4 a, Lanes4 b) {
  return each_lane([&](int i) { return a.at[i] + b.at[i]; });
}
inline Lanes4 operator-(Lanes4 a, Lanes4 b) {
  return each_lane([&](int i) { return a.at[i] - b.at[i]; });
}
inline Lanes4 operator*(Lanes4 a, Lanes4 b) {
  return each_lane([&](int i) { return a.at[i] * b.at[i]; });
}
inline Lanes4 operator/(Lanes4 a, Lanes4 b) {
  return each_lane([&](int i) { return a.at[i] / b.at[i]; });
}
inline Lanes4 min(Lanes4 a, Lanes4 b) {
  return each_lane([&](int i) { return b.at[i] < a.at[i] ? b.at[i] : a.at[i]; });
}
inline Lanes4 max(Lanes4 a, Lanes4 b) {
  return each_lane([&](int i) { return a.at[i] < b.at[i] ? b.at[i] : a.at[i]; });
}
inline Lanes4 abs(Lanes4 v) {
  return each_lane([&](int i) { return std::abs(v.at[i]); });
}
inline Lanes4 sqrt(Lanes4 v) {
  return each_lane([&](int i) { return std::sqrt(v.at[i]); });
}
template <int i>
inline Lanes4 lane(Lanes4 v) {
  return all_lanes(v.at[i]);
}
inline float first_lane(Lanes4 v) {
  return v.at[0];
}
// Lanes i, j, k, l.
template <int i, int j, int k, int l>
inline Lanes4 permuted(Lanes4 v) {
  return {v.at[i], v.at[j], v.at[k], v.at[l]};
}
inline Lanes4 permuted(Lanes4 v, const int32_t* lanes) {
  return each_lane([&](int i) { return v.at[lanes[i]]; });
}
inline Lanes4 where_negative(Lanes4 v, Lanes4 yes, Lanes4 no) {
  return each_lane([&](int i) { return v.at[i] < 0 ? yes.at[i] : no.at[i]; });
}
inline Lanes4 zero_below(Lanes4 v, float limit) {
  return each_lane([&](int i) { return std::abs(v.at[i]) < limit ? 0.0f : v.at[i]; });
}
inline void store_lanes(Lanes4 v, float* to) {
  for (int i = 0; i < 4; ++i) to[i] = v.at[i];
}
inline void transpose(Lanes4& a, Lanes4& b, Lanes4& c, Lanes4& e) {
  const Lanes4 rows[4] = {a, b, c, e};
  a = each_lane([&](int i) { return rows[i].at[0]; });
  b = each_lane([&](int i) { return rows[i].at[1]; });
  c = each_lane([&](int i) { return rows[i].at[2]; });
  e = each_lane([&](int i) { return rows[i].at[3]; });
}

#else

using Four = hn::FixedTag<float, 4>;

struct Lanes4 {
  hn::Vec<Four> v;
};

HWY_ATTR inline Lanes4 load_lanes(const float* from) {
  return {hn::LoadU(Four(), from)};
}
HWY_ATTR inline Lanes4 all_lanes(float value) {
  return {hn::Set(Four(), value)};
}
HWY_ATTR inline Lanes4 operator+(Lanes4 a, Lanes4 b) {
  return {hn::Add(a.v, b.v)};
}
HWY_ATTR inline Lanes4 operator-(Lanes4 a, Lanes4 b) {
  return {hn::Sub(a.v, b.v)};
}
HWY_ATTR inline Lanes4 operator*(Lanes4 a, Lanes4 b) {
  return {hn::Mul(a.v, b.v)};
}
HWY_ATTR inline Lanes4 operator/(Lanes4 a, Lanes4 b) {
  return {hn::Div(a.v, b.v)};
}
// By selects, as in layout/arithmetic.h: what Highway's own make of NaN differs between targets.
HWY_ATTR inline Lanes4 min(Lanes4 a, Lanes4 b) {
  return {hn::IfThenElse(hn::Lt(b.v, a.v), b.v, a.v)};
}
HWY_ATTR inline Lanes4 max(Lanes4 a, Lanes4 b) {
  return {hn::IfThenElse(hn::Lt(a.v, b.v), b.v, a.v)};
}
HWY_ATTR inline Lanes4 abs(Lanes4 v) {
  return {hn::Abs(v.v)};
}
HWY_ATTR inline Lanes4 sqrt(Lanes4 v) {
  return {hn::Sqrt(v.v)};
}
template <int i>
HWY_ATTR inline Lanes4 lane(Lanes4 v) {
  return {hn::Broadcast<i>(v.v)};
}
HWY_ATTR inline float first_lane(Lanes4 v) {
  return hn::GetLane(v.v);
}
// The lanes of those indices.
HWY_ATTR inline Lanes4 permuted(Lanes4 v, const int32_t* lanes) {
  return {hn::TableLookupLanes(v.v, hn::SetTableIndices(Four(), lanes))};
}
// Lanes i, j, k, l.
template <int i, int j, int k, int l>
HWY_ATTR inline Lanes4 permuted(Lanes4 v) {
  alignas(16) static constexpr int32_t lanes[4] = {i, j, k, l};
  return permuted(v, lanes);
}
HWY_ATTR inline Lanes4 where_negative(Lanes4 v, Lanes4 yes, Lanes4 no) {
  return {hn::IfThenElse(hn::Lt(v.v, hn::Zero(Four())), yes.v, no.v)};
}
HWY_ATTR inline Lanes4 zero_below(Lanes4 v, float limit) {
  return {hn::IfThenZeroElse(hn::Lt(hn::Abs(v.v), hn::Set(Four(), limit)), v.v)};
}
HWY_ATTR inline void store_lanes(Lanes4 v, float* to) {
  hn::StoreU(v.v, Four(), to);
}
// Rows to columns.
HWY_ATTR inline void transpose(Lanes4& a, Lanes4& b, Lanes4& c, Lanes4& e) {
  const Four d;
  const hn::Repartition<uint64_t, Four> pairs;
  const auto low_ab = hn::BitCast(pairs, hn::InterleaveLower(d, a.v, b.v)),
             low_ce = hn::BitCast(pairs, hn::InterleaveLower(d, c.v, e.v)),
             high_ab = hn::BitCast(pairs, hn::InterleaveUpper(d, a.v, b.v)),
             high_ce = hn::BitCast(pairs, hn::InterleaveUpper(d, c.v, e.v));
  a.v = hn::BitCast(d, hn::InterleaveLower(pairs, low_ab, low_ce));
  b.v = hn::BitCast(d, hn::InterleaveUpper(pairs, low_ab, low_ce));
  c.v = hn::BitCast(d, hn::InterleaveLower(pairs, high_ab, high_ce));
  e.v = hn::BitCast(d, hn::InterleaveUpper(pairs, high_ab, high_ce));
}

#endif

// x, y, z of `v` and the bits `w`.
HWY_ATTR inline void store_lanes(Lanes4 v, uint32_t w, uint32_t* to) {
  store_lanes(v, reinterpret_cast<float*>(to));
  to[3] = w;
}

// Lanes y, z, x and z, x, y: what cross products are made of. (w is of no interest.)
HWY_ATTR inline Lanes4 turned_once(Lanes4 v) {
  return permuted<1, 2, 0, 3>(v);
}
HWY_ATTR inline Lanes4 turned_twice(Lanes4 v) {
  return permuted<2, 0, 1, 3>(v);
}
// Lanes y, z, w, x.
HWY_ATTR inline Lanes4 without_first(Lanes4 v) {
  return permuted<1, 2, 3, 0>(v);
}

HWY_ATTR inline Lanes4 flush_tiny(Lanes4 v) {
  return zero_below(v, 8.673617e-19f);
}

// (x + y) + z in every lane.
HWY_ATTR inline Lanes4 sum3(Lanes4 v) {
  return lane<0>(v) + lane<1>(v) + lane<2>(v);
}

// layout::normalize_or; lane w of the result is anything.
HWY_ATTR inline Lanes4 normalize_or(Lanes4 v, Lanes4 fallback) {
  v = zero_below(v, 1e-30f);
  const Lanes4 size = abs(v);
  const Lanes4 scale = max(lane<0>(size), max(lane<1>(size), lane<2>(size)));
  if (!(first_lane(scale) > 0.0f)) return fallback;
  const Lanes4 s = v / scale;
  return flush_tiny(s / sqrt(sum3(s * s)));
}

// Three rows of a 3 x 4 matrix by columns, a row a lane.
struct Columns {
  Lanes4 x, y, z, w;

  HWY_ATTR Columns(Lanes4 r0, Lanes4 r1, Lanes4 r2) : x(r0), y(r1), z(r2), w(all_lanes(0)) {
    transpose(x, y, z, w);
  }

  // dot3 of every row with v.
  HWY_ATTR Lanes4 dot(Lanes4 v) const { return x * lane<0>(v) + y * lane<1>(v) + z * lane<2>(v); }
};

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
