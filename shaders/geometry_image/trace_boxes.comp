// SPDX-License-Identifier: MIT
// A ray a lane against the four children of a node at once, in 16 bits, nearest first. Instead of a stack a ray
// has its trail (layout/boxes.h), which stays in registers: on a device that runs lanes as a vector, a stack in
// memory costs as much as the boxes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#include "kernel.glsl"
#include "layout/boxes.h"

QUADS(6, readonly, boxes);
WORDS(7, readonly, leaf_map);
QUADS(8, restrict, trails);
QUADS(9, readonly, objects);
WORDS(10, readonly, roots);
WORDS(11, readonly, times);
WORDS(12, readonly, collapses);
QUADS(13, readonly, node_details);
QUADS(14, readonly, coarse_quads);
QUADS(15, readonly, cones);
WORDS(16, readonly, ray_list);
COUNTERS(17)
PUSH(TracePush, push);

#include "geometry_image/trace.glsl"

void main() {
  if (invocation() >= push.rays) return;
  uint index = ray_index();
  boxes_a_step = 4u;
  Ray ray = load_ray(index);
  Hit best;
  uvec4 state;
  if (!begin_ray(index, ray, best, state)) {
    flush_counters();
    return;
  }
  uint root = load_root(index);
  ObjectRecord object = load_object(root);
  Slabs slabs = make_slabs(ray, object.extent);
  Shear shear = make_shear(ray);
  BoxRay box_ray = make_box_ray(slabs, object_grid(object));
  load_tolerance(index);

  BoxWalk walk;
  walk.index = state.x;
  walk.levels = state.y;
  walk.depth = trace_depth(state);
  walk.trail = uvec4(0u);
  if (walk.levels != 0u) LOAD4(walk.trail, trails, index);
  bool walking = !(ray.tmax < 0.0);
  uint budget = push.budget;
  while (walking) {
    uint leaves = 0u;
    bool whole = false;  // the node is a quad itself
    uint number = 0u;
    while (walking && leaves == 0u) {
      uint record = 3u * (object.first_node + level_base(walk.depth) + walk.index);
      uvec4 x;
      uvec4 y;
      uvec4 z;
      LOAD4(x, boxes, record);
      LOAD4(y, boxes, record + 1u);
      LOAD4(z, boxes, record + 2u);
      count_step();
      BoxRay against = box_ray;
      if (detailed != 0u) {
        number = object.first_detail + level_base(walk.depth) + walk.index;
        NodeDetail detail = load_detail(number);
        whole = is_whole(detail, tolerance);
        against = widened(box_ray, slabs, child_margin(detail, tolerance));
      }
      uint list = box_list(box_keys(x, y, z, against, slabs.octant, ray.tmin, best.t));
      if (detailed != 0u && whole) list = 256u;
      bool entered = (list >> 8u) != 0u;
      if (entered && (walk.depth + 1u == object.depth || (detailed != 0u && whole))) {
        leaves = list;
      } else {
        if (entered) {
          walk = box_walk_down(walk, list);
        } else {
          walk = box_walk_on(walk);
        }
        budget -= 1u;
        walking = walk.depth != walk_done && budget != 0u;
      }
    }
    bool at_leaf = leaves != 0u;
    while (at_leaf) {
      uint slot = object.first_slot + 4u * walk.index + (leaves & 3u);
      if (detailed != 0u && whole) slot = object.first_slot;
      uint texel;
      uint stride;
      LOAD1(texel, leaf_map, 2u * slot);
      LOAD1(stride, leaf_map, 2u * slot + 1u);
      if (detailed != 0u) {
        uvec4 quad;
        LOAD4(quad, coarse_quads, number);
        if (!whole) quad = uvec4(texel, 1u, stride, 0u);
        test_quad_of(quad.x, quad.y, quad.z, quad.w, ray, slabs, shear, state.w, best);
      } else {
        test_quad(texel, stride, ray, slabs, shear, state.w, best);
      }
      leaves = ((leaves & 255u) >> 2u) | ((leaves - 256u) & 1792u);
      at_leaf = leaves > 255u;
      if (any_hit != 0u && best.primitive != no_index) {
        at_leaf = false;
        walk.levels = 0u;
      }
      if (!at_leaf) {
        walk = box_walk_on(walk);
        budget -= 1u;
        walking = walk.depth != walk_done && budget != 0u;
      }
    }
  }
  bool finished = walk.depth == walk_done || ray.tmax < 0.0;
  if (resumable != 0u) STORE4(trails, index, walk.trail);
  state = uvec4(walk.index, walk.levels, 4u * walk.depth + (finished ? trace_finished : trace_unfinished), state.w);
  end_ray(index, ray, best, state);
}
