// SPDX-License-Identifier: MIT
// A ray against a bound, a quad and the order of the tree: what every traversal shares, whatever its path.
//
// A hit is defined without reference to any path, so that all traversals agree to the bit: the ray passes the quad's own
// bound (slabs widened by a margin), passes one of its triangles by the sign of the edge functions, t is that of the
// triangle's plane but never less than the entry into the quad's bound. Bounds above a quad contain it and slab distances
// are monotonic, so no traversal that cuts by the nearest t can lose such a hit. Equal t go to the lower primitive.
#ifndef LODESTONE_LAYOUT_TRACE_H
#define LODESTONE_LAYOUT_TRACE_H

#include "layout/arithmetic.h"
#include "layout/atlas.h"

LODESTONE_LAYOUT_BEGIN

struct Ray {
  vec3 origin;
  float tmin;  // hits are beyond tmin ...
  vec3 direction;
  float tmax;  // ... and not beyond tmax; negative: no ray
};

// t in units of |direction|; u, v the barycentrics of the triangle's second and third corner; primitive =
// 2 * texel of corner a + half. Half 0 is the triangle (a, b, c), half 1 is (d, c, b).
struct Hit {
  float t;
  float u;
  float v;
  uint primitive;  // no_index: a miss, then t = tmax, u = v = 0
};

struct Slabs {
  vec3 near_origin;
  vec3 far_origin;
  vec3 inverse;
  uint octant;  // bit i: direction component i is negative
};

// The rounding errors of the edge functions move an edge by less than 2^-18 of the largest coordinate in play (vertices
// relative to the origin: 1 ulp each; products and sums: about a dozen more). Bounds are widened by that, or a ray
// through an edge could pass beside the bound of the very triangle that claims it.
CONST float slab_margin = 3.8146973e-6f;  // 2^-18

// Directions below 2^-40 count as that, so that no slab distance is 0 * infinity.
FN float slab_inverse(float d) {
  float size = max2(abs1(d), 9.094947e-13f);
  return d < 0.0f ? -1.0f / size : 1.0f / size;
}

// `extent`: the largest absolute coordinate of the scene's bounds.
FN Slabs make_slabs(Ray ray, float extent) {
  float reach = max2(extent, max_component(vec3(abs1(ray.origin.x), abs1(ray.origin.y), abs1(ray.origin.z))));
  float margin = reach * slab_margin;
  Slabs s;
  s.octant = (ray.direction.x < 0.0f ? 1u : 0u) | (ray.direction.y < 0.0f ? 2u : 0u) |
             (ray.direction.z < 0.0f ? 4u : 0u);
  vec3 signed_margin = vec3(ray.direction.x < 0.0f ? -margin : margin, ray.direction.y < 0.0f ? -margin : margin,
                            ray.direction.z < 0.0f ? -margin : margin);
  s.near_origin = ray.origin + signed_margin;
  s.far_origin = ray.origin - signed_margin;
  s.inverse = vec3(slab_inverse(ray.direction.x), slab_inverse(ray.direction.y), slab_inverse(ray.direction.z));
  return s;
}

FN float slab_enter(Slabs s, vec3 lo, vec3 hi, float tmin) {
  float x = (((s.octant & 1u) != 0u ? hi.x : lo.x) - s.near_origin.x) * s.inverse.x;
  float y = (((s.octant & 2u) != 0u ? hi.y : lo.y) - s.near_origin.y) * s.inverse.y;
  float z = (((s.octant & 4u) != 0u ? hi.z : lo.z) - s.near_origin.z) * s.inverse.z;
  return max2(max2(x, y), max2(z, tmin));
}

FN float slab_exit(Slabs s, vec3 lo, vec3 hi, float tmax) {
  float x = (((s.octant & 1u) != 0u ? lo.x : hi.x) - s.far_origin.x) * s.inverse.x;
  float y = (((s.octant & 2u) != 0u ? lo.y : hi.y) - s.far_origin.y) * s.inverse.y;
  float z = (((s.octant & 4u) != 0u ? lo.z : hi.z) - s.far_origin.z) * s.inverse.z;
  return min2(min2(x, y), min2(z, tmax));
}

// Twice the signed volume of the ray's direction and the edge p q (both relative to the ray's origin). Swapping p
// and q flips the sign and nothing else, so both triangles at an edge decide alike.
FN float edge_function(vec3 p, vec3 q, vec3 direction) { return dot3(direction, cross3(q - p, p + q)); }

FN bool one_sided(float a, float b, float c) {
  return (a >= 0.0f && b >= 0.0f && c >= 0.0f) || (a <= 0.0f && b <= 0.0f && c <= 0.0f);
}

FN void accept_triangle(vec3 p0, vec3 p1, vec3 p2, float w0, float w1, float w2, Ray ray, float enter,
                        uint primitive, INOUT(Hit) best) {
  vec3 normal = cross3(p1 - p0, p2 - p0);
  float facing = dot3(normal, ray.direction);
  float sum = w0 + w1 + w2;
  if (one_sided(w0, w1, w2) && facing != 0.0f && sum != 0.0f) {
    float t = dot3(normal, p0) / facing;
    bool inside = t > ray.tmin;
    t = max2(t, enter);
    if (inside && (t < best.t || (t == best.t && primitive < best.primitive))) {
      best.t = t;
      best.u = w1 / sum;
      best.v = w2 / sum;
      best.primitive = primitive;
    }
  }
}

// Both triangles of the quad a b c d by its five edge functions. `enter`: slab_enter of the quad's own bound.
FN void intersect_quad(vec3 a, vec3 b, vec3 c, vec3 d, Ray ray, float enter, uint texel, INOUT(Hit) best) {
  a = a - ray.origin;
  b = b - ray.origin;
  c = c - ray.origin;
  d = d - ray.origin;
  float bc = edge_function(b, c, ray.direction);
  float ab = edge_function(a, b, ray.direction);
  float ca = edge_function(c, a, ray.direction);
  float dc = edge_function(d, c, ray.direction);
  float bd = edge_function(b, d, ray.direction);
  accept_triangle(a, b, c, bc, ca, ab, ray, enter, 2u * texel, best);
  accept_triangle(d, c, b, -bc, bd, dc, ray, enter, 2u * texel + 1u, best);
}

// A place in the tree in visiting order, without a stack: two bits a level. `turns` holds, for each level on the path,
// which child the parent's order visits first (xor mask), `order` the position in visiting order; the node's index is
// order ^ turns.
struct Walk {
  uint depth;
  uint order;
  uint turns;
};

CONST uint walk_done = 0xffu;  // Walk::depth after the last node

FN uint walk_address(Walk walk) { return level_base(walk.depth) + (walk.order ^ walk.turns); }

// To the first child that `first` (two bits) says.
FN Walk walk_down(Walk walk, uint first) {
  walk.depth = walk.depth + 1u;
  walk.order = walk.order << 2u;
  walk.turns = (walk.turns << 2u) | first;
  return walk;
}

// To the next sibling in order, or the next of an ancestor.
FN Walk walk_on(Walk walk) {
  uint next = walk.order + 1u;
  uint up = uint(findLSB(next)) & ~1u;  // two bits a level that has been finished
  bool done = (next >> (2u * walk.depth)) != 0u;
  walk.order = next >> up;
  walk.turns = walk.turns >> up;
  walk.depth = done ? walk_done : walk.depth - (up >> 1u);
  return walk;
}

// Traversal states between dispatches: { order, turns, depth, status } or { link, 0, 0, status }.
CONST uint trace_finished = 0u;
CONST uint trace_unfinished = 1u;
CONST uint trace_restart = 2u;  // from the root, with nothing hit (the ray's tmin has moved)

struct TracePush {
  uint rays;
  uint depth;   // of the leaves
  uint resume;  // 0: all rays from the root; 1: those unfinished, from their states
  uint budget;  // steps of a ray in this dispatch. Mesa before 23 stops a subgroup silently after 65,535 loop
                // iterations: with 8 lanes and two nested loops a budget of 4,000 can never reach that.
  uint slots;   // leaf slots in use
};

LODESTONE_LAYOUT_END
#endif
