// SPDX-License-Identifier: MIT
// Applies one operation (specialization constant 2) to a vector of operands. The host compares the bits with its own.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "conformance/operations.h"

layout(constant_id = 2) const uint operation = 0u;
layout(constant_id = 3) const uint flushing = 0u;  // 1: operands and result with denormals flushed

QUADS(0, readonly, operands);
WORDS(1, writeonly, results);
COUNTERS(2)

struct Push {
  uint count;
};
PUSH(Push, push);

void main() {
  uint i = invocation();
  if (i >= push.count) return;
  uvec4 u;
  LOAD4(u, operands, i)
  if (flushing != 0u) u = uvec4(flush_bits(u.x), flush_bits(u.y), flush_bits(u.z), flush_bits(u.w));
  uint op = operation;
  uint result = apply_operation(op, u);
  STORE1(results, i, flushing != 0u ? flush_bits(result) : result)
  flush_counters();
}
