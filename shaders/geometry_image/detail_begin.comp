// SPDX-License-Identifier: MIT
// The radii of points before any node has raised them; of those that never collapse for good.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/atlas.h"
#include "layout/detail_nodes.h"

WORDS(0, readonly, collapses);
STRUCTS(1, restrict, uint, radii);  // one a texel, of points
COUNTERS(2)
PUSH(CountPush, push);

void main() {
  uint texel = invocation();
  if (texel >= push.count) return;
  uint parent;
  LOAD1(parent, collapses, 2u * texel);
  radii[texel] = floatBitsToUint(parent == texel ? fixed_radius : least_radius);
  flush_counters();
}
