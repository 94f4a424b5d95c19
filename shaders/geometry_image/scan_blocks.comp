// SPDX-License-Identifier: MIT
// Where the rays of each block go when those that go on are put one after the other: one invocation, for there are few
// blocks. Leaves the counts zero for the next round.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/objects.h"

STRUCTS(0, restrict, uint, block_counts);
WORDS(1, writeonly, block_starts);
STRUCTS(2, restrict, uint, entered);
COUNTERS(3)
PUSH(CountPush, push);

void main() {
  if (invocation() != 0u) return;
  uint sum = 0u;
  for (uint block = 0u; block < push.count; ++block) {
    uint count = block_counts[block];
    block_counts[block] = 0u;
    STORE1(block_starts, block, sum);
    sum += count;
  }
  entered[0] = sum;
  flush_counters();
}
