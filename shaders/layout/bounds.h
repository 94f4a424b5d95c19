// SPDX-License-Identifier: MIT
// Bounds of quads and of nodes, and the order in which a ray of each octant should visit a node's children.
#ifndef LODESTONE_LAYOUT_BOUNDS_H
#define LODESTONE_LAYOUT_BOUNDS_H

#include "layout/arithmetic.h"
#include "layout/atlas.h"

LODESTONE_LAYOUT_BEGIN

struct Bound {
  vec3 lo;
  vec3 hi;
};

FN Bound empty_bound() {
  Bound bound;
  bound.lo = vec3(infinity_bits_as_max, infinity_bits_as_max, infinity_bits_as_max);
  bound.hi = vec3(-infinity_bits_as_max, -infinity_bits_as_max, -infinity_bits_as_max);
  return bound;
}

FN Bound quad_bound(vec3 a, vec3 b, vec3 c, vec3 d) {
  Bound bound;
  bound.lo = min3(min3(a, b), min3(c, d));
  bound.hi = max3(max3(a, b), max3(c, d));
  return bound;
}

FN Bound join(Bound a, Bound b) {
  Bound bound;
  bound.lo = min3(a.lo, b.lo);
  bound.hi = max3(a.hi, b.hi);
  return bound;
}

// For each octant two bits: whether the children 1 and 3 lie before 0 and 2, and 2 and 3 before 0 and 1,
// along a ray of that octant, by the sums of their bounds. An empty child's corners cancel out.
FN uint child_order(Bound c0, Bound c1, Bound c2, Bound c3) {
  vec3 s0 = c0.lo + c0.hi;
  vec3 s1 = c1.lo + c1.hi;
  vec3 s2 = c2.lo + c2.hi;
  vec3 s3 = c3.lo + c3.hi;
  vec3 odd = (s1 + s3) - (s0 + s2);
  vec3 upper = (s2 + s3) - (s0 + s1);
  uint order = 0u;
  for (uint octant = 0u; octant < 8u; ++octant) {
    float sx = (octant & 1u) != 0u ? -1.0f : 1.0f;
    float sy = (octant & 2u) != 0u ? -1.0f : 1.0f;
    float sz = (octant & 4u) != 0u ? -1.0f : 1.0f;
    uint first = (odd.x * sx + odd.y * sy + odd.z * sz < 0.0f ? 1u : 0u) |
                 (upper.x * sx + upper.y * sy + upper.z * sz < 0.0f ? 2u : 0u);
    order = order | (first << (2u * octant));
  }
  return order;
}

LODESTONE_LAYOUT_END
#endif
