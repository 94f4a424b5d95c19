// SPDX-License-Identifier: MIT
// Sixty-four rays from one origin against boxes, as `tile` sees them: eight groups of eight rays, each group
// and all of them together an interval of directions.
#ifndef LODESTONE_LAYOUT_TILE_H
#define LODESTONE_LAYOUT_TILE_H

#include "layout/boxes.h"

LODESTONE_LAYOUT_BEGIN

CONST uint tile_rays = 64u;
CONST uint tile_lanes = 8u;
CONST uint tile_kinds = 4u;  // of rays that do not go together, in a tile
CONST uint tile_fan = 16u;   // grandchildren tested at once, two a lane

// What all rays of a tile share: origin and signs of the direction. Along each axis, in units in which all
// rays go upwards, plane q of the grid is q * step + offset away from the origin, and no sharper than
// layout/trace.h's difference to the plane that q was rounded from (slack as in layout/boxes.h).
struct TileAxes {
  vec3 step;
  vec3 near_offset;
  vec3 far_offset;
};

FN float tile_offset(float base, float origin, bool negative) {
  float up = base - origin;
  float down = origin - base;
  return negative ? down : up;
}

FN TileAxes make_tile_axes(IN(Slabs) s, IN(BoxGrid) grid) {
  bool nx = (s.octant & 1u) != 0u;
  bool ny = (s.octant & 2u) != 0u;
  bool nz = (s.octant & 4u) != 0u;
  vec3 down = vec3(-grid.step.x, -grid.step.y, -grid.step.z);
  vec3 near_offset =
      vec3(tile_offset(grid.base.x, s.near_origin.x, nx), tile_offset(grid.base.y, s.near_origin.y, ny),
           tile_offset(grid.base.z, s.near_origin.z, nz));
  vec3 far_offset =
      vec3(tile_offset(grid.base.x, s.far_origin.x, nx), tile_offset(grid.base.y, s.far_origin.y, ny),
           tile_offset(grid.base.z, s.far_origin.z, nz));
  TileAxes axes;
  axes.step = vec3(nx ? down.x : grid.step.x, ny ? down.y : grid.step.y, nz ? down.z : grid.step.z);
  axes.near_offset =
      near_offset - vec3(box_slack(grid.step.x, near_offset.x), box_slack(grid.step.y, near_offset.y),
                         box_slack(grid.step.z, near_offset.z));
  axes.far_offset =
      far_offset + vec3(box_slack(grid.step.x, far_offset.x), box_slack(grid.step.y, far_offset.y),
                        box_slack(grid.step.z, far_offset.z));
  return axes;
}

// The sizes of the rays' reciprocal directions.
struct Cone {
  vec3 lo;
  vec3 hi;
};

// A box as the rays of a tile see it: how far away its near and far planes are.
struct BoxSides {
  vec3 near;
  vec3 far;
  bool there;
};

// One axis of one box: `low` and `high` plane.
FN vec2 box_sides_along(uint low, uint high, bool negative, float step, float near_offset, float far_offset) {
  uint first = negative ? high : low;
  uint second = negative ? low : high;
  return vec2(float(int(first)) * step + near_offset, float(int(second)) * step + far_offset);
}

FN BoxSides make_box_sides(uvec3 lo, uvec3 hi, IN(TileAxes) axes, uint octant) {
  vec2 x =
      box_sides_along(lo.x, hi.x, (octant & 1u) != 0u, axes.step.x, axes.near_offset.x, axes.far_offset.x);
  vec2 y =
      box_sides_along(lo.y, hi.y, (octant & 2u) != 0u, axes.step.y, axes.near_offset.y, axes.far_offset.y);
  vec2 z =
      box_sides_along(lo.z, hi.z, (octant & 4u) != 0u, axes.step.z, axes.near_offset.z, axes.far_offset.z);
  BoxSides sides;
  sides.near = vec3(x.x, y.x, z.x);
  sides.far = vec3(x.y, y.y, z.y);
  sides.there = lo.x <= hi.x;
  return sides;
}

// The least and the greatest product of a distance with a number in [lo, hi].
FN float least_product(float x, float lo, float hi) {
  float by = x < 0.0f ? hi : lo;
  return x * by;
}
FN float most_product(float x, float lo, float hi) {
  float by = x < 0.0f ? lo : hi;
  return x * by;
}

// No farther than where any of the rays enters, no nearer than where any leaves.
FN float cone_enter(IN(BoxSides) b, IN(Cone) c, float tmin) {
  return max2(max2(least_product(b.near.x, c.lo.x, c.hi.x), least_product(b.near.y, c.lo.y, c.hi.y)),
              max2(least_product(b.near.z, c.lo.z, c.hi.z), tmin));
}
FN float cone_exit(IN(BoxSides) b, IN(Cone) c, float tmax) {
  return min2(min2(most_product(b.far.x, c.lo.x, c.hi.x), most_product(b.far.y, c.lo.y, c.hi.y)),
              min2(most_product(b.far.z, c.lo.z, c.hi.z), tmax));
}

FN bool cone_enters(IN(BoxSides) b, IN(Cone) c, float tmin, float tmax) {
  return b.there && cone_enter(b, c, tmin) <= cone_exit(b, c, tmax);
}

// Like box_key, with the number of one of 16 children.
FN uint tile_key(IN(BoxSides) b, IN(Cone) c, float tmin, float tmax, uint child) {
  float enter = cone_enter(b, c, tmin);
  uint key = (floatBitsToUint(enter) & ~15u) | child;
  return b.there && enter <= cone_exit(b, c, tmax) ? key : box_missed;
}

// Whether what waits behind a key lies beyond tmax, which is not negative.
FN bool key_beyond(uint key, float tmax) {
  return (key & ~15u) > floatBitsToUint(tmax);
}

// layout/trace.h's test in two steps, for corners that many rays share: first what depends on the tile, then
// what does on the ray. Coordinates in the order in which z is the axis of the shear.
FN vec3 turned(vec3 p, uint axis) {
  float px = axis == 0u ? p.y : (axis == 1u ? p.z : p.x);
  float py = axis == 0u ? p.z : (axis == 1u ? p.x : p.y);
  float pz = axis == 0u ? p.x : (axis == 1u ? p.y : p.z);
  return vec3(px, py, pz);
}
FN vec3 sheared_turned(vec3 p, IN(Shear) shear) {
  return vec3(p.x - shear.x * p.z, p.y - shear.y * p.z, shear.z * p.z);
}
FN void intersect_sheared(vec3 a, vec3 b, vec3 c, vec3 d, float tmin, uint passed, float enter, uint texel,
                          INOUT(Hit) best) {
  float bc = edge_function(b, c);
  accept_triangle(a, b, c, bc, edge_function(c, a), edge_function(a, b), tmin, passed, enter, 2u * texel,
                  best);
  accept_triangle(d, c, b, -bc, edge_function(b, d), edge_function(d, c), tmin, passed, enter,
                  2u * texel + 1u, best);
}

// The level whose nodes the root's record has, and so on two by two to the leaves.
FN uint tile_first_level(uint depth) {
  return 2u - (depth & 1u);
}

LODESTONE_LAYOUT_END
#endif
