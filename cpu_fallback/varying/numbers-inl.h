// SPDX-License-Identifier: MIT
// The numbers of layout/types.h for invocations side by side: a vec1 is a float an invocation, one a vector
// lane, and so on for uvec1, ivec1, bvec1 and what is made of them. A plain number becomes one by itself, the
// same in all lanes. Included once a SIMD target.
//
// Bits are those of the scalar operators. Integers wrap; a float outside the range of ivec1 becomes any.

#if defined(LODESTONE_NUMBERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_NUMBERS_INL_H_
#undef LODESTONE_NUMBERS_INL_H_
#else
#define LODESTONE_NUMBERS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <concepts>
#include <cstdint>
#include <glm/glm.hpp>

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Unsigneds = hn::RebindToUnsigned<Floats>;
using Signeds = hn::RebindToSigned<Floats>;
constexpr uint32_t lane_count = hn::MaxLanes(Floats());

struct uvec1;
struct ivec1;

// A condition.
struct bvec1 {
  hn::Mask<Floats> mask;

  bvec1() = default;
  HWY_ATTR bvec1(hn::Mask<Floats> m) : mask(m) {}
  template <std::same_as<bool> T>
  HWY_ATTR bvec1(T all) : mask(hn::FirstN(Floats(), all ? lane_count : 0)) {}

  HWY_ATTR friend bvec1 operator&&(bvec1 a, bvec1 b) { return hn::And(a.mask, b.mask); }
  HWY_ATTR friend bvec1 operator||(bvec1 a, bvec1 b) { return hn::Or(a.mask, b.mask); }
  HWY_ATTR friend bvec1 operator!(bvec1 a) { return hn::Not(a.mask); }
};

HWY_ATTR inline bool any_lane(bvec1 condition) {
  return !hn::AllFalse(Floats(), condition.mask);
}
// Bit i: lane i.
HWY_ATTR inline uint32_t lane_bits(bvec1 condition) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats(), condition.mask, bytes);
  return uint32_t(bytes[0]) | uint32_t(bytes[1]) << 8;
}
HWY_ATTR inline bvec1 first_lanes(uint32_t count) {
  return hn::FirstN(Floats(), count);
}

struct vec1 {
  hn::Vec<Floats> v;

  vec1() = default;
  HWY_ATTR vec1(hn::Vec<Floats> lanes) : v(lanes) {}
  template <std::same_as<float> T>
  HWY_ATTR vec1(T all) : v(hn::Set(Floats(), all)) {}
  HWY_ATTR explicit vec1(uvec1 below_2_to_31);
  HWY_ATTR explicit vec1(ivec1 i);

  HWY_ATTR friend vec1 operator+(vec1 a, vec1 b) { return hn::Add(a.v, b.v); }
  HWY_ATTR friend vec1 operator-(vec1 a, vec1 b) { return hn::Sub(a.v, b.v); }
  HWY_ATTR friend vec1 operator*(vec1 a, vec1 b) { return hn::Mul(a.v, b.v); }
  HWY_ATTR friend vec1 operator/(vec1 a, vec1 b) { return hn::Div(a.v, b.v); }
  HWY_ATTR friend vec1 operator-(vec1 a) { return hn::Neg(a.v); }
  HWY_ATTR friend bvec1 operator<(vec1 a, vec1 b) { return hn::Lt(a.v, b.v); }
  HWY_ATTR friend bvec1 operator<=(vec1 a, vec1 b) { return hn::Le(a.v, b.v); }
  HWY_ATTR friend bvec1 operator>(vec1 a, vec1 b) { return hn::Gt(a.v, b.v); }
  HWY_ATTR friend bvec1 operator>=(vec1 a, vec1 b) { return hn::Ge(a.v, b.v); }
  HWY_ATTR friend bvec1 operator==(vec1 a, vec1 b) { return hn::Eq(a.v, b.v); }
  // Not Highway's Ne, which says on AVX2 that a NaN is not unequal.
  HWY_ATTR friend bvec1 operator!=(vec1 a, vec1 b) { return !(a == b); }
};

HWY_ATTR inline vec1 sqrt(vec1 x) {
  return hn::Sqrt(x.v);
}
// Highway's may give +0 for -0.
HWY_ATTR inline vec1 floor(vec1 x) {
  return hn::CopySign(hn::Floor(x.v), x.v);
}

// Whole numbers of those that are; of others anything, for lanes that do nothing may hold what is no number.
HWY_ATTR inline hn::Vec<Signeds> converted(hn::Vec<Floats> x) {
#if HWY_TARGET == HWY_EMU128
  x = hn::IfThenElseZero(hn::Eq(x, x), x);  // undefined there
#endif
  return hn::ConvertTo(Signeds(), x);
}

struct uvec1 {
  hn::Vec<Unsigneds> v;

  uvec1() = default;
  HWY_ATTR uvec1(hn::Vec<Unsigneds> lanes) : v(lanes) {}
  template <std::same_as<uint32_t> T>
  HWY_ATTR uvec1(T all) : v(hn::Set(Unsigneds(), all)) {}
  HWY_ATTR explicit uvec1(ivec1 i);
  HWY_ATTR explicit uvec1(vec1 below_2_to_31) : v(hn::BitCast(Unsigneds(), converted(below_2_to_31.v))) {}

  HWY_ATTR friend uvec1 operator+(uvec1 a, uvec1 b) { return hn::Add(a.v, b.v); }
  HWY_ATTR friend uvec1 operator-(uvec1 a, uvec1 b) { return hn::Sub(a.v, b.v); }
  HWY_ATTR friend uvec1 operator*(uvec1 a, uvec1 b) { return hn::Mul(a.v, b.v); }
  HWY_ATTR friend uvec1 operator&(uvec1 a, uvec1 b) { return hn::And(a.v, b.v); }
  HWY_ATTR friend uvec1 operator|(uvec1 a, uvec1 b) { return hn::Or(a.v, b.v); }
  HWY_ATTR friend uvec1 operator^(uvec1 a, uvec1 b) { return hn::Xor(a.v, b.v); }
  HWY_ATTR friend uvec1 operator<<(uvec1 a, uint32_t bits) {
    return hn::ShiftLeftSame(a.v, static_cast<int>(bits));
  }
  HWY_ATTR friend uvec1 operator>>(uvec1 a, uint32_t bits) {
    return hn::ShiftRightSame(a.v, static_cast<int>(bits));
  }
  HWY_ATTR friend uvec1 operator<<(uvec1 a, uvec1 bits) { return hn::Shl(a.v, bits.v); }
  HWY_ATTR friend uvec1 operator>>(uvec1 a, uvec1 bits) { return hn::Shr(a.v, bits.v); }
  HWY_ATTR friend bvec1 operator<(uvec1 a, uvec1 b) { return hn::RebindMask(Floats(), hn::Lt(a.v, b.v)); }
  HWY_ATTR friend bvec1 operator>=(uvec1 a, uvec1 b) { return !(a < b); }
  HWY_ATTR friend bvec1 operator==(uvec1 a, uvec1 b) { return hn::RebindMask(Floats(), hn::Eq(a.v, b.v)); }
  HWY_ATTR friend bvec1 operator!=(uvec1 a, uvec1 b) { return hn::RebindMask(Floats(), hn::Ne(a.v, b.v)); }
};

struct ivec1 {
  hn::Vec<Signeds> v;

  ivec1() = default;
  HWY_ATTR ivec1(hn::Vec<Signeds> lanes) : v(lanes) {}
  template <std::same_as<int32_t> T>
  HWY_ATTR ivec1(T all) : v(hn::Set(Signeds(), all)) {}
  HWY_ATTR explicit ivec1(uvec1 u) : v(hn::BitCast(Signeds(), u.v)) {}
  HWY_ATTR explicit ivec1(vec1 x) : v(converted(x.v)) {}

  HWY_ATTR friend ivec1 operator+(ivec1 a, ivec1 b) { return hn::Add(a.v, b.v); }
  HWY_ATTR friend ivec1 operator-(ivec1 a, ivec1 b) { return hn::Sub(a.v, b.v); }
  HWY_ATTR friend ivec1 operator*(ivec1 a, ivec1 b) { return hn::Mul(a.v, b.v); }
  HWY_ATTR friend ivec1 operator&(ivec1 a, ivec1 b) { return hn::And(a.v, b.v); }
  HWY_ATTR friend ivec1 operator>>(ivec1 a, uvec1 bits) {
    return hn::Shr(a.v, hn::BitCast(Signeds(), bits.v));
  }
  HWY_ATTR friend bvec1 operator<(ivec1 a, ivec1 b) { return hn::RebindMask(Floats(), hn::Lt(a.v, b.v)); }
  HWY_ATTR friend bvec1 operator>=(ivec1 a, ivec1 b) { return !(a < b); }
  HWY_ATTR friend bvec1 operator==(ivec1 a, ivec1 b) { return hn::RebindMask(Floats(), hn::Eq(a.v, b.v)); }
  HWY_ATTR friend bvec1 operator!=(ivec1 a, ivec1 b) { return hn::RebindMask(Floats(), hn::Ne(a.v, b.v)); }
};

HWY_ATTR inline vec1::vec1(ivec1 i) : v(hn::ConvertTo(Floats(), i.v)) {}
HWY_ATTR inline vec1::vec1(uvec1 below_2_to_31) : vec1(ivec1(below_2_to_31)) {}
HWY_ATTR inline uvec1::uvec1(ivec1 i) : v(hn::BitCast(Unsigneds(), i.v)) {}

HWY_ATTR inline uvec1 floatBitsToUint(vec1 x) {
  return hn::BitCast(Unsigneds(), x.v);
}
HWY_ATTR inline vec1 uintBitsToFloat(uvec1 x) {
  return hn::BitCast(Floats(), x.v);
}

HWY_ATTR inline bvec1 select(bvec1 condition, bvec1 yes, bvec1 no) {
  return (condition && yes) || (!condition && no);
}
HWY_ATTR inline vec1 select(bvec1 condition, vec1 yes, vec1 no) {
  return hn::IfThenElse(condition.mask, yes.v, no.v);
}
HWY_ATTR inline uvec1 select(bvec1 condition, uvec1 yes, uvec1 no) {
  return hn::IfThenElse(hn::RebindMask(Unsigneds(), condition.mask), yes.v, no.v);
}
HWY_ATTR inline ivec1 select(bvec1 condition, ivec1 yes, ivec1 no) {
  return hn::IfThenElse(hn::RebindMask(Signeds(), condition.mask), yes.v, no.v);
}

// The lanes in memory, for what vectors have no operation for.
struct LaneWords {
  alignas(64) uint32_t at[lane_count];

  HWY_ATTR explicit LaneWords(uvec1 lanes) { hn::Store(lanes.v, Unsigneds(), at); }
  HWY_ATTR uvec1 lanes() const { return hn::Load(Unsigneds(), at); }
};

// Quotients, rounded towards zero; one by 0 is that by 1. As long as the operands are below 2^22 that of
// floats is exact: it differs from the next integer by 1 / b, more than its rounding.
template <class Word>
HWY_ATTR inline uvec1 divided(uvec1 a, uvec1 b) {
  LaneWords quotients(a);
  const LaneWords divisors(b);
  for (uint32_t i = 0; i < lane_count; ++i) {
    const int64_t quotient =
        int64_t{static_cast<Word>(quotients.at[i])} / int64_t{static_cast<Word>(divisors.at[i])};
    quotients.at[i] = static_cast<uint32_t>(quotient);
  }
  return quotients.lanes();
}
HWY_ATTR inline bool below_2_to_22(uvec1 sizes) {
  return !any_lane((sizes & 0xffc00000u) != 0u);
}
HWY_ATTR inline uvec1 operator/(uvec1 a, uvec1 b) {
  b = select(b == 0u, 1u, b);
  if (HWY_LIKELY(below_2_to_22(a | b))) return uvec1(vec1(a) / vec1(b));
  return divided<uint32_t>(a, b);
}
HWY_ATTR inline ivec1 operator/(ivec1 a, ivec1 b) {
  b = select(b == 0, 1, b);
  if (HWY_LIKELY(below_2_to_22(uvec1(ivec1(hn::Abs(a.v))) | uvec1(ivec1(hn::Abs(b.v)))))) {
    return ivec1(vec1(a) / vec1(b));
  }
  return ivec1(divided<int32_t>(uvec1(a), uvec1(b)));
}
HWY_ATTR inline uvec1 operator%(uvec1 a, uvec1 b) {
  return a - a / b * b;
}
HWY_ATTR inline ivec1 operator%(ivec1 a, ivec1 b) {
  return a - a / b * b;
}

HWY_ATTR inline ivec1 bitCount(uvec1 x) {
  return ivec1(uvec1(hn::PopulationCount(x.v)));
}
// -1 for 0.
HWY_ATTR inline ivec1 findLSB(uvec1 x) {
  return select(x == 0u, -1, bitCount((x - 1u) & (x ^ 0xffffffffu)));
}
HWY_ATTR inline ivec1 findMSB(uvec1 x) {
  x = x | x >> 1u;
  x = x | x >> 2u;
  x = x | x >> 4u;
  x = x | x >> 8u;
  x = x | x >> 16u;
  return bitCount(x) - 1;
}
HWY_ATTR inline uvec1 bitfieldReverse(uvec1 x) {
  x = ((x >> 1u) & 0x55555555u) | ((x & 0x55555555u) << 1u);
  x = ((x >> 2u) & 0x33333333u) | ((x & 0x33333333u) << 2u);
  x = ((x >> 4u) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4u);
  x = ((x >> 8u) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8u);
  return (x >> 16u) | (x << 16u);
}

struct vec2 {
  vec1 x, y;

  vec2() = default;
  HWY_ATTR vec2(vec1 x_, vec1 y_) : x(x_), y(y_) {}
  HWY_ATTR vec2(const glm::vec2& all) : x(all.x), y(all.y) {}
};

struct vec3 {
  vec1 x, y, z;

  vec3() = default;
  HWY_ATTR vec3(vec1 x_, vec1 y_, vec1 z_) : x(x_), y(y_), z(z_) {}
  HWY_ATTR vec3(const glm::vec3& all) : x(all.x), y(all.y), z(all.z) {}
};
HWY_ATTR inline vec3 operator+(const vec3& a, const vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_ATTR inline vec3 operator-(const vec3& a, const vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_ATTR inline vec3 operator*(const vec3& a, const vec3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
HWY_ATTR inline vec3 operator/(const vec3& a, const vec3& b) {
  return {a.x / b.x, a.y / b.y, a.z / b.z};
}
HWY_ATTR inline vec3 operator*(const vec3& a, vec1 b) {
  return {a.x * b, a.y * b, a.z * b};
}
HWY_ATTR inline vec3 operator/(const vec3& a, vec1 b) {
  return {a.x / b, a.y / b, a.z / b};
}

struct vec4 {
  vec1 x, y, z, w;

  vec4() = default;
  HWY_ATTR vec4(vec1 x_, vec1 y_, vec1 z_, vec1 w_) : x(x_), y(y_), z(z_), w(w_) {}
  HWY_ATTR vec4(const glm::vec4& all) : x(all.x), y(all.y), z(all.z), w(all.w) {}
};
HWY_ATTR inline vec4 operator+(const vec4& a, const vec4& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
HWY_ATTR inline vec4 operator-(const vec4& a, const vec4& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
}
HWY_ATTR inline vec4 operator*(const vec4& a, const vec4& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w};
}
HWY_ATTR inline vec4 operator*(const vec4& a, vec1 b) {
  return {a.x * b, a.y * b, a.z * b, a.w * b};
}
HWY_ATTR inline vec4 operator/(const vec4& a, vec1 b) {
  return {a.x / b, a.y / b, a.z / b, a.w / b};
}

struct uvec4 {
  uvec1 x, y, z, w;

  uvec4() = default;
  HWY_ATTR uvec4(uvec1 x_, uvec1 y_, uvec1 z_, uvec1 w_) : x(x_), y(y_), z(z_), w(w_) {}
};

HWY_ATTR inline vec2 select(bvec1 condition, const vec2& yes, const vec2& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y)};
}
HWY_ATTR inline vec3 select(bvec1 condition, const vec3& yes, const vec3& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
}
HWY_ATTR inline vec4 select(bvec1 condition, const vec4& yes, const vec4& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z),
          select(condition, yes.w, no.w)};
}
HWY_ATTR inline uvec4 select(bvec1 condition, const uvec4& yes, const uvec4& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z),
          select(condition, yes.w, no.w)};
}

// What shaders/kernel.glsl has.
HWY_ATTR inline vec3 as_vec3(const uvec4& bits) {
  return {uintBitsToFloat(bits.x), uintBitsToFloat(bits.y), uintBitsToFloat(bits.z)};
}
HWY_ATTR inline vec4 as_vec4(const uvec4& bits) {
  return {uintBitsToFloat(bits.x), uintBitsToFloat(bits.y), uintBitsToFloat(bits.z), uintBitsToFloat(bits.w)};
}
HWY_ATTR inline uvec4 as_bits(const vec3& v, uvec1 w) {
  return {floatBitsToUint(v.x), floatBitsToUint(v.y), floatBitsToUint(v.z), w};
}
HWY_ATTR inline uvec4 as_bits(const vec4& v) {
  return {floatBitsToUint(v.x), floatBitsToUint(v.y), floatBitsToUint(v.z), floatBitsToUint(v.w)};
}

// A quad a lane, from the lanes' addresses: rows to columns, in blocks of four lanes.
#if HWY_TARGET == HWY_SCALAR
HWY_ATTR inline uvec4 load_quads(const uint32_t* const* from) {
  return {from[0][0], from[0][1], from[0][2], from[0][3]};
}
#else
template <uint32_t lanes>
HWY_ATTR inline auto load_every_fourth(const uint32_t* const* from) {
  const hn::FixedTag<uint32_t, lanes> d;
  if constexpr (lanes == 4) {
    return hn::LoadU(d, *from);
  } else {
    return hn::Combine(d, load_every_fourth<lanes / 2>(from + lanes / 2), load_every_fourth<lanes / 2>(from));
  }
}

HWY_ATTR inline uvec4 load_quads(const uint32_t* const* from) {
  const Unsigneds d;
  const hn::Repartition<uint64_t, Unsigneds> pairs;
  const auto a = load_every_fourth<lane_count>(from), b = load_every_fourth<lane_count>(from + 1),
             c = load_every_fourth<lane_count>(from + 2), e = load_every_fourth<lane_count>(from + 3);
  const auto low_ab = hn::BitCast(pairs, hn::InterleaveLower(d, a, b)),
             low_ce = hn::BitCast(pairs, hn::InterleaveLower(d, c, e)),
             high_ab = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b)),
             high_ce = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
  return {hn::BitCast(d, hn::InterleaveLower(pairs, low_ab, low_ce)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, low_ab, low_ce)),
          hn::BitCast(d, hn::InterleaveLower(pairs, high_ab, high_ce)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, high_ab, high_ce))};
}
#endif

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
