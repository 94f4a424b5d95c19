// SPDX-License-Identifier: MIT
// What the traversals share: a ray, the object whose hierarchy it goes through, its hit, and its state from dispatch to
// dispatch. Before this come their own buffers, `objects`, `roots`, `times`, those of layout/detail.h and `ray_list` among
// them, push constants and counters.
#include "layout/detail_nodes.h"
#include "layout/motion.h"
#include "layout/objects.h"

QUADS(0, readonly, rays);  // two a ray: origin and tmin, direction and tmax
QUADS(1, readonly, geometry);
QUADS(2, restrict, hits);    // t, u, v, primitive
QUADS(3, restrict, states);  // the place in the tree, and whether the ray goes on
WORDS(4, restrict, steps);   // nodes visited, where specialization constant 3 asks for it
STRUCTS(5, restrict, uint, pending);  // rays that need another dispatch

layout(constant_id = 2) const uint any_hit = 0u;  // 1: stop at the first hit found; hits say only whether
layout(constant_id = 3) const uint write_steps = 0u;
layout(constant_id = 4) const uint instanced = 0u;  // 1: of each ray, `roots` says which object; 0: all of the first

layout(constant_id = 5) const uint segments = 0u;   // layout/motion.h; 0: nothing moves, else `times` says when

layout(constant_id = 6) const uint detailed = 0u;   // 1: levels of detail (layout/detail.h)

layout(constant_id = 7) const uint resumable = 1u;  // 0: all from the root, and no states are kept

uint node_visits = 0u;
uint triangle_tests = 0u;
uint subgroup_steps = 0u;

uint ray_index() {
  uint index = invocation();
  if (push.listed != 0u) LOAD1(index, ray_list, index + 1u);
  return index;
}

Ray load_ray(uint index) {
  uvec4 from;
  uvec4 along;
  LOAD4(from, rays, 2u * index);
  LOAD4(along, rays, 2u * index + 1u);
  return stored_ray(from, along);
}

uint image = 0u;  // where the geometry image begins that is to be read, and how far it is to the next
float passed = 0.0;

// The hierarchy that a ray goes through; says too when quads are to be tested.
uint load_root(uint index) {
  uint root = 0u;
  if (instanced != 0u) LOAD1(root, roots, index);
  if (segments != 0u) {
    uint bits;
    LOAD1(bits, times, index);
    Moment moment = moment_of(uintBitsToFloat(bits), segments);
    image = push.image_texels * moment.segment;
    passed = moment.fraction;
    root += push.objects * moment.segment;
  }
  return root;
}

ObjectRecord load_object(uint object) {
  uvec4 a;
  uvec4 b;
  uvec4 c;
  uvec4 d;
  LOAD4(a, objects, 4u * object);
  LOAD4(b, objects, 4u * object + 1u);
  LOAD4(c, objects, 4u * object + 2u);
  LOAD4(d, objects, 4u * object + 3u);
  return object_record(a, b, c, d);
}

// What the ray tolerates.
Tolerance tolerance;

void load_tolerance(uint index) {
  if (detailed == 0u) return;
  tolerance.camera.apex = push.camera;
  tolerance.camera.width = push.camera_width;
  tolerance.camera.spread = push.camera_spread;
  tolerance.scattered = no_cone();
  if (push.scattered != 0u) {
    uvec4 a;
    uvec4 b;
    LOAD4(a, cones, 2u * index);
    LOAD4(b, cones, 2u * index + 1u);
    tolerance.scattered = stored_cone(a, b);
  }
}

NodeDetail load_detail(uint number) {
  uvec4 a;
  uvec4 b;
  LOAD4(a, node_details, 2u * number);
  LOAD4(b, node_details, 2u * number + 1u);
  return node_detail(a, b);
}

uint boxes_a_step = 1u;

void count_step() {
  node_visits += 1u;
  if (counting != 0u && subgroupElect()) subgroup_steps += gl_SubgroupSize;
}

vec3 corner_at(uint texel) {
  uvec4 bits;
  LOAD4(bits, geometry, image + texel);
  vec3 point = as_vec3(bits);
  if (segments != 0u) {
    LOAD4(bits, geometry, image + push.image_texels + texel);
    point = moved3(point, as_vec3(bits), passed);
  }
  if (detailed != 0u) {
    uint parent;
    uint radius;
    LOAD1(parent, collapses, 2u * texel);
    LOAD1(radius, collapses, 2u * texel + 1u);
    LOAD4(bits, geometry, image + parent);
    point = slid(point, as_vec3(bits), collapse_of(tolerance_at(tolerance, point), uintBitsToFloat(radius)));
  }
  return point;
}

// Where the quad's own bound has not been asked yet. `across` and `along`: how far its corners are apart; `level`: of
// detail.
void test_quad_of(uint texel, uint across, uint along, uint level, Ray ray, Slabs slabs, Shear shear, uint next,
                  inout Hit best) {
  vec3 a = corner_at(texel);
  vec3 b = corner_at(texel + across);
  vec3 c = corner_at(texel + along);
  vec3 d = corner_at(texel + across + along);
  Bound bound = quad_bound(a, b, c, d);
  float enter = slab_enter(slabs, bound.lo, bound.hi, ray.tmin);
  if (enter <= slab_exit(slabs, bound.lo, bound.hi, best.t)) {
    intersect_quad(a, b, c, d, ray, shear, next, enter, texel | (level << (level_shift - 1u)), best);
  }
  triangle_tests += 2u;
}
void test_quad(uint texel, uint stride, Ray ray, Slabs slabs, Shear shear, uint next, inout Hit best) {
  test_quad_of(texel, 1u, stride, 0u, ray, slabs, shear, next, best);
}
// The quad that node `number` is, where it is whole.
void test_whole(uint number, Ray ray, Slabs slabs, Shear shear, uint next, inout Hit best) {
  uvec4 quad;
  LOAD4(quad, coarse_quads, number);
  test_quad_of(quad.x, quad.y, quad.z, quad.w, ray, slabs, shear, next, best);
}

// Where it has, and said `enter`; unless that was of a whole segment, or of corners that have not slid yet.
void test_leaf(uint texel, uint stride, Ray ray, Slabs slabs, Shear shear, uint next, float enter, inout Hit best) {
  if (segments != 0u || detailed != 0u) {
    test_quad(texel, stride, ray, slabs, shear, next, best);
    return;
  }
  vec3 a = corner_at(texel);
  vec3 b = corner_at(texel + 1u);
  vec3 c = corner_at(texel + stride);
  vec3 d = corner_at(texel + stride + 1u);
  intersect_quad(a, b, c, d, ray, shear, next, enter, texel, best);
  triangle_tests += 2u;
}

// The ray's best hit so far, and its place in the tree; false: nothing to do in this dispatch.
bool begin_ray(uint index, Ray ray, out Hit best, out uvec4 state) {
  best.t = ray.tmax;
  best.u = 0.0;
  best.v = 0.0;
  best.primitive = no_index;
  state = uvec4(0u, 0u, trace_unfinished, no_index);
  if (resumable != 0u && push.resume != resume_nothing) {
    uvec4 bits;
    if (push.resume == resume_unanswered) {
      LOAD4(bits, hits, index);
      if (bits.w == unanswered) return true;
      STORE4(states, index, uvec4(0u, 0u, trace_finished, no_index));
      return false;
    }
    LOAD4(state, states, index);
    if (trace_status(state) == trace_restart) return true;
    LOAD4(bits, hits, index);
    best.t = uintBitsToFloat(bits.x);
    best.u = uintBitsToFloat(bits.y);
    best.v = uintBitsToFloat(bits.z);
    best.primitive = bits.w;
    return trace_status(state) == trace_unfinished;
  }
  return true;
}

void end_ray(uint index, Ray ray, Hit best, uvec4 state) {
  if (any_hit != 0u && best.primitive != no_index) {
    best.t = 0.0;
    best.u = 0.0;
    best.v = 0.0;
    best.primitive = 0u;
  }
  bool unfinished = trace_status(state) == trace_unfinished;
  uint primitive = resumable == 0u && unfinished ? unanswered : best.primitive;
  STORE4(hits, index, as_bits(vec3(best.t, best.u, best.v), primitive));
  if (resumable != 0u) STORE4(states, index, state);
  if (unfinished) atomicAdd(pending[0], 1u);
  if (write_steps != 0u) {
    uint before = 0u;
    if (push.resume != resume_nothing) LOAD1(before, steps, index);
    STORE1(steps, index, before + node_visits);
  }
  if (counting != 0u) {
    // Rays through instances are counted where they enter.
    if (instanced == 0u && push.resume == resume_nothing && !(ray.tmax < 0.0)) count(counter_rays, 1u);
    count(counter_node_visits, boxes_a_step * node_visits);
    count(counter_box_tests, boxes_a_step * node_visits);
    count(counter_triangle_tests, triangle_tests);
    count(counter_lane_steps, node_visits);
    count(counter_subgroup_steps, subgroup_steps);
  }
  flush_counters();
}
