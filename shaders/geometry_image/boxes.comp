// SPDX-License-Identifier: MIT
// One level of records of boxes from the one below, or two. All planes are whole numbers already.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/boxes.h"

QUADS(0, restrict, boxes);
COUNTERS(1)
PUSH(BoxesPush, push);

#include "geometry_image/boxes.glsl"

Box load_box(uint index) {
  Box box = empty_box();
  if (index < push.count) {
    uint record = 3u * (push.first_node + level_base(push.depth) + index);
    uvec4 x;
    uvec4 y;
    uvec4 z;
    LOAD4(x, boxes, record);
    LOAD4(y, boxes, record + 1u);
    LOAD4(z, boxes, record + 2u);
    box = record_box(x, y, z);
  }
  return box;
}

Box bound_record(uint index) {
  Box c0 = load_box(4u * index);
  Box c1 = load_box(4u * index + 1u);
  Box c2 = load_box(4u * index + 2u);
  Box c3 = load_box(4u * index + 3u);
  if (index < push.written) store_record(push.depth - 1u, index, c0, c1, c2, c3);
  return join_boxes(join_boxes(c0, c1), join_boxes(c2, c3));
}

void main() {
  uint index = invocation();
  if (push.written_above == 0u) {
    if (index < push.written) bound_record(index);
  } else if (index < push.written_above) {
    Box p0 = bound_record(4u * index);
    Box p1 = bound_record(4u * index + 1u);
    Box p2 = bound_record(4u * index + 2u);
    Box p3 = bound_record(4u * index + 3u);
    store_record(push.depth - 2u, index, p0, p1, p2, p3);
  }
  flush_counters();
}
