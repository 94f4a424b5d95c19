// SPDX-License-Identifier: MIT
// Each kind of binding: results[i] mixes quad i, word i and struct i.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

struct Item {
  uint a;
  uint b;
  uint c;
};

QUADS(0, readonly, quads);
WORDS(1, readonly, words);
STRUCTS(2, readonly, Item, items);
QUADS(3, writeonly, results);
COUNTERS(4)

struct Push {
  uint count;
};
PUSH(Push, push);

void main() {
  uint i = invocation();
  if (i >= push.count) return;
  uvec4 quad;
  LOAD4(quad, quads, i)
  uint word;
  LOAD1(word, words, i)
  Item item = items[i];
  STORE4(results, i, quad + uvec4(word, item.a, item.b, item.c))
  flush_counters();
}
