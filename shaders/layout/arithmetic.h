// SPDX-License-Identifier: MIT
// One arithmetic: the functions that built-ins do not give with equal bits on every device.
#ifndef LODESTONE_LAYOUT_ARITHMETIC_H
#define LODESTONE_LAYOUT_ARITHMETIC_H

#include "layout/types.h"

LODESTONE_LAYOUT_BEGIN

CONST float infinity_bits_as_max = 3.402823466e38f;  // the largest float: an empty bound is (+max, -max)
CONST float pi = 3.14159265f;

// Selects, not min/max: those differ between devices for NaN and for -0 against +0.
FN vec1 min2(vec1 a, vec1 b) {
  return select(b < a, b, a);
}
FN vec1 max2(vec1 a, vec1 b) {
  return select(a < b, b, a);
}
FN vec1 clamp1(vec1 x, vec1 lo, vec1 hi) {
  return min2(max2(x, lo), hi);
}
FN vec1 saturate(vec1 x) {
  return min2(max2(x, 0.0f), 1.0f);
}
FN vec1 abs1(vec1 x) {
  vec1 negated = -x;  // a name, for which a compiler needs no branch
  return select(x < 0.0f, negated, x);
}
FN vec3 min3(vec3 a, vec3 b) {
  return vec3(min2(a.x, b.x), min2(a.y, b.y), min2(a.z, b.z));
}
FN vec3 max3(vec3 a, vec3 b) {
  return vec3(max2(a.x, b.x), max2(a.y, b.y), max2(a.z, b.z));
}
FN vec1 max_component(vec3 a) {
  return max2(a.x, max2(a.y, a.z));
}
FN vec1 largest_abs(vec3 a) {
  return max_component(vec3(abs1(a.x), abs1(a.y), abs1(a.z)));
}
FN vec1 dot3(vec3 a, vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
FN vec3 cross3(vec3 a, vec3 b) {
  return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
FN vec3 mix3(vec3 a, vec3 b, vec1 t) {
  return a * (1.0f - t) + b * t;
}

// Values nearer to zero than 2^-60 become +0, so that no product of two of them is denormal (devices differ
// there).
FN vec1 flush_tiny(vec1 x) {
  return select(abs1(x) < 8.673617e-19f, 0.0f, x);
}
FN vec3 flush_tiny3(vec3 v) {
  return vec3(flush_tiny(v.x), flush_tiny(v.y), flush_tiny(v.z));
}

// What is too small for the flushing of a product somewhere behind it to leave its bits alone becomes +0.
FN vec1 flush_lost(vec1 x) {
  return select(abs1(x) < 1e-30f, 0.0f, x);
}

FN vec3 flush_lost3(vec3 v) {
  return vec3(flush_lost(v.x), flush_lost(v.y), flush_lost(v.z));
}

// v / |v|; `fallback` where v is too short to have a direction.
FN vec3 normalize_or(vec3 v, vec3 fallback) {
  v = flush_lost3(v);
  vec1 scale = largest_abs(v);
  vec3 s = vec3(v.x / scale, v.y / scale, v.z / scale);
  vec1 length = sqrt(dot3(s, s));
  vec3 unit = flush_tiny3(vec3(s.x / length, s.y / length, s.z / length));
  return select(scale > 0.0f, unit, fallback);
}

// 2^x for x in [-100, 100]; relative error below 2e-7. A polynomial on [-0.5, 0.5] times a power of two by
// bits.
FN vec1 exp2_(vec1 x) {
  x = clamp1(x, -100.0f, 100.0f);
  vec1 whole = floor(x + 0.5f);
  vec1 f = x - whole;
  vec1 p = 1.5403530e-4f;
  p = p * f + 1.3333558e-3f;
  p = p * f + 9.6181291e-3f;
  p = p * f + 5.5504109e-2f;
  p = p * f + 2.4022651e-1f;
  p = p * f + 6.9314718e-1f;
  p = p * f + 1.0f;
  return p * uintBitsToFloat(uvec1(ivec1(whole) + 127) << 23u);
}

// log2(x) for normal x > 0; absolute error below 1e-6. The mantissa in [sqrt(1/2), sqrt(2)) by an odd series.
FN vec1 log2_(vec1 x) {
  uvec1 bits = floatBitsToUint(x);
  ivec1 exponent = ivec1(bits >> 23u) - 127;
  vec1 m = uintBitsToFloat((bits & 0x7fffffu) | 0x3f800000u);
  bvec1 upper = m > 1.41421356f;
  m = select(upper, m * 0.5f, m);
  exponent = select(upper, exponent + 1, exponent);
  vec1 s = (m - 1.0f) / (m + 1.0f);
  vec1 s2 = s * s;
  vec1 p = 0.32062f;
  p = p * s2 + 0.41219858f;
  p = p * s2 + 0.57707802f;
  p = p * s2 + 0.96179669f;
  p = p * s2 + 2.8853901f;
  return s * p + vec1(exponent);
}

FN vec1 pow_(vec1 x, vec1 y) {
  return select(x <= 0.0f, 0.0f, exp2_(y * log2_(x)));
}

// (cos, sin) of 2 pi x; absolute error below 1e-6.
FN vec2 cos_sin_turns(vec1 x) {
  vec1 f = x - floor(x + 0.5f);            // [-0.5, 0.5] turns
  vec1 q = floor(f * 4.0f + 0.5f);         // nearest quarter
  vec1 r = (f - q * 0.25f) * 6.28318531f;  // [-pi/4, pi/4]
  vec1 r2 = r * r;
  vec1 s = r * (1.0f + r2 * (-1.6666667e-1f + r2 * (8.3333310e-3f + r2 * -1.9840874e-4f)));
  vec1 c = 1.0f + r2 * (-0.5f + r2 * (4.1666642e-2f + r2 * (-1.3888397e-3f + r2 * 2.4760495e-5f)));
  ivec1 quarter = ivec1(q) & 3;
  bvec1 odd = (quarter & 1) != 0;
  vec1 across = select(odd, s, c);
  vec1 up = select(odd, c, s);
  return vec2(select(quarter == 1 || quarter == 2, -across, across), select(quarter >= 2, -up, up));
}

// The angle of (x, y) from the x axis towards the y axis in turns, in [-0.5, 0.5]; absolute error below 1e-7
// (6.3e-7 radians). 0 for (0, 0), and 0.5 for -x whatever the sign of a zero y.
FN vec1 atan2_turns(vec1 y, vec1 x) {
  vec1 across = abs1(flush_lost(x));
  vec1 up = abs1(flush_lost(y));
  bvec1 steep = up > across;
  vec1 low = select(steep, across, up);
  vec1 high = select(steep, up, across);
  // An eighth of a turn has a tangent of 1: between a sixteenth and that, tan(a - 1/8) instead.
  bvec1 near_diagonal = low > high * 0.41421356f;
  vec1 difference = low - high;
  vec1 sum = low + high;
  vec1 divisor = select(near_diagonal, sum, high);
  vec1 t = select(near_diagonal, difference, low) / select(divisor > 0.0f, divisor, 1.0f);
  // The odd polynomial of least greatest error, 6e-10, on [-tan(pi/8), tan(pi/8)].
  vec1 t2 = t * t;
  vec1 p = 1.23099365e-2f;
  p = p * t2 - 2.18914662e-2f;
  p = p * t2 + 3.17704558e-2f;
  p = p * t2 - 5.30498505e-2f;
  p = p * t2 + 1.59154928e-1f;
  p = p * t;
  vec1 angle = select(near_diagonal, 0.125f + p, p);
  vec1 complement = 0.25f - angle;
  angle = select(steep, complement, angle);
  vec1 supplement = 0.5f - angle;
  angle = select(x < 0.0f, supplement, angle);
  vec1 negated = -angle;
  return select(y < 0.0f, negated, angle);
}

FN vec1 luminance(vec3 color) {
  return color.x * 0.2126f + color.y * 0.7152f + color.z * 0.0722f;
}

FN vec1 linear_to_srgb(vec1 x) {
  return select(x <= 0.0031308f, 12.92f * max2(x, 0.0f), 1.055f * pow_(x, 0.41666667f) - 0.055f);
}

LODESTONE_LAYOUT_END
#endif
