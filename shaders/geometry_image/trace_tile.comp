// SPDX-License-Identifier: MIT
// Tiles of 64 rays from one origin: a subgroup of 8 lanes takes each through the tree once. A lane tests two of a
// node's 16 grandchildren against the directions of the whole tile, and, where those are quads, of each group of 8
// rays; then a lane is a ray again, and each group is tested against the quads it may meet. Rays go together that have
// one origin and one octant and lie along one axis; a tile of several kinds is taken through once for each of the first
// few. What is left then goes to `trace_boxes`, and so do tiles that take too long.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "kernel.glsl"
#include "layout/tile.h"

QUADS(6, readonly, boxes);
QUADS(7, readonly, leaf_map);  // two slots a quad
QUADS(8, readonly, objects);
WORDS(9, readonly, roots);
WORDS(10, readonly, times);
WORDS(11, readonly, collapses);
QUADS(12, readonly, node_details);
QUADS(13, readonly, coarse_quads);
QUADS(14, readonly, cones);
WORDS(15, readonly, ray_list);
COUNTERS(16)
PUSH(TracePush, push);

#include "geometry_image/trace.glsl"

uint lane = gl_SubgroupInvocationID;

// Over all lanes, by patterns that are one instruction each.
float lanes_min(float x) {
  float y = subgroupShuffleXor(x, 1u);
  x = min2(x, y);
  y = subgroupShuffleXor(x, 2u);
  x = min2(x, y);
  y = subgroupShuffleXor(x, 4u);
  return min2(x, y);
}
float lanes_max(float x) {
  float y = subgroupShuffleXor(x, 1u);
  x = max2(x, y);
  y = subgroupShuffleXor(x, 2u);
  x = max2(x, y);
  y = subgroupShuffleXor(x, 4u);
  return max2(x, y);
}
uint lanes_min(uint x) {
  uint y = subgroupShuffleXor(x, 1u);
  x = box_min(x, y);
  y = subgroupShuffleXor(x, 2u);
  x = box_min(x, y);
  y = subgroupShuffleXor(x, 4u);
  return box_min(x, y);
}
uint lanes_or(uint x) {
  x |= subgroupShuffleXor(x, 1u);
  x |= subgroupShuffleXor(x, 2u);
  return x | subgroupShuffleXor(x, 4u);
}
vec3 corner_of(vec3 v, uint from) {
  return vec3(subgroupShuffle(v.x, from), subgroupShuffle(v.y, from), subgroupShuffle(v.z, from));
}

ObjectRecord object;  // the only one
// What the rays share that go together.
vec3 origin;
float tmin;
uint octant;
uint axis;
Slabs common_slabs;  // but for `inverse`
TileAxes axes;

struct Group {
  bool waits;   // this lane's ray has not been traced yet
  bool enabled;  // it is being traced
  vec3 inverse;
  Shear shear;
  Hit best;
  Cone cone;
  float tmax;  // the farthest of the enabled rays' hits; negative: there are none
};

Group first_group(uint first) {
  uint index = first + lane;
  Group group;
  group.waits = index < push.rays;
  group.best.t = -1.0;
  group.best.u = 0.0;
  group.best.v = 0.0;
  group.best.primitive = no_index;
  return group;
}

// Those of rays first + 0..7 that go together become enabled.
void activate(inout Group group, uint first) {
  uint index = first + lane;
  uint last = push.rays - 1u;
  Ray ray = load_ray(index < push.rays ? index : last);
  Slabs slabs = make_slabs(ray, object.extent);
  group.inverse = slabs.inverse;
  group.shear = make_shear(ray);
  bool alike = ray.origin.x == origin.x && ray.origin.y == origin.y && ray.origin.z == origin.z && ray.tmin == tmin &&
               floatBitsToUint(tmin) < 0x80000000u && slabs.octant == octant && group.shear.axis == axis;
  bool is_ray = ray.tmax >= 0.0;
  group.enabled = group.waits && is_ray && alike;
  if (group.enabled || (group.waits && ray.tmax < 0.0)) {
    group.best.t = ray.tmax;
    group.waits = false;
  }
  vec3 size = vec3(abs1(slabs.inverse.x), abs1(slabs.inverse.y), abs1(slabs.inverse.z));
  vec3 least = group.enabled ? size : vec3(infinity_bits_as_max);
  vec3 most = group.enabled ? size : vec3(0.0);
  group.cone.lo = vec3(lanes_min(least.x), lanes_min(least.y), lanes_min(least.z));
  group.cone.hi = vec3(lanes_max(most.x), lanes_max(most.y), lanes_max(most.z));
  group.tmax = lanes_max(group.enabled ? ray.tmax : -1.0);
  if (counting != 0u && group.enabled) count(counter_rays, 1u);
}

Cone join_cones(Cone a, Cone b) {
  Cone cone;
  cone.lo = min3(a.lo, b.lo);
  cone.hi = max3(a.hi, b.hi);
  return cone;
}

// Bits of the two children that this lane has, as the rays of a group enter them.
uint group_enters(Group group, BoxSides even, BoxSides odd) {
  uint bits = (cone_enters(even, group.cone, tmin, group.tmax) ? 1u : 0u) |
              (cone_enters(odd, group.cone, tmin, group.tmax) ? 2u : 0u);
  return bits << (2u * lane);
}

// A group's rays against the quads whose bits are set. `slots`: of this lane's two quads, texel and stride each.
void test_group(inout Group group, uint quads, uvec4 slots, inout uint left) {
  while (quads != 0u) {
    uint bit = quads & (~quads + 1u);
    quads ^= bit;
    left -= 1u;
    uint quad = highest_bit(bit);
    bool mine = lane == quad >> 1u;
    bool odd = (quad & 1u) != 0u;
    uint own_texel = odd ? slots.z : slots.x;
    uint own_stride = odd ? slots.w : slots.y;
    uint texel = lanes_or(mine ? own_texel : 0u);
    uint stride = lanes_or(mine ? own_stride : 0u);
    // A corner a lane; bounds over each four lanes.
    uint row = (lane & 2u) != 0u ? stride : 0u;
    uvec4 bits;
    LOAD4(bits, geometry, texel + row + (lane & 1u));
    vec3 point = as_vec3(bits);
    vec3 other = vec3(subgroupShuffleXor(point.x, 1u), subgroupShuffleXor(point.y, 1u), subgroupShuffleXor(point.z, 1u));
    vec3 lo = min3(point, other);
    vec3 hi = max3(point, other);
    other = vec3(subgroupShuffleXor(lo.x, 2u), subgroupShuffleXor(lo.y, 2u), subgroupShuffleXor(lo.z, 2u));
    lo = min3(lo, other);
    other = vec3(subgroupShuffleXor(hi.x, 2u), subgroupShuffleXor(hi.y, 2u), subgroupShuffleXor(hi.z, 2u));
    hi = max3(hi, other);
    vec3 corner = turned(point - origin, axis);
    Slabs slabs = common_slabs;
    slabs.inverse = group.inverse;
    float enter = slab_enter(slabs, lo, hi, tmin);
    float leave = slab_exit(slabs, lo, hi, group.enabled ? group.best.t : -1.0);
    if (enter <= leave) {
      intersect_sheared(sheared_turned(corner_of(corner, 0u), group.shear),
                        sheared_turned(corner_of(corner, 1u), group.shear),
                        sheared_turned(corner_of(corner, 2u), group.shear),
                        sheared_turned(corner_of(corner, 3u), group.shear), tmin, no_index, enter, texel, group.best);
    }
    triangle_tests += 2u;
  }
  group.tmax = lanes_max(group.enabled ? group.best.t : -1.0);
}

void store_group(Group group, uint first, bool in_time, inout uint again) {
  uint index = first + lane;
  if (index < push.rays) {
    bool done = in_time && !group.waits;
    uint primitive = resumable != 0u || done ? group.best.primitive : unanswered;
    STORE4(hits, index, as_bits(vec3(group.best.t, group.best.u, group.best.v), primitive));
    if (resumable != 0u) STORE4(states, index, uvec4(0u, 0u, done ? trace_finished : trace_restart, no_index));
    again += done ? 0u : 1u;
  }
}

#define EACH_GROUP(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)

// The lowest number of a ray that waits, of those before `found`.
uint first_waiting(uint found, Group group, uint number) {
  uint own = tile_lanes * number + lane;
  return group.waits ? box_min(found, own) : found;
}

void main() {
  uint first = tile_rays * (invocation() / tile_lanes);
  if (first >= push.rays) return;
  object = load_object(0u);
#define BEGIN(i) Group group##i = first_group(first + tile_lanes * uint(i));
  EACH_GROUP(BEGIN)
  uint lead = 0u;  // the first ray that waits
  uint left = 8u * push.budget;  // loop iterations
  uint limit = left;
  for (uint kind = 0u; kind < tile_kinds && lead < tile_rays && left - 1u < limit; ++kind) {
    Ray lead_ray = load_ray(first + lead);  // the same for all lanes
    common_slabs = make_slabs(lead_ray, object.extent);
    origin = lead_ray.origin;
    tmin = lead_ray.tmin;
    octant = common_slabs.octant;
    axis = make_shear(lead_ray).axis;
    axes = make_tile_axes(common_slabs, object_grid(object));
#define ACTIVATE(i) activate(group##i, first + tile_lanes * uint(i));
    EACH_GROUP(ACTIVATE)
    Cone cone = join_cones(join_cones(join_cones(group0.cone, group1.cone), join_cones(group2.cone, group3.cone)),
                           join_cones(join_cones(group4.cone, group5.cone), join_cones(group6.cone, group7.cone)));
    float tmax = max2(max2(max2(group0.tmax, group1.tmax), max2(group2.tmax, group3.tmax)),
                      max2(max2(group4.tmax, group5.tmax), max2(group6.tmax, group7.tmax)));

    // Keys of the children that wait, two a lane, of the node on the path at each level; first of the root itself.
    uint even = lane == 0u ? 0u : box_missed;
    uint odd = box_missed;
    uint even1 = box_missed, even2 = box_missed, even3 = box_missed, even4 = box_missed, even5 = box_missed, even6 = box_missed;
    uint odd1 = box_missed, odd2 = box_missed, odd3 = box_missed, odd4 = box_missed, odd5 = box_missed, odd6 = box_missed;
    uint height = 0u;  // records above, and the root
    uint node = 0u;    // that the keys are the children of
    bool walking = !(tmax < 0.0);
    while (walking) {
      bool at_leaves = false;
      BoxSides even_box;
      BoxSides odd_box;
      uint record_node = 0u;
      while (walking && !at_leaves) {
        uint nearest = lanes_min(box_min(even, odd));
        while (walking && key_beyond(nearest, tmax)) {  // nothing is left here
          even = even1; even1 = even2; even2 = even3; even3 = even4; even4 = even5; even5 = even6;
          odd = odd1; odd1 = odd2; odd2 = odd3; odd3 = odd4; odd4 = odd5; odd5 = odd6;
          node >>= 4u;
          nearest = lanes_min(box_min(even, odd));
          left -= 1u;
          walking = height != 0u && left - 1u < limit;
          height = height != 0u ? height - 1u : 0u;
        }
        even = even == nearest ? box_missed : even;
        odd = odd == nearest ? box_missed : odd;
        record_node = walking ? (node << 4u) | (nearest & 15u) : 0u;
        uint level = tile_first_level(object.depth) + 2u * height;  // of the 16 children
        // Four records side by side; of an odd tree's root, one.
        uint part = level == 1u ? 0u : lane >> 1u;
        uint record = 3u * (level_base(level - 1u) + (level == 1u ? 0u : 4u * record_node) + part);
        uvec4 x;
        uvec4 y;
        uvec4 z;
        LOAD4(x, boxes, record);
        LOAD4(y, boxes, record + 1u);
        LOAD4(z, boxes, record + 2u);
        if (walking) count_step();
        bool second = (lane & 1u) != 0u;
        uint lo_x = second ? x.y : x.x;
        uint hi_x = second ? x.w : x.z;
        uint lo_y = second ? y.y : y.x;
        uint hi_y = second ? y.w : y.z;
        uint lo_z = second ? z.y : z.x;
        uint hi_z = second ? z.w : z.z;
        even_box = make_box_sides(uvec3(lo_x & 0xffffu, lo_y & 0xffffu, lo_z & 0xffffu),
                                  uvec3(hi_x & 0xffffu, hi_y & 0xffffu, hi_z & 0xffffu), axes, octant);
        odd_box = make_box_sides(uvec3(lo_x >> 16u, lo_y >> 16u, lo_z >> 16u),
                                 uvec3(hi_x >> 16u, hi_y >> 16u, hi_z >> 16u), axes, octant);
        if (part != lane >> 1u) {
          even_box.there = false;
          odd_box.there = false;
        }
        uint even_key = tile_key(even_box, cone, tmin, tmax, 2u * lane);
        uint odd_key = tile_key(odd_box, cone, tmin, tmax, 2u * lane + 1u);
        at_leaves = walking && level == object.depth;
        if (walking && !at_leaves) {
          even6 = even5; even5 = even4; even4 = even3; even3 = even2; even2 = even1; even1 = even; even = even_key;
          odd6 = odd5; odd5 = odd4; odd4 = odd3; odd3 = odd2; odd2 = odd1; odd1 = odd; odd = odd_key;
          node = record_node;
          height += 1u;
        }
        left -= 2u;  // every loop runs at least once on a device that runs both sides of every branch
        walking = walking && left - 1u < limit;
      }
      if (at_leaves) {
        uvec4 slots;
        LOAD4(slots, leaf_map, even_box.there || odd_box.there ? 8u * record_node + lane : 0u);
#define ENTERS(i, j) uint quads##i##j = lanes_or(group_enters(group##i, even_box, odd_box) | (group_enters(group##j, even_box, odd_box) << 16u));
        ENTERS(0, 1) ENTERS(2, 3) ENTERS(4, 5) ENTERS(6, 7)
#define TEST(i, j) test_group(group##i, quads##i##j & 0xffffu, slots, left); test_group(group##j, quads##i##j >> 16u, slots, left);
        TEST(0, 1) TEST(2, 3) TEST(4, 5) TEST(6, 7)
        tmax = max2(max2(max2(group0.tmax, group1.tmax), max2(group2.tmax, group3.tmax)),
                    max2(max2(group4.tmax, group5.tmax), max2(group6.tmax, group7.tmax)));
        left -= 9u;
        walking = left - 1u < limit;
      }
    }
    lead = tile_rays;
#define WAITING(i) lead = first_waiting(lead, group##i, uint(i));
    EACH_GROUP(WAITING)
    lead = lanes_min(lead);
  }
  // Out of budget: below 1, that is, wrapped round. Then none of the tile counts.
  bool in_time = left - 1u < limit;
  uint again = 0u;
#define STORE(i) store_group(group##i, first + tile_lanes * uint(i), in_time, again);
  EACH_GROUP(STORE)
  if (again != 0u) atomicAdd(pending[0], again);
  if (counting != 0u) {
    if (lane == 0u) {
      count(counter_node_visits, tile_fan * node_visits);
      count(counter_box_tests, tile_fan * node_visits);
    }
    count(counter_triangle_tests, triangle_tests);
    count(counter_lane_steps, node_visits);
    count(counter_subgroup_steps, subgroup_steps);
  }
  flush_counters();
}
