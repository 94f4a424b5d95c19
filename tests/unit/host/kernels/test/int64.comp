// SPDX-License-Identifier: MIT
// Needs 64-bit integers, which not every device has.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "kernel.glsl"

WORDS(0, , results);
COUNTERS(1)

void main() {
  if (invocation() != 0u) return;
  uint64_t product = uint64_t(RAW_LOAD1(results, 0)) * uint64_t(RAW_LOAD1(results, 1));
  RAW_STORE1(results, 0, uint(product >> 32));
}
