// SPDX-License-Identifier: MIT
// Which rays of each block the next dispatch has to do with (layout/ray_list.h), a block an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/frame.h"
#include "layout/ray_list.h"

QUADS(0, readonly, rays);
QUADS(1, restrict, hits);
QUADS(2, restrict, states);
STRUCTS(3, restrict, uint, block_counts);
WORDS(4, readonly, block_starts);
WORDS(5, writeonly, ray_list);
COUNTERS(6)
PUSH(CountPush, push);

layout(constant_id = 2) const uint stage = list_count;
layout(constant_id = 3) const uint resume = resume_nothing;
layout(constant_id = 4) const uint resumable = 1u;  // whether states are kept

void main() {
  uint block = invocation();
  uint begin = block * list_block;
  if (begin >= push.count) return;
  uint end = begin + list_block < push.count ? begin + list_block : push.count;
  uint place = 0u;
  if (stage == list_place) LOAD1(place, block_starts, block);
  uint wanted = 0u;
  for (uint i = begin; i < end; ++i) {
    Ray ray = no_ray();
    uvec4 hit = uvec4(0u);
    uvec4 state = uvec4(0u);
    if (resume == resume_nothing) {
      uvec4 from;
      uvec4 along;
      LOAD4(from, rays, 2u * i);
      LOAD4(along, rays, 2u * i + 1u);
      ray = stored_ray(from, along);
    } else if (resume == resume_unanswered) {
      LOAD4(hit, hits, i);
    } else {
      LOAD4(state, states, i);
    }
    bool goes = ray_is_wanted(ray, hit, state, resume);
    if (stage == list_place) {
      if (goes) {
        STORE1(ray_list, place + wanted, i);
      } else {
        if (resume == resume_nothing) STORE4(hits, i, as_bits(vec3(ray.tmax, 0.0, 0.0), no_index));
        if (resume != resume_states && resumable != 0u) STORE4(states, i, uvec4(0u, 0u, trace_finished, no_index));
      }
    }
    wanted += goes ? 1u : 0u;
  }
  if (stage == list_count) block_counts[block] = wanted;
  flush_counters();
}
