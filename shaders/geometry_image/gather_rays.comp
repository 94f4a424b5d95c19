// SPDX-License-Identifier: MIT
// The numbers of the rays that go on, in order, a block of rays an invocation: the same list whatever runs first.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/objects.h"

WORDS(0, readonly, found);
WORDS(1, readonly, block_starts);
WORDS(2, readonly, owners);
WORDS(3, writeonly, next_owners);
COUNTERS(4)
PUSH(GatherPush, push);

void main() {
  uint block = invocation();
  if (block > (push.count - 1u) / push.block) return;
  uint begin = block * push.block;
  uint end = push.count - begin < push.block ? push.count : begin + push.block;
  uint place;
  LOAD1(place, block_starts, block);
  for (uint i = begin; i < end; ++i) {
    uint ray = i;
    if (push.round != 0u) LOAD1(ray, owners, i);
    uint instance;
    LOAD1(instance, found, ray);
    if (instance != no_index) {
      STORE1(next_owners, place, ray);
      place += 1u;
    }
  }
  flush_counters();
}
