// SPDX-License-Identifier: MIT
// to[i] = from[i].
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

WORDS(0, readonly, from);
WORDS(1, writeonly, to);
COUNTERS(2)

struct Push {
  uint count;
};
PUSH(Push, push);

void main() {
  uint i = invocation();
  if (i >= push.count) return;
  uint value;
  LOAD1(value, from, i)
  STORE1(to, i, value)
  flush_counters();
}
