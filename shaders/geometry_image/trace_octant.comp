// SPDX-License-Identifier: MIT
// The links ordered by direction octant (the paper's section 6, "optimized link hierarchies"), computed from the node's
// index and two bits a level instead of stored: near children first, still without a stack.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#include "kernel.glsl"

QUADS(8, readonly, objects);
WORDS(9, readonly, roots);
WORDS(10, readonly, times);
WORDS(11, readonly, collapses);
QUADS(12, readonly, node_details);
QUADS(13, readonly, coarse_quads);
QUADS(14, readonly, cones);
WORDS(15, readonly, ray_list);
COUNTERS(16)

#include "geometry_image/trace_nodes.glsl"

void main() {
  if (invocation() >= push.rays) return;
  uint index = ray_index();
  Ray ray = load_ray(index);
  ObjectRecord object = load_object(load_root(index));
  Slabs slabs = make_slabs(ray, object.extent);
  Shear shear = make_shear(ray);
  load_tolerance(index);
  Hit best;
  uvec4 state;
  if (!begin_ray(index, ray, best, state)) {
    flush_counters();
    return;
  }

  Walk walk;
  walk.order = state.x;
  walk.turns = state.y;
  walk.depth = trace_depth(state);
  uint octant_shift = 2u * slabs.octant;
  bool walking = !(ray.tmax < 0.0);
  uint budget = push.budget;
  while (walking) {
    bool at_leaf = false;
    bool whole = false;
    uint number = 0u;
    float enter = 0.0;
    uint texel = 0u;
    uint stride = 0u;
    while (walking && !at_leaf) {
      uint address = object.first_node + walk_address(walk);
      uvec4 lo;
      uvec4 hi;
      LOAD4(lo, nodes_lo, address);
      LOAD4(hi, nodes_hi, address);
      count_step();
      vec3 low = as_vec3(lo);
      vec3 high = as_vec3(hi);
      if (detailed != 0u && walk.depth != 0u) {
        uint above = (walk.order ^ walk.turns) >> 2u;
        vec3 margin = child_margin(load_detail(object.first_detail + level_base(walk.depth - 1u) + above), tolerance);
        low = low - margin;
        high = high + margin;
      }
      enter = slab_enter(slabs, low, high, ray.tmin);
      bool inside = enter <= slab_exit(slabs, low, high, best.t);
      at_leaf = inside && walk.depth == object.depth;
      if (detailed != 0u && inside && !at_leaf) {
        number = object.first_detail + walk_address(walk);
        whole = is_whole(load_detail(number), tolerance);
        at_leaf = whole;
      }
      texel = lo.w & ~leaf_flag;
      stride = hi.w;
      if (!at_leaf) {
        if (inside) {
          walk = walk_down(walk, (lo.w >> octant_shift) & 3u);
        } else {
          walk = walk_on(walk);
        }
        budget -= 1u;
        walking = walk.depth != walk_done && budget != 0u;
      }
    }
    if (at_leaf) {
      if (detailed != 0u && whole) {
        test_whole(number, ray, slabs, shear, state.w, best);
      } else {
        test_leaf(texel, stride, ray, slabs, shear, state.w, enter, best);
      }
      walk = walk_on(walk);
      if (any_hit != 0u && best.primitive != no_index) walk.depth = walk_done;
      budget -= 1u;
      walking = walk.depth != walk_done && budget != 0u;
    }
  }
  bool finished = walk.depth == walk_done || ray.tmax < 0.0;
  state = uvec4(walk.order, walk.turns, 4u * walk.depth + (finished ? trace_finished : trace_unfinished), state.w);
  end_ray(index, ray, best, state);
}
