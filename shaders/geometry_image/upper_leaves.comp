// SPDX-License-Identifier: MIT
// The lowest two levels of the tree over instances: each invocation takes four of them, in the order of their keys, and
// their parent. The levels above are made by `bounds`.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/objects.h"

WORDS(0, readonly, keys);
QUADS(1, readonly, instance_lo);
QUADS(2, readonly, instance_hi);
QUADS(3, writeonly, upper_lo);
QUADS(4, writeonly, upper_hi);
COUNTERS(5)
PUSH(UpperPush, push);

Bound bound_leaf(uint leaf) {
  Bound bound = empty_bound();
  uint instance = empty_slot;
  if (leaf < push.instances) {
    LOAD1(instance, keys, 2u * leaf + 1u);
    uvec4 lo;
    uvec4 hi;
    LOAD4(lo, instance_lo, instance);
    LOAD4(hi, instance_hi, instance);
    bound.lo = as_vec3(lo);
    bound.hi = as_vec3(hi);
  }
  uint address = level_base(push.depth) + leaf;
  STORE4(upper_lo, address, as_bits(bound.lo, leaf_flag | instance));
  STORE4(upper_hi, address, as_bits(bound.hi, 0u));
  return bound;
}

void main() {
  uint index = invocation();
  if (index >= push.parents) return;
  Bound c0 = bound_leaf(4u * index);
  Bound c1 = bound_leaf(4u * index + 1u);
  Bound c2 = bound_leaf(4u * index + 2u);
  Bound c3 = bound_leaf(4u * index + 3u);
  Bound parent = join(join(c0, c1), join(c2, c3));
  uint address = level_base(push.depth - 1u) + index;
  STORE4(upper_lo, address, as_bits(parent.lo, child_order(c0, c1, c2, c3)));
  STORE4(upper_hi, address, as_bits(parent.hi, 0u));
  flush_counters();
}
