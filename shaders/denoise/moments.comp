// SPDX-License-Identifier: MIT
// Squares of what each sample of a pixel was, added up: two quads a ray, { sum R G B, 0 } and the radiance of all samples so
// far, which tells the next one apart from them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/denoise.h"

QUADS(0, readonly, radiance);
QUADS(1, restrict, moments);
COUNTERS(2)
PUSH(MomentsPush, push);

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  uvec4 now;
  LOAD4(now, radiance, index);
  vec3 added = as_vec3(now);
  vec3 squares = vec3(0.0);
  if (push.first == 0u) {
    uvec4 before;
    LOAD4(before, moments, 2u * index + 1u);
    added = added - as_vec3(before);
    LOAD4(before, moments, 2u * index);
    squares = as_vec3(before);
  }
  STORE4(moments, 2u * index, as_bits(squares + flush_lost3(added * added), 0u));
  STORE4(moments, 2u * index + 1u, now);
  flush_counters();
}
