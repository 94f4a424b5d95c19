// SPDX-License-Identifier: MIT
// Rays through the upper level: what each has found in the instance that it was in counts if it is nearer than all
// before; then it goes on to the next instance whose bound it enters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/objects.h"

QUADS(0, readonly, rays);
QUADS(1, restrict, hits);
WORDS(2, restrict, hit_instances);
QUADS(3, restrict, states);
QUADS(4, restrict, places);  // in the upper level: order, turns, depth, and the instance that a mask let it through in
WORDS(5, restrict, steps);
QUADS(6, readonly, upper_lo);
QUADS(7, readonly, upper_hi);
QUADS(8, readonly, instances);
// Of the round before: its rays, and what they found in their instances.
WORDS(9, readonly, owners);
QUADS(10, readonly, local_hits);
WORDS(11, readonly, local_steps);
WORDS(12, writeonly, found);  // of each ray the instance, enter_paused or no_index
STRUCTS(13, restrict, uint, block_counts);  // of rays that go on, by blocks of compact_block rays of this round
COUNTERS(14)
PUSH(EnterPush, push);

layout(constant_id = 2) const uint any_hit = 0u;  // as in `trace`
layout(constant_id = 3) const uint write_steps = 0u;

uint visits = 0u;

Ray load_ray(uint index) {
  uvec4 from;
  uvec4 along;
  LOAD4(from, rays, 2u * index);
  LOAD4(along, rays, 2u * index + 1u);
  return stored_ray(from, along);
}

float upper_extent() {
  uvec4 lo;
  uvec4 hi;
  LOAD4(lo, upper_lo, 0u);
  LOAD4(hi, upper_hi, 0u);
  return max2(largest_abs(as_vec3(lo)), largest_abs(as_vec3(hi)));
}

void count_ray(Ray ray) {
  if (counting != 0u) {
    if (push.round == 0u && push.resume == 0u && !(ray.tmax < 0.0)) count(counter_rays, 1u);
    count(counter_node_visits, visits);
    count(counter_box_tests, visits);
  }
}

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uint ray_index = index;
  if (push.round != 0u) LOAD1(ray_index, owners, index);
  Ray ray = load_ray(ray_index);
  uvec4 state = uvec4(0u, 0u, trace_unfinished, no_index);
  uvec4 place = uvec4(0u, 0u, 0u, no_index);
  Hit best;
  best.t = ray.tmax;
  best.u = 0.0;
  best.v = 0.0;
  best.primitive = no_index;
  uint best_instance = no_index;
  uint step_count = 0u;
  if (push.round == 0u && push.resume != 0u) {
    LOAD4(state, states, index);
    if (trace_status(state) != trace_restart) {
      flush_counters();
      return;
    }
    if (write_steps != 0u) LOAD1(step_count, steps, ray_index);
    place.w = state.y;
  }
  if (push.round != 0u) {
    uvec4 bits;
    LOAD4(state, states, ray_index);
    LOAD4(place, places, ray_index);
    LOAD4(bits, hits, ray_index);
    best.t = uintBitsToFloat(bits.x);
    best.u = uintBitsToFloat(bits.y);
    best.v = uintBitsToFloat(bits.z);
    best.primitive = bits.w;
    LOAD1(best_instance, hit_instances, ray_index);
    if (write_steps != 0u) {
      uint more;
      LOAD1(step_count, steps, ray_index);
      LOAD1(more, local_steps, index);
      step_count += more;
    }
  }
  Slabs slabs = make_slabs(ray, max2(upper_extent(), largest_abs(ray.origin)) * push.rounding);
  Walk walk;
  walk.order = place.x;
  walk.turns = place.y;
  walk.depth = place.z & 255u;
  uvec4 lo;
  uvec4 hi;
  if (push.round != 0u && (place.z & place_paused) == 0u) {
    uvec4 met;
    LOAD4(met, local_hits, index);
    LOAD4(lo, upper_lo, walk_address(walk));
    LOAD4(hi, upper_hi, walk_address(walk));
    uint instance = lo.w & ~leaf_flag;
    float t = max2(uintBitsToFloat(met.x), slab_enter(slabs, as_vec3(lo), as_vec3(hi), ray.tmin));
    if (met.w != no_index && (t < best.t || (t == best.t && instance < best_instance))) {
      best.t = t;
      best.u = uintBitsToFloat(met.y);
      best.v = uintBitsToFloat(met.z);
      best.primitive = met.w;
      best_instance = instance;
    }
    walk = walk_on(walk);
  }
  if (any_hit != 0u && best.primitive != no_index) walk.depth = walk_done;
  if (ray.tmax < 0.0) walk.depth = walk_done;

  bool found_leaf = false;
  uint octant_shift = 2u * slabs.octant;
  uint budget = push.budget;
  bool walking = walk.depth != walk_done;
  while (walking) {
    uint address = walk_address(walk);
    LOAD4(lo, upper_lo, address);
    LOAD4(hi, upper_hi, address);
    visits += 1u;
    float enter = slab_enter(slabs, as_vec3(lo), as_vec3(hi), ray.tmin);
    bool inside = enter <= slab_exit(slabs, as_vec3(lo), as_vec3(hi), best.t);
    found_leaf = inside && walk.depth == push.depth;
    if (!found_leaf) {
      if (inside) {
        walk = walk_down(walk, (lo.w >> octant_shift) & 3u);
      } else {
        walk = walk_on(walk);
      }
      budget -= 1u;
    }
    walking = !found_leaf && walk.depth != walk_done && budget != 0u;
  }
  bool paused = !found_leaf && walk.depth != walk_done;
  uint instance = lo.w & ~leaf_flag;
  STORE1(found, ray_index, found_leaf ? instance : (paused ? enter_paused : no_index));
  if (found_leaf || paused) {
    STORE4(places, ray_index, uvec4(walk.order, walk.turns, walk.depth | (paused ? place_paused : 0u), place.w));
    state.z = trace_unfinished;
    atomicAdd(block_counts[index / compact_block], 1u);
  } else {
    state.z = trace_finished;
    if (any_hit != 0u && best.primitive != no_index) {
      best.t = 0.0;
      best.u = 0.0;
      best.v = 0.0;
      best.primitive = 0u;
      best_instance = 0u;
    }
  }
  STORE4(hits, ray_index, as_bits(vec3(best.t, best.u, best.v), best.primitive));
  STORE1(hit_instances, ray_index, best_instance);
  STORE4(states, ray_index, state);
  if (write_steps != 0u) STORE1(steps, ray_index, step_count + visits);
  count_ray(ray);
  flush_counters();
}
