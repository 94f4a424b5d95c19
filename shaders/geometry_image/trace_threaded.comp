// SPDX-License-Identifier: MIT
// The paper's traversal (figure 6): follow hit and miss links, one order for all rays, no stack.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#include "kernel.glsl"

WORDS(8, readonly, links);
QUADS(9, readonly, objects);
WORDS(10, readonly, roots);
WORDS(11, readonly, times);
WORDS(12, readonly, collapses);
QUADS(13, readonly, node_details);
QUADS(14, readonly, coarse_quads);
QUADS(15, readonly, cones);
WORDS(16, readonly, ray_list);
COUNTERS(17)

#include "geometry_image/trace_nodes.glsl"

void main() {
  if (invocation() >= push.rays) return;
  uint index = ray_index();
  Ray ray = load_ray(index);
  ObjectRecord object = load_object(load_root(index));
  uint first_node = object.first_node;
  Slabs slabs = make_slabs(ray, object.extent);
  Shear shear = make_shear(ray);
  load_tolerance(index);
  Hit best;
  uvec4 state;
  if (!begin_ray(index, ray, best, state)) {
    flush_counters();
    return;
  }

  uint link = state.x;
  bool walking = !(ray.tmax < 0.0);
  uint budget = push.budget;
  while (walking) {
    // Nodes until a leaf is entered. On a device that runs both sides of every branch, leaves wait for each other here.
    bool at_leaf = false;
    bool whole = false;
    uint number = 0u;
    float enter = 0.0;
    uint miss = 0u;
    uint texel = 0u;
    uint stride = 0u;
    while (walking && !at_leaf) {
      uvec4 lo;
      uvec4 hi;
      uint hit;
      LOAD4(lo, nodes_lo, first_node + link);
      LOAD4(hi, nodes_hi, first_node + link);
      LOAD1(hit, links, 2u * (first_node + link));
      LOAD1(miss, links, 2u * (first_node + link) + 1u);
      count_step();
      vec3 low = as_vec3(lo);
      vec3 high = as_vec3(hi);
      if (detailed != 0u && link != 0u) {
        vec3 margin = child_margin(load_detail(object.first_detail + node_above(link)), tolerance);
        low = low - margin;
        high = high + margin;
      }
      enter = slab_enter(slabs, low, high, ray.tmin);
      bool inside = enter <= slab_exit(slabs, low, high, best.t);
      at_leaf = inside && (hit & leaf_flag) != 0u;
      if (detailed != 0u && inside && !at_leaf) {
        number = object.first_detail + link;
        whole = is_whole(load_detail(number), tolerance);
        at_leaf = whole;
      }
      texel = hit & ~leaf_flag;
      stride = hi.w;
      if (!at_leaf) {
        link = inside ? hit : miss;
        budget -= 1u;
        walking = link != 0u && budget != 0u;
      }
    }
    if (at_leaf) {
      if (detailed != 0u && whole) {
        test_whole(number, ray, slabs, shear, state.w, best);
      } else {
        test_leaf(texel, stride, ray, slabs, shear, state.w, enter, best);
      }
      link = any_hit != 0u && best.primitive != no_index ? 0u : miss;
      budget -= 1u;
      walking = link != 0u && budget != 0u;
    }
  }
  state = uvec4(link, 0u, link == 0u || ray.tmax < 0.0 ? trace_finished : trace_unfinished, state.w);
  end_ray(index, ray, best, state);
}
