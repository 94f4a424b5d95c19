// SPDX-License-Identifier: MIT
// Rays that have entered an instance, in the space of its object.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/objects.h"

QUADS(0, readonly, rays);
QUADS(1, readonly, hits);
QUADS(2, readonly, states);
QUADS(3, readonly, places);
WORDS(4, readonly, found);
QUADS(5, readonly, instances);
WORDS(6, readonly, owners);
WORDS(7, writeonly, roots);
QUADS(8, writeonly, local_rays);
QUADS(9, writeonly, local_states);
WORDS(10, writeonly, local_steps);
COUNTERS(11)
PUSH(CountPush, push);

layout(constant_id = 3) const uint write_steps = 0u;

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uint ray_index;
  uint instance;
  LOAD1(ray_index, owners, index);
  LOAD1(instance, found, ray_index);
  bool paused = instance == enter_paused;
  instance = paused ? 0u : instance;
  uvec4 from;
  uvec4 along;
  uvec4 hit;
  uvec4 state;
  uvec4 place;
  LOAD4(from, rays, 2u * ray_index);
  LOAD4(along, rays, 2u * ray_index + 1u);
  LOAD4(hit, hits, ray_index);
  LOAD4(state, states, ray_index);
  LOAD4(place, places, ray_index);
  uvec4 row0;
  uvec4 row1;
  uvec4 row2;
  uvec4 rest;
  LOAD4(row0, instances, instance_quads * instance);
  LOAD4(row1, instances, instance_quads * instance + 1u);
  LOAD4(row2, instances, instance_quads * instance + 2u);
  LOAD4(rest, instances, instance_quads * instance + 6u);
  vec3 origin = flush_tiny3(transformed_point(as_vec3(from), as_vec4(row0), as_vec4(row1), as_vec4(row2)));
  vec3 direction = flush_tiny3(transformed_direction(as_vec3(along), as_vec4(row0), as_vec4(row1), as_vec4(row2)));
  // In an instance behind the one that a mask let the ray through in, everything at tmin is still to be met.
  uint next = state.w;
  if (instance > place.w) next = 0u;
  if (instance < place.w) next = no_index;
  STORE1(roots, index, rest.x);
  STORE4(local_rays, 2u * index, as_bits(origin, from.w));
  STORE4(local_rays, 2u * index + 1u, as_bits(direction, paused ? floatBitsToUint(-1.0) : hit.x));
  STORE4(local_states, index, uvec4(0u, 0u, trace_restart, next));
  if (write_steps != 0u) STORE1(local_steps, index, 0u);
  flush_counters();
}
