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
QUADS(4, restrict, places);  // in the upper level: index, levels, depth, and the instance that a mask let the ray through in
QUADS(5, restrict, trails);
WORDS(6, restrict, steps);
QUADS(7, readonly, boxes);
WORDS(8, readonly, keys);
QUADS(9, readonly, instance_lo);
QUADS(10, readonly, instance_hi);
// Of the round before: its rays, and what they found in their instances.
WORDS(11, readonly, owners);
QUADS(12, readonly, local_hits);
WORDS(13, readonly, local_steps);
WORDS(14, writeonly, found);  // of each ray the instance, enter_paused or no_index
STRUCTS(15, restrict, uint, block_counts);  // of rays that go on, by blocks of rays of this round
COUNTERS(16)
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

// The instance of a leaf, and where the ray enters its bound.
struct Entry {
  uint instance;
  float enter;
  bool inside;
};
Entry enter_leaf(uint leaf, Ray ray, Slabs slabs, float tmax) {
  Entry entry;
  uvec4 lo;
  uvec4 hi;
  LOAD1(entry.instance, keys, 2u * leaf + 1u);
  LOAD4(lo, instance_lo, entry.instance);
  LOAD4(hi, instance_hi, entry.instance);
  entry.enter = slab_enter(slabs, as_vec3(lo), as_vec3(hi), ray.tmin);
  entry.inside = entry.enter <= slab_exit(slabs, as_vec3(lo), as_vec3(hi), tmax);
  return entry;
}

void count_ray(Ray ray) {
  if (counting != 0u) {
    if (push.round == 0u && push.resume == 0u && !(ray.tmax < 0.0)) count(counter_rays, 1u);
    count(counter_node_visits, 4u * visits);
    count(counter_box_tests, 4u * visits);
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
  Slabs slabs = make_slabs(ray, max2(push.extent, largest_abs(ray.origin)) * push.rounding);
  BoxRay box_ray = make_box_ray(slabs, push.grid);
  BoxWalk walk;
  walk.index = place.x;
  walk.levels = place.y;
  walk.depth = place.z & 255u;
  walk.trail = uvec4(0u);
  if (walk.levels != 0u) LOAD4(walk.trail, trails, ray_index);
  if (push.round != 0u && (place.z & place_paused) == 0u) {
    uvec4 met;
    LOAD4(met, local_hits, index);
    Entry entry = enter_leaf(walk.index, ray, slabs, best.t);
    float t = max2(uintBitsToFloat(met.x), entry.enter);
    if (met.w != no_index && (t < best.t || (t == best.t && entry.instance < best_instance))) {
      best.t = t;
      best.u = uintBitsToFloat(met.y);
      best.v = uintBitsToFloat(met.z);
      best.primitive = met.w;
      best_instance = entry.instance;
    }
    walk = box_walk_on(walk);
  }
  if (any_hit != 0u && best.primitive != no_index) walk.depth = walk_done;
  if (ray.tmax < 0.0) walk.depth = walk_done;

  uint instance = no_index;
  uint budget = push.budget;
  bool walking = walk.depth != walk_done;
  while (walking) {
    while (walking && walk.depth != push.depth) {
      uint record = 3u * (level_base(walk.depth) + walk.index);
      uvec4 x;
      uvec4 y;
      uvec4 z;
      LOAD4(x, boxes, record);
      LOAD4(y, boxes, record + 1u);
      LOAD4(z, boxes, record + 2u);
      visits += 1u;
      uint list = box_list(box_keys(x, y, z, box_ray, slabs.octant, ray.tmin, best.t));
      if ((list >> 8u) != 0u) {
        walk = box_walk_down(walk, list);
      } else {
        walk = box_walk_on(walk);
      }
      budget -= 1u;
      walking = walk.depth != walk_done && budget != 0u;
    }
    if (walking) {
      Entry entry = enter_leaf(walk.index, ray, slabs, best.t);
      if (entry.inside) {
        instance = entry.instance;
      } else {
        walk = box_walk_on(walk);
        budget -= 1u;
      }
      walking = instance == no_index && walk.depth != walk_done && budget != 0u;
    }
  }
  bool paused = instance == no_index && walk.depth != walk_done;
  STORE1(found, ray_index, paused ? enter_paused : instance);
  if (paused || instance != no_index) {
    STORE4(places, ray_index, uvec4(walk.index, walk.levels, walk.depth | (paused ? place_paused : 0u), place.w));
    STORE4(trails, ray_index, walk.trail);
    state.z = trace_unfinished;
    atomicAdd(block_counts[index / push.block], 1u);
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
