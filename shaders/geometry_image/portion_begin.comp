// SPDX-License-Identifier: MIT
// Before the first portion: nothing has been hit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/portion.h"
#include "layout/ray.h"
#include "layout/trace.h"

QUADS(0, readonly, rays);
QUADS(1, restrict, hits);
QUADS(2, restrict, states);
WORDS(3, writeonly, steps);
QUADS(4, writeonly, found_hits);
COUNTERS(5)
PUSH(PortionPush, push);

layout(constant_id = 3) const uint write_steps = 0u;

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uvec4 from;
  uvec4 along;
  LOAD4(from, rays, 2u * index);
  LOAD4(along, rays, 2u * index + 1u);
  Ray ray = stored_ray(from, along);
  uvec4 state = uvec4(0u, 0u, trace_unfinished, no_index);
  bool begins = !(ray.tmax < 0.0);
  if (push.restarted != 0u) {
    LOAD4(state, states, index);
    begins = trace_status(state) == trace_restart;
    if (begins) {
      // Where `mask` says it goes on is about what was found; this is the same in the whole.
      uvec4 passed;
      LOAD4(passed, hits, index);
      state = uvec4(0u, 0u, trace_unfinished, passed.w + 1u);
    }
  }
  if (!begins && trace_status(state) != trace_judged) state.z = trace_finished;
  STORE4(states, index, state);
  if (begins || push.restarted == 0u) {
    STORE4(hits, index, uvec4(floatBitsToUint(ray.tmax), 0u, 0u, no_index));
    STORE4(found_hits, index, uvec4(floatBitsToUint(ray.tmax), 0u, 0u, no_index));
  }
  if (push.restarted == 0u) {
    if (write_steps != 0u) STORE1(steps, index, 0u);
    if (counting != 0u && begins) count(counter_rays, 1u);
  }
  flush_counters();
}
