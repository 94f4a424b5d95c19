// SPDX-License-Identifier: MIT
// Levels of detail: where nodes are, and their errors, a level a dispatch, finer ones first.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/atlas.h"
#include "layout/detail_nodes.h"

QUADS(0, readonly, coarse_nodes);
QUADS(1, readonly, geometry);
WORDS(2, readonly, collapses);
WORDS(3, readonly, points);
QUADS(4, restrict, node_details);
STRUCTS(5, restrict, uint, radii);  // float bits, which order like integers
COUNTERS(6)
PUSH(DetailPush, push);

#define RADIUS(point) uintBitsToFloat(radii[point])
#define RAISE(point, radius) atomicMax(radii[point], floatBitsToUint(radius))
#include "layout/coarse_nodes.h"

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  measure_node(push.first + index);
  flush_counters();
}
