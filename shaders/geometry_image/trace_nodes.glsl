// SPDX-License-Identifier: MIT
// What the traversals of single nodes share: the hierarchy in 32 bits. Before this come counters.
#include "layout/trace.h"

QUADS(6, readonly, nodes_lo);
QUADS(7, readonly, nodes_hi);
PUSH(TracePush, push);

#include "geometry_image/trace.glsl"

// The largest absolute coordinate of a hierarchy's bound.
float root_extent(uint first_node) {
  uvec4 lo;
  uvec4 hi;
  LOAD4(lo, nodes_lo, first_node);
  LOAD4(hi, nodes_hi, first_node);
  return max2(largest_abs(as_vec3(lo)), largest_abs(as_vec3(hi)));
}
