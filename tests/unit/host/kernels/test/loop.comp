// SPDX-License-Identifier: MIT
// How many iterations of a loop the device runs; the state keeps it from being computed beforehand.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

WORDS(0, , results);
COUNTERS(1)

struct Push {
  uint iterations;
};
PUSH(Push, push);

void main() {
  if (invocation() != 0u) return;
  uint state = RAW_LOAD1(results, 1);
  uint done = 0u;
  while (done < push.iterations) {
    state = state * 1664525u + 1013904223u;
    done = done + 1u;
  }
  RAW_STORE1(results, 0, done);
  RAW_STORE1(results, 1, state);
}
