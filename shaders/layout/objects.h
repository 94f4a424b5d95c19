// SPDX-License-Identifier: MIT
// Two levels: objects, each a geometry image with a hierarchy in a space of its own, and instances, which put
// objects into the world (section 6 of the paper, "instancing"). The upper level is a tree of 16-bit boxes
// (layout/boxes.h) over the instances' bounds in Morton order, made anew every frame; a ray that enters the
// bound of one goes on through the object's hierarchy in the object's space. Directions are not normalised
// there, so that t is the same number in both.
//
// A hit in an instance is one that the ray has in the object's space, provided that it enters the instance's
// bound in the world; its t is never less than that entry. Bounds above a leaf contain it, so the order of
// visits does not matter (layout/trace.h). Equal t go to the lower instance.
#ifndef LODESTONE_LAYOUT_OBJECTS_H
#define LODESTONE_LAYOUT_OBJECTS_H

#include "layout/bounds.h"
#include "layout/boxes.h"
#include "layout/frame.h"
#include "layout/ray.h"
#include "layout/trace.h"

LODESTONE_LAYOUT_BEGIN

// Four quads a record.
struct ObjectRecord {
  uint first_node;  // of the hierarchy: of its records, where that is what the traversal reads
  uint first_slot;
  uint depth;  // of the leaves
  uint slots;
  vec3 lo;  // a box that holds all of the surface
  uint first_wide;
  vec3 hi;
  uint first_detail;  // of its nodes above the leaves (layout/detail.h)
  vec3 step;          // of the grid of its 16-bit boxes, whose base is `lo`
  float extent;       // the largest absolute coordinate of the box
};

FN ObjectRecord object_record(uvec4 a, uvec4 b, uvec4 c, uvec4 d) {
  ObjectRecord object;
  object.first_node = a.x;
  object.first_slot = a.y;
  object.depth = a.z;
  object.slots = a.w;
  object.lo = vec3(uintBitsToFloat(b.x), uintBitsToFloat(b.y), uintBitsToFloat(b.z));
  object.first_wide = b.w;
  object.hi = vec3(uintBitsToFloat(c.x), uintBitsToFloat(c.y), uintBitsToFloat(c.z));
  object.first_detail = c.w;
  object.step = vec3(uintBitsToFloat(d.x), uintBitsToFloat(d.y), uintBitsToFloat(d.z));
  object.extent = uintBitsToFloat(d.w);
  return object;
}

FN BoxGrid object_grid(IN(ObjectRecord) object) {
  BoxGrid grid;
  grid.base = object.lo;
  grid.pad0 = 0.0f;
  grid.step = object.step;
  grid.pad1 = 0.0f;
  return grid;
}

FN vec3 transformed_point(vec3 p, vec4 row0, vec4 row1, vec4 row2) {
  return vec3(row0.x * p.x + row0.y * p.y + row0.z * p.z + row0.w,
              row1.x * p.x + row1.y * p.y + row1.z * p.z + row1.w,
              row2.x * p.x + row2.y * p.y + row2.z * p.z + row2.w);
}
FN vec3 transformed_direction(vec3 d, vec4 row0, vec4 row1, vec4 row2) {
  return vec3(row0.x * d.x + row0.y * d.y + row0.z * d.z, row1.x * d.x + row1.y * d.y + row1.z * d.z,
              row2.x * d.x + row2.y * d.y + row2.z * d.z);
}

// Around the box that `to_world` makes of an object's.
FN Bound instance_bound(vec3 lo, vec3 hi, vec4 row0, vec4 row1, vec4 row2) {
  vec3 middle = (lo + hi) * 0.5f;
  vec3 half_size = (hi - lo) * 0.5f;
  vec3 center = transformed_point(middle, row0, row1, row2);
  vec3 reach = vec3(abs1(row0.x) * half_size.x + abs1(row0.y) * half_size.y + abs1(row0.z) * half_size.z,
                    abs1(row1.x) * half_size.x + abs1(row1.y) * half_size.y + abs1(row1.z) * half_size.z,
                    abs1(row2.x) * half_size.x + abs1(row2.y) * half_size.y + abs1(row2.z) * half_size.z);
  // For the rounding of these sums; that of rays is for enter_instances.
  float slack = max2(largest_abs(center), largest_abs(reach)) * 4.7683716e-7f;  // 2^-21
  Bound bound;
  bound.lo = flush_tiny3(center - reach - vec3(slack, slack, slack));
  bound.hi = flush_tiny3(center + reach + vec3(slack, slack, slack));
  return bound;
}

// Ten bits an axis; positions in [0, 1024) from the corner of a grid.
FN uint spread_by_three(uint x) {
  x = x & 0x3ffu;
  x = (x | (x << 16u)) & 0x030000ffu;
  x = (x | (x << 8u)) & 0x0300f00fu;
  x = (x | (x << 4u)) & 0x030c30c3u;
  x = (x | (x << 2u)) & 0x09249249u;
  return x;
}
FN uint morton_cell(float x, float base, float per_step) {
  return uint(int(clamp1((x - base) * per_step, 0.0f, 1023.0f)));
}
FN uint morton_key(vec3 p, vec3 base, vec3 per_step) {
  return spread_by_three(morton_cell(p.x, base.x, per_step.x)) |
         (spread_by_three(morton_cell(p.y, base.y, per_step.y)) << 1u) |
         (spread_by_three(morton_cell(p.z, base.z, per_step.z)) << 2u);
}
CONST uint last_morton_key = 0xffffffffu;  // of what is not seen

struct PlacePush {
  uint instances;
  vec3 base;      // of the grid of keys
  vec3 per_step;  // cells per unit of length
};

// Keys and their instances are sorted in runs. In runs of `run` keys, or of `sort_run` where that is 0, each
// finds its place among the keys of its run and the next one.
CONST uint sort_run = 64u;
struct SortPush {
  uint count;
  uint run;  // keys of a run that is sorted; 0: none is
};

// What enter_instances is about: rays, or those of the round before.
struct EnterPush {
  uint count;
  uint round;      // 0: all rays, from the root
  uint resume;     // round 0: only those that `mask` has sent on
  uint depth;      // of the upper level's leaves
  uint budget;     // steps of a ray in this dispatch
  float extent;    // the largest absolute coordinate of all bounds
  float rounding;  // the largest of all instances
  uint block;      // of rays that are counted together (layout/ray_list.h)
  BoxGrid grid;
};
CONST uint enter_paused = 0xfffffffeu;  // instead of an instance: the budget was spent before one was found
CONST uint place_paused = 256u;         // the same, beside the depth of the ray's place

struct GatherPush {
  uint count;
  uint round;
  uint block;
};

LODESTONE_LAYOUT_END
#endif
