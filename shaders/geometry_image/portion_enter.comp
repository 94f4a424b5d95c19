// SPDX-License-Identifier: MIT
// Which rays come near a portion before what they have hit so far; these begin there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/portion.h"
#include "layout/ray.h"
#include "layout/trace.h"

QUADS(0, readonly, rays);
QUADS(1, readonly, hits);
QUADS(2, readonly, states);
WORDS(3, readonly, runs);  // { first texel in the portion, in the whole }
QUADS(4, writeonly, local_rays);
QUADS(5, writeonly, local_states);
QUADS(6, writeonly, local_hits);
WORDS(7, writeonly, local_steps);
STRUCTS(8, restrict, uint, wanted);  // 1: by some ray
COUNTERS(9)
PUSH(PortionPush, push);

layout(constant_id = 3) const uint write_steps = 0u;

// The first primitive of the portion that is not before one of the whole.
uint local_primitive(uint primitive) {
  if (primitive == no_index) return no_index;
  uint texel = primitive >> 1u;
  uint first = 0u;  // the last run that begins at the texel or before it, or else none
  uint end = push.runs;
  while (first < end) {
    uint middle = (first + end) >> 1u;
    uint whole;
    LOAD1(whole, runs, 2u * middle + 1u);
    if (whole <= texel) {
      first = middle + 1u;
    } else {
      end = middle;
    }
  }
  if (first == 0u) return 0u;
  uint local;
  uint whole;
  uint behind;
  LOAD1(local, runs, 2u * first - 2u);
  LOAD1(whole, runs, 2u * first - 1u);
  LOAD1(behind, runs, 2u * first);  // behind the last run is one more
  uint place = local + (texel - whole);
  return place < behind ? 2u * place + (primitive & 1u) : 2u * behind;
}

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uvec4 from;
  uvec4 along;
  uvec4 state;
  uvec4 hit;
  LOAD4(from, rays, 2u * index);
  LOAD4(along, rays, 2u * index + 1u);
  LOAD4(state, states, index);
  LOAD4(hit, hits, index);
  Ray ray = stored_ray(from, along);
  Slabs slabs = make_slabs(ray, push.extent);
  bool enters = trace_status(state) == trace_unfinished &&
                slab_enter(slabs, push.lo, push.hi, ray.tmin) <=
                    slab_exit(slabs, push.lo, push.hi, uintBitsToFloat(hit.x));
  if (enters && wanted[0] == 0u) atomicMax(wanted[0], 1u);
  if (enters) {
    along.w = hit.x;
    STORE4(local_rays, 2u * index, from);
    STORE4(local_rays, 2u * index + 1u, along);
    uint next = no_index;
    if (push.runs != 0u) next = local_primitive(state.w);
    STORE4(local_states, index, uvec4(0u, 0u, trace_restart, next));
  } else {
    STORE4(local_states, index, uvec4(0u, 0u, trace_finished, no_index));
    STORE4(local_hits, index, uvec4(0u, 0u, 0u, no_index));
  }
  if (write_steps != 0u) STORE1(local_steps, index, 0u);
  flush_counters();
}
