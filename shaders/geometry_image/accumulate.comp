// SPDX-License-Identifier: MIT
// Adds a light's contribution where its shadow ray hit nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/atlas.h"
#include "layout/frame.h"

QUADS(0, readonly, shadow_hits);
QUADS(1, readonly, contributions);
QUADS(2, restrict, radiance);
WORDS(3, readonly, ray_list);
COUNTERS(4)
PUSH(CountPush, push);
layout(constant_id = 2) const uint listed = 0u;  // 1: only for those rays

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  if (listed != 0u) LOAD1(index, ray_list, index + 1u);
  uvec4 hit;
  LOAD4(hit, shadow_hits, index);
  if (hit.w == no_index) {
    uvec4 contribution;
    uvec4 before;
    LOAD4(contribution, contributions, index);
    LOAD4(before, radiance, index);
    STORE4(radiance, index, as_bits(as_vec3(before) + as_vec3(contribution), before.w));
  }
  flush_counters();
}
