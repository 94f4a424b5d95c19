// SPDX-License-Identifier: MIT
// Which rays of each block the next dispatch has to do with (layout/ray_list.h), a block an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/ray_list.h"

QUADS(0, readonly, rays);
QUADS(1, restrict, hits);
QUADS(2, restrict, states);
STRUCTS(3, restrict, uint, block_counts);
WORDS(4, readonly, block_starts);
WORDS(5, readonly, some);
WORDS(6, writeonly, ray_list);
QUADS(7, writeonly, shadow_rays);
COUNTERS(8)
PUSH(ListPush, push);

layout(constant_id = 2) const uint stage = list_count;
layout(constant_id = 3) const uint resume = resume_nothing;
layout(constant_id = 4) const uint resumable = 1u;  // whether states are kept
layout(constant_id = 5) const uint among = 0u;      // 1: of the list `some`; 0: of all rays
layout(constant_id = 6) const uint ending = 0u;     // 1: the others have ended, and cast no shadow rays any more

void main() {
  uint block = invocation();
  if (block > (push.count - 1u) / push.block) return;
  uint begin = block * push.block;
  uint end = push.count - begin < push.block ? push.count : begin + push.block;
  uint place = 0u;
  if (stage == list_place) LOAD1(place, block_starts, block);
  uint wanted = 0u;
  for (uint i = begin; i < end; ++i) {
    uint index = i;
    if (among != 0u) LOAD1(index, some, i + 1u);
    Ray ray = no_ray();
    uvec4 hit = uvec4(0u);
    uvec4 state = uvec4(0u);
    if (resume == resume_nothing) {
      uvec4 from;
      uvec4 along;
      LOAD4(from, rays, 2u * index);
      LOAD4(along, rays, 2u * index + 1u);
      ray = stored_ray(from, along);
    } else if (resume == resume_unanswered) {
      LOAD4(hit, hits, index);
    } else {
      LOAD4(state, states, index);
    }
    bool goes = ray_is_wanted(ray, hit, state, resume);
    if (stage == list_place) {
      if (goes) {
        STORE1(ray_list, place + wanted + 1u, index);
      } else if (ending != 0u) {
        STORE4(shadow_rays, 2u * index + 1u, uvec4(0u, 0u, 0u, floatBitsToUint(-1.0)));
      } else {
        if (resume == resume_nothing) STORE4(hits, index, as_bits(vec3(ray.tmax, 0.0, 0.0), no_index));
        if (resume != resume_states && resumable != 0u) STORE4(states, index, uvec4(0u, 0u, trace_finished, no_index));
      }
    }
    wanted += goes ? 1u : 0u;
  }
  if (stage == list_count) block_counts[block] = wanted;
  flush_counters();
}
