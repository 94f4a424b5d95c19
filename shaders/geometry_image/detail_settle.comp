// SPDX-License-Identifier: MIT
// Levels of detail: the tolerances of nodes and the radii of their corners, a step a dispatch.
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
WORDS(6, readonly, coarse_order);
COUNTERS(7)
PUSH(DetailPush, push);

#define RADIUS(point) uintBitsToFloat(radii[point])
#define RAISE(point, radius) atomicMax(radii[point], floatBitsToUint(radius))
#include "layout/coarse_nodes.h"

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uint node;
  LOAD1(node, coarse_order, push.first + index);
  settle_node(node, push.steepest);
  flush_counters();
}
