// SPDX-License-Identifier: MIT
// One arithmetic: the functions that built-ins do not give with equal bits on every device.
#ifndef LODESTONE_LAYOUT_ARITHMETIC_H
#define LODESTONE_LAYOUT_ARITHMETIC_H

#include "layout/types.h"

LODESTONE_LAYOUT_BEGIN

CONST float infinity_bits_as_max = 3.402823466e38f;  // the largest float: an empty bound is (+max, -max)
CONST float pi = 3.14159265f;

// Selects, not min/max: those differ between devices for NaN and for -0 against +0.
FN float min2(float a, float b) {
  return b < a ? b : a;
}
FN float max2(float a, float b) {
  return a < b ? b : a;
}
FN float clamp1(float x, float lo, float hi) {
  return min2(max2(x, lo), hi);
}
FN float saturate(float x) {
  return min2(max2(x, 0.0f), 1.0f);
}
FN float abs1(float x) {
  return x < 0.0f ? -x : x;
}
FN vec3 min3(vec3 a, vec3 b) {
  return vec3(min2(a.x, b.x), min2(a.y, b.y), min2(a.z, b.z));
}
FN vec3 max3(vec3 a, vec3 b) {
  return vec3(max2(a.x, b.x), max2(a.y, b.y), max2(a.z, b.z));
}
FN float max_component(vec3 a) {
  return max2(a.x, max2(a.y, a.z));
}
FN float largest_abs(vec3 a) {
  return max_component(vec3(abs1(a.x), abs1(a.y), abs1(a.z)));
}
FN float dot3(vec3 a, vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
FN vec3 cross3(vec3 a, vec3 b) {
  return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
FN vec3 mix3(vec3 a, vec3 b, float t) {
  return a * (1.0f - t) + b * t;
}

// Values nearer to zero than 2^-60 become +0, so that no product of two of them is denormal (devices differ
// there).
FN float flush_tiny(float x) {
  return abs1(x) < 8.673617e-19f ? 0.0f : x;
}
FN vec3 flush_tiny3(vec3 v) {
  return vec3(flush_tiny(v.x), flush_tiny(v.y), flush_tiny(v.z));
}

// What is too small for the flushing of a product somewhere behind it to leave its bits alone becomes +0.
FN float flush_lost(float x) {
  return abs1(x) < 1e-30f ? 0.0f : x;
}

// v / |v|; `fallback` where v is too short to have a direction.
FN vec3 normalize_or(vec3 v, vec3 fallback) {
  v = vec3(flush_lost(v.x), flush_lost(v.y), flush_lost(v.z));
  float scale = largest_abs(v);
  if (!(scale > 0.0f)) return fallback;
  vec3 s = vec3(v.x / scale, v.y / scale, v.z / scale);
  float length = sqrt(dot3(s, s));
  return flush_tiny3(vec3(s.x / length, s.y / length, s.z / length));
}

// 2^x for x in [-100, 100]; relative error below 2e-7. A polynomial on [-0.5, 0.5] times a power of two by
// bits.
FN float exp2_(float x) {
  x = clamp1(x, -100.0f, 100.0f);
  float whole = floor(x + 0.5f);
  float f = x - whole;
  float p = 1.5403530e-4f;
  p = p * f + 1.3333558e-3f;
  p = p * f + 9.6181291e-3f;
  p = p * f + 5.5504109e-2f;
  p = p * f + 2.4022651e-1f;
  p = p * f + 6.9314718e-1f;
  p = p * f + 1.0f;
  return p * uintBitsToFloat(uint(int(whole) + 127) << 23u);
}

// log2(x) for normal x > 0; absolute error below 1e-6. The mantissa in [sqrt(1/2), sqrt(2)) by an odd series.
FN float log2_(float x) {
  uint bits = floatBitsToUint(x);
  int exponent = int(bits >> 23u) - 127;
  float m = uintBitsToFloat((bits & 0x7fffffu) | 0x3f800000u);
  if (m > 1.41421356f) {
    m = m * 0.5f;
    exponent = exponent + 1;
  }
  float s = (m - 1.0f) / (m + 1.0f);
  float s2 = s * s;
  float p = 0.32062f;
  p = p * s2 + 0.41219858f;
  p = p * s2 + 0.57707802f;
  p = p * s2 + 0.96179669f;
  p = p * s2 + 2.8853901f;
  return s * p + float(exponent);
}

FN float pow_(float x, float y) {
  return x <= 0.0f ? 0.0f : exp2_(y * log2_(x));
}

// (cos, sin) of 2 pi x; absolute error below 1e-6.
FN vec2 cos_sin_turns(float x) {
  float f = x - floor(x + 0.5f);            // [-0.5, 0.5] turns
  float q = floor(f * 4.0f + 0.5f);         // nearest quarter
  float r = (f - q * 0.25f) * 6.28318531f;  // [-pi/4, pi/4]
  float r2 = r * r;
  float s = r * (1.0f + r2 * (-1.6666667e-1f + r2 * (8.3333310e-3f + r2 * -1.9840874e-4f)));
  float c = 1.0f + r2 * (-0.5f + r2 * (4.1666642e-2f + r2 * (-1.3888397e-3f + r2 * 2.4760495e-5f)));
  int quarter = int(q) & 3;
  if (quarter == 0) return vec2(c, s);
  if (quarter == 1) return vec2(-s, c);
  if (quarter == 2) return vec2(-c, -s);
  return vec2(s, -c);
}

FN float linear_to_srgb(float x) {
  return x <= 0.0031308f ? 12.92f * max2(x, 0.0f) : 1.055f * pow_(x, 0.41666667f) - 0.055f;
}

LODESTONE_LAYOUT_END
#endif
