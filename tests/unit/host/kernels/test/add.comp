// SPDX-License-Identifier: MIT
// values[i] += amount: a chain of these shows whether each pass sees what the one before wrote.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

WORDS(0, , values);
COUNTERS(1)

struct Push {
  uint count;
  uint amount;
};
PUSH(Push, push);

void main() {
  uint i = invocation();
  if (i >= push.count) return;
  uint value;
  LOAD1(value, values, i)
  STORE1(values, i, value + push.amount)
  flush_counters();
}
