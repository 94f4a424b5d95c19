// SPDX-License-Identifier: MIT
// Levels of detail (the paper's future work, "adaptive level of detail": rays against coarser levels of the
// geometry image). Level k of a chart is every 2^k-th texel of it, both ways; borders have the same texels on
// both sides at every level (geometry_image/collapse_map.h).
//
// A ray sees a surface in which texels have collapsed: each texel may slide to its parent, one of the next
// level, and has then vanished. How far it has slid depends on the texel and on the ray's tolerance there,
// and on nothing else: not at all where the tolerance is at most the texel's radius, wholly from a quarter
// more on. So every texel has one place for a ray, whichever quads and charts it is a corner of, and the
// surface that the ray sees is the finest one with its corners moved: what is closed stays closed, exactly,
// with whatever levels beside each other; and as tolerances change from ray to ray or frame to frame it
// slides, and nothing pops.
//
// Where all texels between the corners of a node have collapsed, that surface is the node's two triangles.
// Traversals stop there and test that quad, by the same test (layout/trace.h). A node says from which
// tolerance on that is so. Its corners do not move before: their radius is at least what the tolerance there
// can be while some texel between them has not collapsed, which the sum in `corner_radius`
// (layout/detail_nodes.h) sees to, because no tolerance changes by more than `steepest` a unit of length. So
// a texel that slides has a parent that stays, and the corners of a quad have to be looked up once, not along
// a chain of parents.
//
// The radius of a texel is the error that the surface has without it: how far, at most, finer texels are from
// the quads that are left when it has gone. It is found from the bottom up, every frame.
#ifndef LODESTONE_LAYOUT_DETAIL_H
#define LODESTONE_LAYOUT_DETAIL_H

#include "layout/arithmetic.h"
#include "layout/motion.h"

LODESTONE_LAYOUT_BEGIN

CONST uint detailed_sources = 6u;  // of a hit, see layout/surface.h

// What a binding that two features share has in a dispatch: the instances, or the cones of scattered rays.
CONST uint placing_instances = 1u;
CONST uint placing_cones = 2u;
// Beside these: what was hit has been kept ray by ray (layout/portion.h).
CONST uint placing_found = 4u;

// What a ray tolerates at a point: the largest of two cones, that of the camera and one that rays get where
// they are scattered. A cone is as wide as it says at its apex and wider with the distance from there.
struct RayCone {
  vec3 apex;
  vec1 width;  // may be negative, then the cone begins farther away
  vec1 spread;
};
struct Tolerance {
  RayCone camera;
  RayCone scattered;
};

FN RayCone no_cone() {
  RayCone cone;
  cone.apex = vec3(0.0f, 0.0f, 0.0f);
  cone.width = -1.0f;
  cone.spread = 0.0f;
  return cone;
}

// Two quads: { apex, width }, { spread, 0, 0, 0 }.
FN RayCone stored_cone(uvec4 a, uvec4 b) {
  RayCone cone;
  cone.apex = vec3(uintBitsToFloat(a.x), uintBitsToFloat(a.y), uintBitsToFloat(a.z));
  cone.width = uintBitsToFloat(a.w);
  cone.spread = uintBitsToFloat(b.x);
  return cone;
}

FN vec1 distance_to(vec3 p, vec3 q) {
  vec3 d = flush_tiny3(p - q);
  return sqrt(dot3(d, d));
}

FN vec1 tolerance_at(IN(Tolerance) t, vec3 p) {
  return max2(t.camera.width + t.camera.spread * distance_to(p, t.camera.apex),
              t.scattered.width + t.scattered.spread * distance_to(p, t.scattered.apex));
}

// What rays that leave a surface at `p` tolerate besides what the camera's do; `radius`: all that was hit is
// within it. There they must tolerate just what the ray tolerated that hit it: then they see the same
// surface, which they start from, and no shadow of another level of it. So the new cone begins below the
// camera's and overtakes it farther away; and where an earlier scattered cone is the larger one it stays.
FN RayCone scattered_cone(IN(Tolerance) t, vec3 p, vec1 radius, vec1 spread) {
  vec1 nearest = max2(distance_to(p, t.camera.apex) - radius, 0.0f);
  vec1 least = (t.camera.width + t.camera.spread * nearest) * 0.9998f;
  vec1 largest = t.scattered.width + t.scattered.spread * (distance_to(p, t.scattered.apex) + radius);
  bvec1 stays = largest > least;
  RayCone cone;
  cone.apex = select(stays, t.scattered.apex, p);
  cone.width = select(stays, t.scattered.width, flush_tiny(least - spread * radius * 1.0002f));
  cone.spread = select(stays, t.scattered.spread, spread);
  return cone;
}

// Of a direction drawn with a density by solid angle (0: a mirror's): the wider the lobe, the more.
FN vec1 scattered_spread(vec1 density, float camera_spread, float steepest) {
  vec1 lobe = 0.015625f / sqrt(max2(density, 1e-6f));
  return select(density > 0.0f, min2(camera_spread + lobe, steepest), vec1(camera_spread));
}

// A texel slides while the tolerance grows by this part of its radius: long enough to be seen as a slide, and
// short, because what slides needs wider bounds.
CONST float slide_band = 0.25f;
CONST float least_radius = 1e-18f;                // so that products with it are no denormals
CONST float fixed_radius = infinity_bits_as_max;  // of a texel that never collapses

// How far a texel has slid, in [0, 1].
FN vec1 collapse_of(vec1 tolerance, vec1 radius) {
  vec1 part = (tolerance - radius) / (radius * slide_band);
  return select(tolerance > radius, min2(part, 1.0f), vec1(0.0f));
}
FN vec3 slid(vec3 own, vec3 parent, vec1 part) {
  return select(part >= 1.0f, parent, moved3(own, parent, part));
}

// Collapses, a word buffer, two words a texel: { parent, radius (float bits) }. Primitives say their level:
// bits 28 to 31. Bits 1 to 27 are the texel of corner a.
CONST uint level_shift = 28u;
CONST uint most_detailed_texels = 134217728u;  // 2^27
FN uvec1 primitive_level(uvec1 primitive) {
  return primitive >> level_shift;
}
FN uvec1 primitive_texel(uvec1 primitive) {
  return (primitive & 0x0fffffffu) >> 1u;
}

LODESTONE_LAYOUT_END
#endif
