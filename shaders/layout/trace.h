// SPDX-License-Identifier: MIT
// A ray against a bound, a quad and the order of the tree: what every traversal shares, whatever its path.
//
// A hit is defined without reference to any path, so that all traversals agree to the bit: the ray passes the
// quad's own bound (slabs widened by a margin), passes one of its triangles by the sign of the edge
// functions, t is that of the triangle's plane but never less than the entry into the quad's bound. Bounds
// above a quad contain it and slab distances are monotonic, so no traversal that cuts by the nearest t can
// lose such a hit. Equal t go to the lower primitive.
#ifndef LODESTONE_LAYOUT_TRACE_H
#define LODESTONE_LAYOUT_TRACE_H

#include "layout/arithmetic.h"
#include "layout/atlas.h"
#include "layout/ray.h"
#include "layout/ray_state.h"

LODESTONE_LAYOUT_BEGIN

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

// Rounding moves the corners of a sheared triangle by less than 2^-20.4 of the largest coordinate in play
// (difference to the origin 2^-23, shear factor and its product 2^-22 and 2^-23, their difference 2^-22), and
// slab distances are off by 2^-21.4 of it. Bounds are widened by more than both together, or a ray through an
// edge could pass beside the bound of the very triangle that claims it.
CONST float slab_margin = 1.9073486e-6f;  // 2^-19

// Directions below 2^-40 count as that, so that no slab distance is 0 * infinity.
FN float slab_inverse(float d) {
  float size = max2(abs1(d), 9.094947e-13f);
  return d < 0.0f ? -1.0f / size : 1.0f / size;
}

// `extent`: ObjectRecord::extent, so that it is the same whatever hierarchy the quad is in.
FN Slabs make_slabs(Ray ray, float extent) {
  float reach = max2(extent, largest_abs(ray.origin));
  float margin = reach * slab_margin;
  Slabs s;
  s.octant = (ray.direction.x < 0.0f ? 1u : 0u) | (ray.direction.y < 0.0f ? 2u : 0u) |
             (ray.direction.z < 0.0f ? 4u : 0u);
  vec3 signed_margin =
      vec3(ray.direction.x < 0.0f ? -margin : margin, ray.direction.y < 0.0f ? -margin : margin,
           ray.direction.z < 0.0f ? -margin : margin);
  s.near_origin = ray.origin + signed_margin;
  s.far_origin = ray.origin - signed_margin;
  s.inverse =
      vec3(slab_inverse(ray.direction.x), slab_inverse(ray.direction.y), slab_inverse(ray.direction.z));
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

// Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection": space is sheared so that the ray runs
// along z through (0, 0). Each corner is sheared once and alike for all triangles that have it, and the
// rounded products of a 2D edge function never get its sign wrong, at worst they say 0. So with 0 counted as
// inside for both triangles at an edge, every point that a closed surface covers is covered by one of its
// triangles, at edges and at vertices. (Signed volumes from rounded 3D products are consistent along edges,
// but round a vertex all of them can fall on one side.)
struct Shear {
  uint axis;  // the direction's largest component, which becomes z
  float x;
  float y;
  float z;  // t per unit of that component
};

FN Shear make_shear(Ray ray) {
  vec3 size = vec3(abs1(ray.direction.x), abs1(ray.direction.y), abs1(ray.direction.z));
  Shear shear;
  shear.axis = size.x >= size.y && size.x >= size.z ? 0u : (size.y >= size.z ? 1u : 2u);
  vec3 d = ray.direction;
  float dx = shear.axis == 0u ? d.y : (shear.axis == 1u ? d.z : d.x);
  float dy = shear.axis == 0u ? d.z : (shear.axis == 1u ? d.x : d.y);
  float dz = shear.axis == 0u ? d.x : (shear.axis == 1u ? d.y : d.z);
  shear.x = dx / dz;
  shear.y = dy / dz;
  shear.z = 1.0f / dz;
  return shear;
}

FN vec3 sheared(vec3 point, vec3 origin, Shear shear) {
  vec3 p = point - origin;
  float px = shear.axis == 0u ? p.y : (shear.axis == 1u ? p.z : p.x);
  float py = shear.axis == 0u ? p.z : (shear.axis == 1u ? p.x : p.y);
  float pz = shear.axis == 0u ? p.x : (shear.axis == 1u ? p.y : p.z);
  return vec3(px - shear.x * pz, py - shear.y * pz, shear.z * pz);
}

// On which side of the edge p q the ray passes. Swapping p and q flips the sign and nothing else.
FN float edge_function(vec3 p, vec3 q) {
  return p.x * q.y - p.y * q.x;
}

FN bool one_sided(float a, float b, float c) {
  return (a >= 0.0f && b >= 0.0f && c >= 0.0f) || (a <= 0.0f && b <= 0.0f && c <= 0.0f);
}

// w0, w1, w2: the edge functions opposite p0, p1, p2. t is a mean of the corners' with weights of one sign,
// so it cannot leave their range however small the triangle is. A ray that a mask let through goes on from
// tmin and with primitive `next`, so that what lies in the same plane is met as well; no_index: there, with
// none.
FN void accept_triangle(vec3 p0, vec3 p1, vec3 p2, float w0, float w1, float w2, float tmin, uint next,
                        float enter, uint primitive, INOUT(Hit) best) {
  float sum = w0 + w1 + w2;
  if (one_sided(w0, w1, w2) && sum != 0.0f) {
    float t = (w0 * p0.z + w1 * p1.z + w2 * p2.z) / sum;
    bool beyond = t > tmin || (t == tmin && primitive >= next);
    t = max2(t, enter);
    if (beyond && (t < best.t || (t == best.t && primitive < best.primitive))) {
      best.t = t;
      best.u = w1 / sum;
      best.v = w2 / sum;
      best.primitive = primitive;
    }
  }
}

// Both triangles of the quad a b c d by its five edge functions. `enter`: slab_enter of the quad's own bound.
FN void intersect_quad(vec3 a, vec3 b, vec3 c, vec3 d, Ray ray, Shear shear, uint next, float enter,
                       uint texel, INOUT(Hit) best) {
  a = sheared(a, ray.origin, shear);
  b = sheared(b, ray.origin, shear);
  c = sheared(c, ray.origin, shear);
  d = sheared(d, ray.origin, shear);
  float bc = edge_function(b, c);
  accept_triangle(a, b, c, bc, edge_function(c, a), edge_function(a, b), ray.tmin, next, enter, 2u * texel,
                  best);
  accept_triangle(d, c, b, -bc, edge_function(b, d), edge_function(d, c), ray.tmin, next, enter,
                  2u * texel + 1u, best);
}

// A place in the tree in visiting order, without a stack: two bits a level. `turns` holds, for each level on
// the path, which child the parent's order visits first (xor mask), `order` the position in visiting order;
// the node's index is order ^ turns.
struct Walk {
  uint depth;
  uint order;
  uint turns;
};

CONST uint walk_done = 0xffu;  // Walk::depth after the last node

FN uint walk_address(Walk walk) {
  return level_base(walk.depth) + (walk.order ^ walk.turns);
}

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

// What a dispatch begins with.
CONST uint resume_nothing = 0u;     // all rays from the root
CONST uint resume_states = 1u;      // those unfinished, from their states
CONST uint resume_unanswered = 2u;  // those that are `unanswered`, from the root

struct TracePush {
  uint rays;
  uint resume;  // one of the above
  uint budget;  // steps of a ray in this dispatch. Mesa before 23 stops a subgroup silently after 65,535 loop
                // iterations: with 8 lanes and two nested loops a budget of 4,000 can never reach that.
  uint image_texels;  // where something moves (layout/motion.h): of a geometry image
  uint objects;       // the same: hierarchies of a segment
  uint scattered;     // with levels of detail (layout/detail.h): 1 where rays have a second cone each
  vec3 camera;        // and the first cone, that all rays have
  float camera_width;
  float camera_spread;
  uint listed;  // 1: only those of `ray_list` (layout/ray_list.h), which are `rays`
};

LODESTONE_LAYOUT_END
#endif
