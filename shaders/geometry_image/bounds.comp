// SPDX-License-Identifier: MIT
// One level of the min/max pyramid from the one below, or two.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/bounds.h"
#include "layout/frame.h"

QUADS(0, restrict, nodes_lo);
QUADS(1, restrict, nodes_hi);
COUNTERS(2)
PUSH(BoundsPush, push);

Bound load_bound(uint index) {
  Bound bound = empty_bound();
  if (index < push.count) {
    uvec4 lo;
    uvec4 hi;
    uint address = push.first_node + level_base(push.depth) + index;
    LOAD4(lo, nodes_lo, address);
    LOAD4(hi, nodes_hi, address);
    bound.lo = as_vec3(lo);
    bound.hi = as_vec3(hi);
  }
  return bound;
}

Bound bound_parent(uint index) {
  Bound c0 = load_bound(4u * index);
  Bound c1 = load_bound(4u * index + 1u);
  Bound c2 = load_bound(4u * index + 2u);
  Bound c3 = load_bound(4u * index + 3u);
  Bound parent = join(join(c0, c1), join(c2, c3));
  if (index < push.written) {
    uint address = push.first_node + level_base(push.depth - 1u) + index;
    STORE4(nodes_lo, address, as_bits(parent.lo, child_order(c0, c1, c2, c3)));
    STORE4(nodes_hi, address, as_bits(parent.hi, 0u));
  }
  return parent;
}

void main() {
  uint index = invocation();
  if (push.written_above == 0u) {  // one level: an invocation a parent
    if (index < push.written) bound_parent(index);
  } else if (index < push.written_above) {
    Bound p0 = bound_parent(4u * index);
    Bound p1 = bound_parent(4u * index + 1u);
    Bound p2 = bound_parent(4u * index + 2u);
    Bound p3 = bound_parent(4u * index + 3u);
    Bound above = join(join(p0, p1), join(p2, p3));
    uint address = push.first_node + level_base(push.depth - 2u) + index;
    STORE4(nodes_lo, address, as_bits(above.lo, child_order(p0, p1, p2, p3)));
    STORE4(nodes_hi, address, as_bits(above.hi, 0u));
  }
  flush_counters();
}
