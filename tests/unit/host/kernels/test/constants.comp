// SPDX-License-Identifier: MIT
// What the kernel was specialized with.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

layout(constant_id = 2) const uint first = 0u;
layout(constant_id = 3) const uint second = 0u;
layout(constant_id = 4) const uint third = 0u;
layout(constant_id = 5) const uint fourth = 0u;

WORDS(0, writeonly, results);
COUNTERS(1)

void main() {
  if (invocation() != 0u) return;
  RAW_STORE1(results, 0, gl_WorkGroupSize.x);
  RAW_STORE1(results, 1, counting);
  RAW_STORE1(results, 2, first);
  RAW_STORE1(results, 3, second);
  RAW_STORE1(results, 4, third);
  RAW_STORE1(results, 5, fourth);
}
