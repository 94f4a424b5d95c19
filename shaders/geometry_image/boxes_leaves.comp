// SPDX-License-Identifier: MIT
// The lowest two levels of records of boxes: each invocation bounds sixteen quads, and the four nodes above them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/boxes.h"

WORDS(0, readonly, leaf_map);
QUADS(1, readonly, geometry);
QUADS(2, writeonly, boxes);
WORDS(3, readonly, groups);          // of sixteen slots: those that boxes_blocks leaves
COUNTERS(4)
PUSH(BoxesPush, push);
layout(constant_id = 2) const uint moving = 0u;  // 1: bounds hold the quads of both images

#include "geometry_image/boxes.glsl"

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

Box bound_leaf(uint slot, vec3 per_step) {
  uint texel = empty_slot;
  uint stride = 0u;
  if (slot < push.count) {
    LOAD1(texel, leaf_map, 2u * (push.first_slot + slot));
    LOAD1(stride, leaf_map, 2u * (push.first_slot + slot) + 1u);
  }
  Box box = empty_box();
  if (texel != empty_slot) {
    Bound bound = bound_quad(push.image + texel, stride);
    if (moving != 0u) bound = join(bound, bound_quad(push.next_image + texel, stride));
    box = bound_box(bound.lo, bound.hi, push.grid, per_step);
  }
  return box;
}

Box bound_record(uint index, vec3 per_step) {
  Box c0 = bound_leaf(4u * index, per_step);
  Box c1 = bound_leaf(4u * index + 1u, per_step);
  Box c2 = bound_leaf(4u * index + 2u, per_step);
  Box c3 = bound_leaf(4u * index + 3u, per_step);
  if (index < push.written) store_record(push.depth - 1u, index, c0, c1, c2, c3);
  return join_boxes(join_boxes(c0, c1), join_boxes(c2, c3));
}

void main() {
  uint index = invocation();
  vec3 per_step = vec3(1.0 / push.grid.step.x, 1.0 / push.grid.step.y, 1.0 / push.grid.step.z);
  if (push.depth == 1u) {  // a tree of one record
    if (index < push.written) bound_record(index, per_step);
  } else if (index < push.written_above) {
    uint group;
    LOAD1(group, groups, push.first_item + index);
    Box p0 = bound_record(4u * group, per_step);
    Box p1 = bound_record(4u * group + 1u, per_step);
    Box p2 = bound_record(4u * group + 2u, per_step);
    Box p3 = bound_record(4u * group + 3u, per_step);
    store_record(push.depth - 2u, group, p0, p1, p2, p3);
  }
  flush_counters();
}
