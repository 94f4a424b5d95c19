// SPDX-License-Identifier: MIT
// Moves inner texels of mapped charts, of which no two are in a triangle of the lattice: each towards the mean of its
// neighbours by their weights, if the triangles round it are nearer to the surface there. The lattice stays one to one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/atlas.h"
#include "layout/relax.h"
#include "relax.glsl"

WORDS(0, readonly, inner_texels);
QUADS(1, readonly, charts);
QUADS(2, readonly, triangles);
QUADS(3, readonly, positions);
QUADS(4, readonly, rest_positions);
QUADS(5, readonly, map_faces);
WORDS(6, readonly, map_points);
WORDS(7, readonly, map_pieces);
QUADS(8, restrict, relaxed_map);
QUADS(9, restrict, sites);
QUADS(10, restrict, now);
QUADS(11, writeonly, was);
QUADS(12, readonly, map_sites);
COUNTERS(13)
PUSH(RelaxPush, push);

struct Site {
  vec2 at;
  uint face;
  float weight;
};

struct Place {
  uint face;  // no_index: none
  uint triangle;
  vec2 at;  // barycentrics 1 and 2
};

// Of the texel at hand: where its neighbours are in the rectangle, and on the surface, seen from it.
vec2 around[6];
vec3 points[6];

vec2 load_place_at_rest(uint texel) {
  uvec4 bits;
  LOAD4(bits, map_sites, texel);
  return vec2(uintBitsToFloat(bits.x), uintBitsToFloat(bits.y));
}

Site load_site(uint texel) {
  uvec4 bits;
  LOAD4(bits, sites, texel);
  return Site(vec2(uintBitsToFloat(bits.x), uintBitsToFloat(bits.y)), bits.z, uintBitsToFloat(bits.w));
}

vec2 load_point(uint index) {
  uint x;
  uint y;
  LOAD1(x, map_points, 2u * index);
  LOAD1(y, map_points, 2u * index + 1u);
  return vec2(uintBitsToFloat(x), uintBitsToFloat(y));
}

vec2 load_piece_corner(uint piece, uint corner) {
  uint x;
  uint y;
  LOAD1(x, map_pieces, 6u * piece + 2u * corner);
  LOAD1(y, map_pieces, 6u * piece + 2u * corner + 1u);
  return vec2(uintBitsToFloat(x), uintBitsToFloat(y));
}

uvec4 texel_entry(Place place, uint chart) {
  return uvec4(place.triangle, floatBitsToUint(place.at.x), floatBitsToUint(place.at.y), chart);
}

vec2 on_triangle(vec3 in_face, uint piece) {
  vec2 at = vec2(in_face.y, in_face.z);
  if (piece != no_index) {
    vec2 c0 = load_piece_corner(piece, 0u);
    vec2 c1 = load_piece_corner(piece, 1u);
    vec2 c2 = load_piece_corner(piece, 2u);
    at.x = c0.x * in_face.x + c1.x * in_face.y + c2.x * in_face.z;
    at.y = c0.y * in_face.x + c1.y * in_face.y + c2.y * in_face.z;
  }
  at.x = saturate(at.x);
  at.y = min2(at.y, 1.0 - at.x);
  return at;
}

// What the map has at a place of the rectangle, sought from a face on.
Place find(uint face, vec2 to) {
  Place place = Place(no_index, 0u, vec2(0.0, 0.0));
  for (uint i = 0u; i < relax_walk; ++i) {
    uvec4 corners;
    uvec4 beside;
    LOAD4(corners, map_faces, 2u * face);
    LOAD4(beside, map_faces, 2u * face + 1u);
    vec2 p0 = load_point(corners.x);
    vec2 p1 = load_point(corners.y);
    vec2 p2 = load_point(corners.z);
    vec3 side = vec3(relax_side(to, p1, p2), relax_side(to, p2, p0), relax_side(to, p0, p1));
    // Over the edge that it is farthest outside of. Edge k runs from corner k to the next, so it is the one opposite to
    // corner k + 2.
    float least = min2(side.x, side.y);
    uint beside_x = beside.x;
    uint beside_y = beside.y;
    uint beside_z = beside.z;
    uint other = side.x <= side.y ? beside_y : beside_z;
    uint next = side.z <= least ? beside_x : other;
    bool inside = min2(least, side.z) >= 0.0;
    if (inside) {
      float all = side.x + side.y + side.z;
      if (all > 0.0) {
        place.face = face;
        place.triangle = corners.w;
        place.at = on_triangle(vec3(side.x / all, side.y / all, side.z / all), beside.w);
      }
      next = no_index;
    }
    face = next;
    if (face == no_index) break;
  }
  return place;
}

bool is_long(vec2 way) { return max2(abs1(way.x), abs1(way.y)) >= relax_least_step; }

// Whether the triangles of the lattice round the texel are all of an area, the right way round.
bool keeps_lattice(vec2 to) {
  for (uint k = 0u; k < relax_neighbors; ++k) {
    if (!(relax_side(to, around[k], around[k == 5u ? 0u : k + 1u]) >= relax_least_area)) return false;
  }
  return true;
}

void move(uint texel) {
  uvec4 source;
  LOAD4(source, relaxed_map, texel);
  uvec4 chart;
  LOAD4(chart, charts, 2u * (source.w - 1u));
  Site own = load_site(texel);
  vec2 own_rest = load_place_at_rest(texel);
  vec2 rest = vec2(own_rest.x * -6.0, own_rest.y * -6.0);
  vec2 sum = vec2(0.0, 0.0);
  float weights = 0.0;
  uvec4 bits;
  LOAD4(bits, now, texel);
  vec3 center = as_vec3(bits);
  float scale = 0.0;
  for (uint k = 0u; k < relax_neighbors; ++k) {
    uint neighbor = relax_neighbor(texel, chart.y, k);
    Site site = load_site(neighbor);
    around[k] = site.at;
    rest = rest + load_place_at_rest(neighbor);
    LOAD4(bits, now, neighbor);
    points[k] = as_vec3(bits);
    scale = max2(scale, largest_abs(flush_tiny3(points[k] - center)));
    float own_weight = own.weight;
    float site_weight = site.weight;
    float weight = own_weight + (site.face == no_index ? own_weight : site_weight);
    sum = sum + site.at * weight;
    weights = weights + weight;
  }
  // Where the atlas has the texel beside the mean of its neighbours, to undo a fold, that is no way to go.
  vec2 mean = vec2(sum.x / weights, sum.y / weights) - own.at;
  vec2 way = (mean - rest * 0.16666667) * relax_gain;
  if (!is_long(way) || !(scale > 0.0)) return;
  for (uint k = 0u; k < relax_neighbors; ++k) points[k] = relax_seen(points[k], center, scale);
  // First the place where it is, then others. (The search stands here once: SwiftShader takes minutes to compile many.)
  float least = 0.0;
  vec2 to = own.at;
  for (uint i = 0u; i <= relax_attempts && is_long(way); ++i) {
    if (i > 0u) {
      to = own.at + way;
      way = way * 0.5;
      if (!keeps_lattice(to)) continue;
    }
    Place place = Place(no_index, 0u, vec2(0.0, 0.0));
    vec3 center_there = vec3(0.0, 0.0, 0.0);
    float error = 0.0;
    for (uint k = 0u; k <= relax_neighbors; ++k) {
      // At 0 the texel itself, then the middles of the triangles round it.
      uint before = k - 1u;
      uint a = k == 0u ? 5u : before;
      uint b = k == 6u ? 0u : k;
      vec2 middle = (to + around[a] + around[b]) * 0.33333333;
      Place found = find(own.face, k == 0u ? to : middle);
      if (k == 0u) place = found;
      if (place.face == no_index) break;
      if (found.face == no_index) continue;
      uvec4 entry = texel_entry(found, 0u);
      vec3 point;
      TEXEL_POINT(point, positions, entry);
      point = relax_seen(point, center, scale);
      if (k == 0u)
        center_there = point;
      else
        error = error + relax_error(center_there, points[a], points[b], point);
    }
    if (place.face == no_index) continue;
    if (i == 0u) {
      least = error;
    } else if (error < least) {
      uvec4 entry = texel_entry(place, source.w);
      vec3 point;
      STORE4(relaxed_map, texel, entry);
      STORE4(sites, texel, uvec4(floatBitsToUint(to.x), floatBitsToUint(to.y), place.face, floatBitsToUint(own.weight)));
      TEXEL_POINT(point, positions, entry);
      STORE4(now, texel, as_bits(point, 0u));
      TEXEL_POINT(point, rest_positions, entry);
      STORE4(was, texel, as_bits(point, 0u));
      return;
    }
  }
}

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  uint texel;
  LOAD1(texel, inner_texels, push.first + index);
  move(texel);
  flush_counters();
}
