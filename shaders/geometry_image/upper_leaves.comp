// SPDX-License-Identifier: MIT
// The lowest records of boxes of the tree over instances: each invocation takes four of them in the order of their keys.
// The levels above are made by `boxes`.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/objects.h"

WORDS(0, readonly, keys);
QUADS(1, readonly, instance_lo);
QUADS(2, readonly, instance_hi);
QUADS(3, writeonly, boxes);
COUNTERS(4)
PUSH(BoxesPush, push);

#include "geometry_image/boxes.glsl"

Box leaf_box(uint leaf, vec3 per_step) {
  Box box = empty_box();
  if (leaf < push.count) {
    uint instance;
    uvec4 lo;
    uvec4 hi;
    LOAD1(instance, keys, 2u * leaf + 1u);
    LOAD4(lo, instance_lo, instance);
    LOAD4(hi, instance_hi, instance);
    if (uintBitsToFloat(lo.x) <= uintBitsToFloat(hi.x)) box = bound_box(as_vec3(lo), as_vec3(hi), push.grid, per_step);
  }
  return box;
}

void main() {
  uint index = invocation();
  if (index >= push.written) return;
  vec3 per_step = vec3(1.0 / push.grid.step.x, 1.0 / push.grid.step.y, 1.0 / push.grid.step.z);
  store_record(push.depth - 1u, index, leaf_box(4u * index, per_step), leaf_box(4u * index + 1u, per_step),
               leaf_box(4u * index + 2u, per_step), leaf_box(4u * index + 3u, per_step));
  flush_counters();
}
