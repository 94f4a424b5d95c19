// SPDX-License-Identifier: MIT
// Relaxation of a geometry image: in a pose that bends and stretches the surface, the samples of a chart move
// to where they are needed now. A texel moves in the rectangle of its chart, whose unit is a quad; what lies
// there on the surface, the map of the chart says.
//
// A sweep is two steps. `relax_measure` gives each texel a weight: how much more than in the rest pose the
// geometry image bends and stretches there. `relax_move` draws a texel to the mean of its neighbours by their
// weights (or as far beside it as the atlas has the texel, where that undoes a fold), and leaves it there if
// the triangles round it are nearer to the surface than before. In the rest pose all weights are 1 and
// nothing moves.
//
// Buffers. Map faces, two quads each: { three points, counterclockwise; triangle of the scene }, { the face
// behind the edge from corner k to the next, no_index: none; the piece }. Map points: two words each. Map
// pieces: six words each. Sites, a quad buffer, one a texel: { u, v in the rectangle, the map face there
// (no_index on the border of a chart, where texels stay), weight }; map sites: the same before any sweep. Now
// and was, quad buffers: the texel's point in this pose and in the rest pose.
#ifndef LODESTONE_LAYOUT_RELAX_H
#define LODESTONE_LAYOUT_RELAX_H

#include "layout/arithmetic.h"

LODESTONE_LAYOUT_BEGIN

struct MapFace {
  uvec3 points;
  uint triangle;
  uvec3 beside;
  uint piece;  // no_index: the corners are those of the triangle, in order
};

// Barycentrics of the triangle's vertices 1 and 2 at the corners of a face that is a piece of it.
struct MapPiece {
  vec2 corners[3];
};

// Where a texel is before relaxation.
struct MapSite {
  vec2 at;       // in the rectangle
  uint face;     // no_index: the texel stays
  float weight;  // 1
};

struct RelaxPush {
  uint first;  // of the list of inner texels
  uint count;
};

CONST uint relax_neighbors = 6u;
// Twice the area of a triangle of the lattice is 1 to begin with and never becomes less than this.
CONST float relax_least_area = 0.05f;
// Shorter steps, in quads, are not taken: what only turns and shifts a surface leaves its texels where they
// are, however it is rounded.
CONST float relax_least_step = 9.765625e-4f;
CONST float relax_gain = 1.5f;       // steps are this much longer than to the mean ...
CONST uint relax_attempts = 4u;      // ... and halved where they do not serve
CONST uint relax_walk = 256u;        // faces at most, from one place of the rectangle to another
CONST float relax_flatness = 0.03f;  // bends of less than this, in lengths of an edge, count little

// Twice the area of (p, a, b), positive where they are counterclockwise. With a and b exchanged it has the
// other sign and else the same bits, so no point is outside of both faces of an edge.
FN float relax_side(vec2 p, vec2 a, vec2 b) {
  vec2 to_a = vec2(a.x - p.x, a.y - p.y);
  vec2 to_b = vec2(b.x - p.x, b.y - p.y);
  return to_a.x * to_b.y - to_a.y * to_b.x;
}

// The neighbours of a texel in the lattice, whose quads are two triangles each, counterclockwise. (Selects
// between names: SwiftShader's time to compile grows exponentially with branches.)
FN uint relax_neighbor(uint texel, uint width, uint k) {
  uint half_ring = k < 3u ? 0u : 3u;
  uint turn = k - half_ring;
  uint aside = width - 1u;
  uint row = turn == 1u ? width : aside;
  uint way = turn == 0u ? 1u : row;
  uint ahead = texel + way;
  uint back = texel - way;
  return k < 3u ? ahead : back;
}

// A point as seen from another one, in units of `scale`: no product of three such numbers leaves the range of
// floats.
FN vec3 relax_seen(vec3 point, vec3 from, float scale) {
  return flush_tiny3(
      vec3((point.x - from.x) / scale, (point.y - from.y) / scale, (point.z - from.z) / scale));
}

struct RelaxRing {
  vec3 points[6];  // the neighbours, seen from the texel
  float scale;     // the largest coordinate of one of them; 0: all are one point, and there is no ring
};

// `points`: the neighbours of `center`.
FN RelaxRing relax_ring(vec3 center, vec3 points[6]) {
  RelaxRing ring;
  ring.scale = 0.0f;
  for (uint k = 0u; k < relax_neighbors; ++k)
    ring.scale = max2(ring.scale, largest_abs(flush_tiny3(points[k] - center)));
  for (uint k = 0u; k < relax_neighbors; ++k)
    ring.points[k] = ring.scale > 0.0f ? relax_seen(points[k], center, ring.scale) : vec3(0.0f, 0.0f, 0.0f);
  return ring;
}

// How far the ring bends along the three lines of the lattice, in units of its scale; of a flat one, what
// its edges make of relax_flatness.
FN float relax_bend(RelaxRing ring) {
  vec3 across = vec3(0.0f, 0.0f, 0.0f);
  float edges = 0.0f;
  for (uint k = 0u; k < relax_neighbors; ++k) {
    vec3 a = ring.points[k];
    across = across + cross3(a, ring.points[k == 5u ? 0u : k + 1u]);
    edges = edges + sqrt(dot3(a, a));
  }
  vec3 normal = normalize_or(flush_tiny3(across), vec3(0.0f, 0.0f, 0.0f));
  float bends = 0.0f;
  for (uint k = 0u; k < 3u; ++k) {
    float bend = flush_tiny(dot3(normal, flush_tiny3(ring.points[k] + ring.points[k + 3u])));
    bends = bends + bend * bend;
  }
  return sqrt(bends) + relax_flatness / 6.0f * edges;
}

FN float relax_weight(RelaxRing now, RelaxRing was) {
  if (!(now.scale > 0.0f && was.scale > 0.0f)) return 1.0f;
  float ratio = relax_bend(now) / relax_bend(was) * (now.scale / was.scale);
  ratio = clamp1(ratio, 0.015625f, 64.0f);
  return ratio * ratio;
}

// The square of how far the triangle (center, a, b) is off the surface, times its area. `middle` is the point
// of the surface whose place in the rectangle is the triangle's middle.
FN float relax_error(vec3 center, vec3 a, vec3 b, vec3 middle) {
  vec3 across = flush_tiny3(cross3(flush_tiny3(a - center), flush_tiny3(b - center)));
  vec3 normal = normalize_or(across, vec3(0.0f, 0.0f, 0.0f));
  float off = dot3(normal, flush_tiny3(middle - (center + a + b) * 0.33333333f));
  off = select(abs1(off) < 9.3132257e-10f, 0.0f, off);
  return off * off * sqrt(dot3(across, across));
}

#ifdef __cplusplus
static_assert(sizeof(MapFace) == 2 * sizeof(uvec4));
static_assert(sizeof(MapPiece) == 6 * sizeof(uint));
#endif

LODESTONE_LAYOUT_END
#endif
