// SPDX-License-Identifier: MIT
// The lowest two levels of the min/max pyramid: each invocation bounds four quads and their parent.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/bounds.h"
#include "layout/frame.h"

WORDS(0, readonly, leaf_map);
QUADS(1, readonly, geometry);
QUADS(2, writeonly, nodes_lo);
QUADS(3, writeonly, nodes_hi);
COUNTERS(4)
PUSH(BoundsPush, push);
layout(constant_id = 2) const uint moving = 0u;  // 1: bounds hold the quads of both images

Bound bound_quad(uint texel, uint stride) {
  uvec4 a;
  uvec4 b;
  uvec4 c;
  uvec4 d;
  LOAD4(a, geometry, texel);
  LOAD4(b, geometry, texel + 1u);
  LOAD4(c, geometry, texel + stride);
  LOAD4(d, geometry, texel + stride + 1u);
  return quad_bound(as_vec3(a), as_vec3(b), as_vec3(c), as_vec3(d));
}

Bound bound_leaf(uint slot) {
  Bound bound = empty_bound();
  uint texel = empty_slot;
  uint stride = 0u;
  if (slot < push.count) {
    LOAD1(texel, leaf_map, 2u * (push.first_slot + slot));
    LOAD1(stride, leaf_map, 2u * (push.first_slot + slot) + 1u);
  }
  if (texel != empty_slot) {
    bound = bound_quad(push.image + texel, stride);
    if (moving != 0u) bound = join(bound, bound_quad(push.next_image + texel, stride));
  }
  if (slot < push.written) {
    uint address = push.first_node + level_base(push.depth) + slot;
    STORE4(nodes_lo, address, as_bits(bound.lo, leaf_flag | texel));
    STORE4(nodes_hi, address, as_bits(bound.hi, stride));
  }
  return bound;
}

void main() {
  uint index = invocation();
  if (index >= push.written_above) return;
  Bound c0 = bound_leaf(4u * index);
  Bound c1 = bound_leaf(4u * index + 1u);
  Bound c2 = bound_leaf(4u * index + 2u);
  Bound c3 = bound_leaf(4u * index + 3u);
  Bound parent = join(join(c0, c1), join(c2, c3));
  uint address = push.first_node + level_base(push.depth - 1u) + index;
  STORE4(nodes_lo, address, as_bits(parent.lo, child_order(c0, c1, c2, c3)));
  STORE4(nodes_hi, address, as_bits(parent.hi, 0u));
  flush_counters();
}
