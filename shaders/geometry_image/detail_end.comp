// SPDX-License-Identifier: MIT
// The radius of each texel, which is that of its point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/atlas.h"
#include "layout/detail_nodes.h"

WORDS(0, restrict, collapses);
WORDS(1, readonly, points);
STRUCTS(2, restrict, uint, radii);
COUNTERS(3)
PUSH(CountPush, push);

void main() {
  uint texel = invocation();
  if (texel >= push.count) return;
  uint point;
  LOAD1(point, points, texel);
  STORE1(collapses, 2u * texel + 1u, radii[point]);
  flush_counters();
}
