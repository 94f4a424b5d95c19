// SPDX-License-Identifier: MIT
// What "one arithmetic" rests on: every operation that kernels use, applied to bit patterns. Compiled as GLSL
// by the conformance kernel and as C++ by whoever compares with it.
#ifndef LODESTONE_CONFORMANCE_OPERATIONS_H
#define LODESTONE_CONFORMANCE_OPERATIONS_H

#include "layout/arithmetic.h"
#include "layout/types.h"

LODESTONE_LAYOUT_BEGIN

CONST uint op_add = 0u;
CONST uint op_subtract = 1u;
CONST uint op_multiply = 2u;
CONST uint op_divide = 3u;
CONST uint op_sqrt = 4u;
CONST uint op_floor = 5u;
CONST uint op_negate = 6u;
CONST uint op_less = 7u;
CONST uint op_less_equal = 8u;
CONST uint op_equal = 9u;
CONST uint op_not_equal = 10u;
CONST uint op_smaller = 11u;  // b < a ? b : a
CONST uint op_larger = 12u;   // a < b ? b : a
CONST uint op_multiply_add = 13u;
CONST uint op_dot = 14u;
CONST uint op_cross = 15u;
CONST uint op_to_uint = 16u;    // of |x| below 2^31
CONST uint op_to_int = 17u;     // of |x| below 2^31
CONST uint op_from_uint = 18u;  // of values below 2^24
CONST uint op_from_int = 19u;
CONST uint op_round_trip = 20u;
CONST uint op_divide_uint = 21u;
CONST uint op_shift_int = 22u;
CONST uint op_bits = 23u;
CONST uint op_half = 24u;
CONST uint op_reciprocal = 25u;
CONST uint op_normalize = 26u;
CONST uint op_exp2 = 27u;
CONST uint op_log2 = 28u;
CONST uint op_cos_sin = 29u;
CONST uint op_atan2 = 30u;
CONST uint op_count = 31u;

// A denormal, and the smallest normal number with it (a device that flushes decides before it rounds), as a
// zero of the same sign.
FN uvec1 flush_bits(uvec1 bits) {
  return select((bits & 0x7fffffffu) < 0x00800001u, bits & 0x80000000u, bits);
}

FN uvec1 mix_bits(vec3 v) {
  return floatBitsToUint(v.x) ^ (floatBitsToUint(v.y) * 3u) ^ (floatBitsToUint(v.z) * 5u);
}

FN uvec1 apply_integer(uint op, uvec4 u) {
  if (op == op_from_uint) return floatBitsToUint(vec1(u.x >> 8u));
  if (op == op_from_int) return floatBitsToUint(vec1(ivec1(u.x)));
  if (op == op_divide_uint) return u.x / (u.y | 1u) ^ u.x % (u.z | 1u);
  if (op == op_shift_int) return uvec1(ivec1(u.x) >> (u.y & 31u));
  return uvec1(findMSB(u.x)) ^ (uvec1(findLSB(u.y)) << 8u) ^ (uvec1(bitCount(u.z)) << 16u) ^
         bitfieldReverse(u.w);
}

FN uvec1 apply_function(uint op, vec1 x, vec1 y, vec1 z) {
  if (op == op_normalize) return mix_bits(normalize_or(vec3(x, y, z), vec3(1.0f, 2.0f, 3.0f)));
  if (op == op_exp2) return floatBitsToUint(exp2_(x));
  if (op == op_log2) return floatBitsToUint(log2_(select(x < 1e-30f, 2.0f, x)));
  if (op == op_atan2) return floatBitsToUint(atan2_turns(x, y));
  vec2 cs = cos_sin_turns(select(x < 1e6f, select(x > -1e6f, x, 0.25f), 0.5f));
  return floatBitsToUint(cs.x) ^ (floatBitsToUint(cs.y) * 3u);
}

FN uvec1 apply_comparison(uint op, vec1 x, vec1 y) {
  if (op == op_less) return select(x < y, 1u, 0u);
  if (op == op_less_equal) return select(x <= y, 1u, 0u);
  if (op == op_equal) return select(x == y, 1u, 0u);
  if (op == op_not_equal) return select(x != y, 1u, 0u);
  if (op == op_smaller) return floatBitsToUint(min2(x, y));
  return floatBitsToUint(max2(x, y));
}

FN bvec1 in_int_range(vec1 x) {
  return x > -2147483648.0f && x < 2147483648.0f;
}

// The result of operation `op` on the bits of up to four operands.
FN uvec1 apply_operation(uint op, uvec4 u) {
  vec1 x = uintBitsToFloat(u.x);
  vec1 y = uintBitsToFloat(u.y);
  vec1 z = uintBitsToFloat(u.z);
  vec1 w = uintBitsToFloat(u.w);
  if (op == op_add) return floatBitsToUint(x + y);
  if (op == op_subtract) return floatBitsToUint(x - y);
  if (op == op_multiply) return floatBitsToUint(x * y);
  if (op == op_divide) return floatBitsToUint(x / y);
  if (op == op_sqrt) return floatBitsToUint(sqrt(x));
  if (op == op_floor) return floatBitsToUint(floor(x));
  if (op == op_negate) return floatBitsToUint(-x);
  if (op >= op_less && op <= op_larger) return apply_comparison(op, x, y);
  if (op == op_multiply_add) return floatBitsToUint(x * y + z);
  if (op == op_dot) return floatBitsToUint(dot3(vec3(x, y, z), vec3(w, x, y)));
  if (op == op_cross) return mix_bits(cross3(vec3(x, y, z), vec3(w, x, y)));
  if (op == op_to_uint) return select(in_int_range(x), uvec1(abs1(select(in_int_range(x), x, 0.0f))), 7u);
  if (op == op_to_int) return select(in_int_range(x), uvec1(ivec1(select(in_int_range(x), x, 0.0f))), 7u);
  if (op == op_round_trip) return floatBitsToUint(x);
  if (op == op_half) return floatBitsToUint(x * 0.5f);
  if (op == op_reciprocal) return floatBitsToUint(1.0f / x);
  if (op >= op_normalize) return apply_function(op, x, y, z);
  return apply_integer(op, u);
}

LODESTONE_LAYOUT_END
#endif
