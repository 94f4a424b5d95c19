// SPDX-License-Identifier: MIT
// The lowest two levels of records of boxes, like boxes_leaves, where sixteen slots are up to 4 x 4 neighbouring quads
// of a chart: 25 texels are read instead of 64, and no leaf map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/boxes.h"

QUADS(0, readonly, blocks);  // see LeafBlocks
QUADS(1, readonly, geometry);
QUADS(2, writeonly, boxes);
COUNTERS(3)
PUSH(BoxesPush, push);

#include "geometry_image/boxes.glsl"

vec3 load_point(uint texel) {
  uvec4 bits;
  LOAD4(bits, geometry, texel);
  return as_vec3(bits);
}

Bound pair_bound(vec3 a, vec3 b) {
  Bound bound;
  bound.lo = min3(a, b);
  bound.hi = max3(a, b);
  return bound;
}

// Of a row of texels each two neighbours; past the last quad, its last texel.
struct Row {
  Bound q0;
  Bound q1;
  Bound q2;
  Bound q3;
};

Row load_row(uint texel, uint width) {
  vec3 p0 = load_point(texel);
  vec3 p1 = load_point(texel + box_min(width, 1u));
  vec3 p2 = load_point(texel + box_min(width, 2u));
  vec3 p3 = load_point(texel + box_min(width, 3u));
  vec3 p4 = load_point(texel + width);
  Row row;
  row.q0 = pair_bound(p0, p1);
  row.q1 = pair_bound(p1, p2);
  row.q2 = pair_bound(p2, p3);
  row.q3 = pair_bound(p3, p4);
  return row;
}

vec3 per_step;

Box quad_box(Bound upper, Bound lower, bool there) {
  Bound bound = join(upper, lower);
  Box box = bound_box(bound.lo, bound.hi, push.grid, per_step);
  Box none = empty_box();
  box.lo = there ? box.lo : none.lo;
  box.hi = there ? box.hi : none.hi;
  return box;
}

Box store_children(uint index, Box c0, Box c1, Box c2, Box c3) {
  store_record(push.depth - 1u, index, c0, c1, c2, c3);
  return join_boxes(join_boxes(c0, c1), join_boxes(c2, c3));
}

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  per_step = vec3(1.0 / push.grid.step.x, 1.0 / push.grid.step.y, 1.0 / push.grid.step.z);
  uvec4 block;
  LOAD4(block, blocks, push.first_item + index);
  uint stride = block.z;
  uint w = block.w & 255u;
  uint h = block.w >> 8u;
  Row r0 = load_row(block.y, w);
  Row r1 = load_row(block.y + box_min(h, 1u) * stride, w);
  Row r2 = load_row(block.y + box_min(h, 2u) * stride, w);
  Box b00 = quad_box(r0.q0, r1.q0, h > 0u);
  Box b10 = quad_box(r0.q1, r1.q1, h > 0u && w > 1u);
  Box b20 = quad_box(r0.q2, r1.q2, h > 0u && w > 2u);
  Box b30 = quad_box(r0.q3, r1.q3, h > 0u && w > 3u);
  Box b01 = quad_box(r1.q0, r2.q0, h > 1u);
  Box b11 = quad_box(r1.q1, r2.q1, h > 1u && w > 1u);
  Box b21 = quad_box(r1.q2, r2.q2, h > 1u && w > 2u);
  Box b31 = quad_box(r1.q3, r2.q3, h > 1u && w > 3u);
  Box p0 = store_children(4u * block.x, b00, b10, b01, b11);
  Box p1 = store_children(4u * block.x + 1u, b20, b30, b21, b31);
  Row r3 = load_row(block.y + box_min(h, 3u) * stride, w);
  Row r4 = load_row(block.y + h * stride, w);
  Box b02 = quad_box(r2.q0, r3.q0, h > 2u);
  Box b12 = quad_box(r2.q1, r3.q1, h > 2u && w > 1u);
  Box b22 = quad_box(r2.q2, r3.q2, h > 2u && w > 2u);
  Box b32 = quad_box(r2.q3, r3.q3, h > 2u && w > 3u);
  Box b03 = quad_box(r3.q0, r4.q0, h > 3u);
  Box b13 = quad_box(r3.q1, r4.q1, h > 3u && w > 1u);
  Box b23 = quad_box(r3.q2, r4.q2, h > 3u && w > 2u);
  Box b33 = quad_box(r3.q3, r4.q3, h > 3u && w > 3u);
  Box p2 = store_children(4u * block.x + 2u, b02, b12, b03, b13);
  Box p3 = store_children(4u * block.x + 3u, b22, b32, b23, b33);
  store_record(push.depth - 2u, block.x, p0, p1, p2, p3);
  flush_counters();
}
