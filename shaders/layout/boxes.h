// SPDX-License-Identifier: MIT
// The hierarchy in 16 bits, as `wide` sees it: for every inner node a record of its four children's bounds.
//
// Record of node `index` of level `depth` is number level_base(depth) + index and lies in three quads, an
// axis each: { low planes of children 0 and 1, of 2 and 3, high planes of 0 and 1, of 2 and 3 }, the even
// child in the lower half of a word. A plane q stands for base + q * step of the grid, which holds all of the
// surface in a pose. Planes are rounded outwards: a ray that enters a bound enters its box, never the other
// way round, and what a hit is, the quad's own bound decides (layout/trace.h). A box whose low plane is above
// its high one is empty: no child, or none with a quad.
#ifndef LODESTONE_LAYOUT_BOXES_H
#define LODESTONE_LAYOUT_BOXES_H

#include "layout/bounds.h"
#include "layout/trace.h"

LODESTONE_LAYOUT_BEGIN

struct BoxGrid {
  vec3 base;
  float pad0;
  vec3 step;
  float pad1;
};

struct BoxesPush {
  uint depth;          // of the nodes that are read: the leaves, or a level above
  uint count;          // leaf slots, blocks of them, or records of that level
  uint written;        // records of the next level to write ...
  uint written_above;  // ... and of the one above that
  BoxGrid grid;
  uint first_node;  // the hierarchy's first record
  uint first_slot;
  uint first_item;  // of its blocks, or groups
  uint image;       // first texel of the geometry image, and ...
  uint next_image;  // ... of the one behind, where something moves
};

CONST uint box_last_plane = 65535u;

struct Box {
  uvec3 lo;
  uvec3 hi;
};

FN Box empty_box() {
  Box box;
  box.lo = uvec3(box_last_plane, box_last_plane, box_last_plane);
  box.hi = uvec3(0u, 0u, 0u);
  return box;
}

FN uint box_min(uint a, uint b) {
  return a < b ? a : b;
}
FN uint box_max(uint a, uint b) {
  return a < b ? b : a;
}

FN Box join_boxes(Box a, Box b) {
  Box box;
  box.lo = uvec3(box_min(a.lo.x, b.lo.x), box_min(a.lo.y, b.lo.y), box_min(a.lo.z, b.lo.z));
  box.hi = uvec3(box_max(a.hi.x, b.hi.x), box_max(a.hi.y, b.hi.y), box_max(a.hi.z, b.hi.z));
  return box;
}

// (plane - base) / step is off by less than 65536 * 4 * 2^-24 = 1/64 step: an eighth of slack rounds
// outwards. What the conversions truncate is not negative.
FN uint box_low_plane(float x, float base, float per_step) {
  return uint(int(clamp1((x - base) * per_step - 0.125f, 0.0f, 65535.0f)));
}
FN uint box_high_plane(float x, float base, float per_step) {
  return uint(int(clamp1((x - base) * per_step + 1.125f, 0.0f, 65535.0f)));
}

FN Box bound_box(vec3 lo, vec3 hi, IN(BoxGrid) grid, vec3 per_step) {
  Box box;
  box.lo = uvec3(box_low_plane(lo.x, grid.base.x, per_step.x), box_low_plane(lo.y, grid.base.y, per_step.y),
                 box_low_plane(lo.z, grid.base.z, per_step.z));
  box.hi = uvec3(box_high_plane(hi.x, grid.base.x, per_step.x), box_high_plane(hi.y, grid.base.y, per_step.y),
                 box_high_plane(hi.z, grid.base.z, per_step.z));
  return box;
}

FN uvec4 pack_planes(uint lo0, uint lo1, uint lo2, uint lo3, uint hi0, uint hi1, uint hi2, uint hi3) {
  return uvec4(lo0 | (lo1 << 16u), lo2 | (lo3 << 16u), hi0 | (hi1 << 16u), hi2 | (hi3 << 16u));
}

FN uint lower_min(uint a, uint b) {
  return box_min(box_min(a & 0xffffu, a >> 16u), box_min(b & 0xffffu, b >> 16u));
}
FN uint upper_max(uint a, uint b) {
  return box_max(box_max(a & 0xffffu, a >> 16u), box_max(b & 0xffffu, b >> 16u));
}

// What holds all four boxes of a record.
FN Box record_box(uvec4 x, uvec4 y, uvec4 z) {
  Box box;
  box.lo = uvec3(lower_min(x.x, x.y), lower_min(y.x, y.y), lower_min(z.x, z.y));
  box.hi = uvec3(upper_max(x.z, x.w), upper_max(y.z, y.w), upper_max(z.z, z.w));
  return box;
}

// A ray made ready for boxes: the distance to plane q of an axis is q * scale + offset, and no sharper than
// layout/trace.h's slab distance to the plane that q was rounded from: the offsets have slack for the
// rounding on both sides, which is below 5 * 2^-24 of the largest terms.
struct BoxRay {
  vec3 scale;
  vec3 near_offset;
  vec3 far_offset;
};

FN float box_slack(float scale, float offset) {
  return (abs1(scale) * 65536.0f + abs1(offset)) * 4.7683716e-7f;  // 2^-21
}

FN BoxRay make_box_ray(IN(Slabs) s, IN(BoxGrid) grid) {
  BoxRay r;
  r.scale = grid.step * s.inverse;
  vec3 near_offset = (grid.base - s.near_origin) * s.inverse;
  vec3 far_offset = (grid.base - s.far_origin) * s.inverse;
  r.near_offset = near_offset - vec3(box_slack(r.scale.x, near_offset.x), box_slack(r.scale.y, near_offset.y),
                                     box_slack(r.scale.z, near_offset.z));
  r.far_offset = far_offset + vec3(box_slack(r.scale.x, far_offset.x), box_slack(r.scale.y, far_offset.y),
                                   box_slack(r.scale.z, far_offset.z));
  return r;
}

// For boxes whose surface may be farther out by `margin`.
FN BoxRay widened(IN(BoxRay) ray, IN(Slabs) s, vec3 margin) {
  BoxRay r = ray;
  vec3 reach = vec3(abs1(s.inverse.x), abs1(s.inverse.y), abs1(s.inverse.z)) * (margin * 1.0001f);
  r.near_offset = ray.near_offset - reach;
  r.far_offset = ray.far_offset + reach;
  return r;
}

FN vec4 plane_distances(uint even_odd, uint next_two, float scale, float offset) {
  return vec4(float(int(even_odd & 0xffffu)) * scale + offset, float(int(even_odd >> 16u)) * scale + offset,
              float(int(next_two & 0xffffu)) * scale + offset, float(int(next_two >> 16u)) * scale + offset);
}

CONST uint box_missed = 0xffffffffu;

// Where a ray enters a box, as bits that order like it, the child's number in the lowest two; or box_missed.
FN uint box_key(float x, float y, float z, float out_x, float out_y, float out_z, float tmin, float tmax,
                bool there, uint child) {
  float enter = max2(max2(x, y), max2(z, tmin));
  float leave = min2(min2(out_x, out_y), min2(out_z, tmax));
  uint key = (floatBitsToUint(enter) & ~3u) | child;
  return there && enter <= leave ? key : box_missed;
}

// The keys of a record's children.
FN uvec4 box_keys(uvec4 x, uvec4 y, uvec4 z, IN(BoxRay) r, uint octant, float tmin, float tmax) {
  uvec4 back_x = uvec4(x.z, x.w, x.x, x.y);
  uvec4 back_y = uvec4(y.z, y.w, y.x, y.y);
  uvec4 back_z = uvec4(z.z, z.w, z.x, z.y);
  uvec4 px = (octant & 1u) != 0u ? back_x : x;
  uvec4 py = (octant & 2u) != 0u ? back_y : y;
  uvec4 pz = (octant & 4u) != 0u ? back_z : z;
  vec4 in_x = plane_distances(px.x, px.y, r.scale.x, r.near_offset.x);
  vec4 in_y = plane_distances(py.x, py.y, r.scale.y, r.near_offset.y);
  vec4 in_z = plane_distances(pz.x, pz.y, r.scale.z, r.near_offset.z);
  vec4 out_x = plane_distances(px.z, px.w, r.scale.x, r.far_offset.x);
  vec4 out_y = plane_distances(py.z, py.w, r.scale.y, r.far_offset.y);
  vec4 out_z = plane_distances(pz.z, pz.w, r.scale.z, r.far_offset.z);
  return uvec4(box_key(in_x.x, in_y.x, in_z.x, out_x.x, out_y.x, out_z.x, tmin, tmax,
                       (x.x & 0xffffu) <= (x.z & 0xffffu), 0u),
               box_key(in_x.y, in_y.y, in_z.y, out_x.y, out_y.y, out_z.y, tmin, tmax,
                       (x.x >> 16u) <= (x.z >> 16u), 1u),
               box_key(in_x.z, in_y.z, in_z.z, out_x.z, out_y.z, out_z.z, tmin, tmax,
                       (x.y & 0xffffu) <= (x.w & 0xffffu), 2u),
               box_key(in_x.w, in_y.w, in_z.w, out_x.w, out_y.w, out_z.w, tmin, tmax,
                       (x.y >> 16u) <= (x.w >> 16u), 3u));
}

// The children that a ray enters, nearest first: two bits each, and from bit 8 on how many.
FN uint box_list(uvec4 keys) {
  uint a = box_min(keys.x, keys.y);
  uint b = box_max(keys.x, keys.y);
  uint c = box_min(keys.z, keys.w);
  uint d = box_max(keys.z, keys.w);
  uint first = box_min(a, c);
  uint e = box_max(a, c);
  uint f = box_min(b, d);
  uint last = box_max(b, d);
  uint second = box_min(e, f);
  uint third = box_max(e, f);
  uint count = (first != box_missed ? 1u : 0u) + (second != box_missed ? 1u : 0u) +
               (third != box_missed ? 1u : 0u) + (last != box_missed ? 1u : 0u);
  return (first & 3u) | ((second & 3u) << 2u) | ((third & 3u) << 4u) | ((last & 3u) << 6u) | (count << 8u);
}

// A place in the tree of records without a stack: of each level on the path that has children waiting, a byte
// says which, in order, in two bits each, and in its highest two bits how many.
struct BoxWalk {
  uint depth;
  uint index;   // of the record's node on its level
  uint levels;  // bit d: children of the path's record of level d wait
  uvec4 trail;  // their bytes, the deepest lowest: at most 14
};

// To the nearest child of a list that is not empty.
FN BoxWalk box_walk_down(BoxWalk walk, uint list) {
  uint rest = (list >> 8u) - 1u;
  bool waits = rest != 0u;
  uvec4 t = walk.trail;
  uvec4 pushed = uvec4((t.x << 8u) | ((list >> 2u) & 63u) | (rest << 6u), (t.y << 8u) | (t.x >> 24u),
                       (t.z << 8u) | (t.y >> 24u), (t.w << 8u) | (t.z >> 24u));
  uint levels = walk.levels | (1u << walk.depth);
  walk.trail = waits ? pushed : t;
  walk.levels = waits ? levels : walk.levels;
  walk.index = (walk.index << 2u) | (list & 3u);
  walk.depth = walk.depth + 1u;
  return walk;
}

// x: below 2^24, not 0.
FN uint highest_bit(uint x) {
  return (floatBitsToUint(float(int(x))) >> 23u) - 127u;
}

// To the next child that waits; depth: walk_done where there is none.
FN BoxWalk box_walk_on(BoxWalk walk) {
  bool done = walk.levels == 0u;
  uint level = highest_bit(walk.levels | 1u);  // the deepest; any, where there is none
  uvec4 t = walk.trail;
  uint left = (t.x >> 6u) & 3u;
  bool last = left == 1u;
  uvec4 shifted =
      uvec4((t.x >> 8u) | (t.y << 24u), (t.y >> 8u) | (t.z << 24u), (t.z >> 8u) | (t.w << 24u), t.w >> 8u);
  uvec4 kept = uvec4((t.x & ~255u) | ((t.x >> 2u) & 15u) | ((left - 1u) << 6u), t.y, t.z, t.w);
  uint levels = walk.levels & ~(1u << level);
  walk.index = ((walk.index >> (2u * ((walk.depth - level) & 15u))) << 2u) | (t.x & 3u);
  walk.trail = last ? shifted : kept;
  walk.levels = last ? levels : walk.levels;
  uint depth = level + 1u;
  walk.depth = done ? walk_done : depth;
  return walk;
}

LODESTONE_LAYOUT_END
#endif
