// SPDX-License-Identifier: MIT
// Invocation i counts i + 1 rays and two of each other counter.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

COUNTERS(0)

struct Push {
  uint count;
};
PUSH(Push, push);

void main() {
  uint i = invocation();
  if (i >= push.count) return;
  count_read(3u);
  count_write(2u);
  flush_counters();
  if (counting == 0u) return;
  atomicAdd(counters[counter_rays], i + 1u);
  atomicAdd(counters[counter_node_visits], 2u);
  atomicAdd(counters[counter_box_tests], 3u);
  atomicAdd(counters[counter_triangle_tests], 4u);
  atomicAdd(counters[counter_lane_steps], 5u);
  atomicAdd(counters[counter_subgroup_steps], 6u);
}
