// SPDX-License-Identifier: MIT
// One pass of a stable merge sort. Each key finds its place by itself: by counting in the first pass, whose runs are
// short, then by a binary search in the run that its own is merged with. No pass needs shared memory or an order of
// its invocations.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/objects.h"

WORDS(0, readonly, keys);  // two each: the key and its instance
WORDS(1, writeonly, sorted);
COUNTERS(2)
PUSH(SortPush, push);

// How many of a run's first keys come before `key`: those below it, and equal ones where `equal`.
uint count_before(uint key, bool equal, uint begin, uint end) {
  uint low = begin;
  uint high = end;
  while (low < high) {
    uint middle = (low + high) >> 1u;
    uint other;
    LOAD1(other, keys, 2u * middle);
    bool before = other < key || (equal && other == key);
    low = before ? middle + 1u : low;
    high = before ? high : middle;
  }
  return low - begin;
}

uint count_in_block(uint key, uint index) {
  uint begin = index & ~(sort_run - 1u);
  uint place = begin;
  for (uint i = begin; i < begin + sort_run; ++i) {
    uint other = 0xffffffffu;
    if (i < push.count) LOAD1(other, keys, 2u * i);
    bool before = other < key || (other == key && i < index);
    place += before ? 1u : 0u;
  }
  return place;
}

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uint key;
  uint instance;
  LOAD1(key, keys, 2u * index);
  LOAD1(instance, keys, 2u * index + 1u);
  uint place;
  if (push.run == 0u) {
    place = count_in_block(key, index);
  } else {
    uint own = index / push.run * push.run;
    bool second = (index / push.run & 1u) != 0u;
    uint other = second ? own - push.run : own + push.run;
    uint end = other + push.run;
    other = other < push.count ? other : push.count;
    end = end < push.count ? end : push.count;
    place = (second ? own - push.run : own) + (index - own) + count_before(key, second, other, end);
  }
  STORE1(sorted, 2u * place, key);
  STORE1(sorted, 2u * place + 1u, instance);
  flush_counters();
}
