// SPDX-License-Identifier: MIT
// Surfaces that shine as lights of the integrator `path` (Shirley, Wang and Zimmerman 1996, "Monte Carlo
// techniques for direct lighting calculations"): a triangle of the geometry image is drawn by its power, and
// on it a point by area. What a path meets by chance counts by the power heuristic with the same densities,
// so pictures stay right where a power was estimated badly, or is 0.
//
// Power is that of the rest pose, and stays; areas are those of the pose, so that densities are exact.
// Emitters are the texels of charts that shine, two halves each: the triangles of the quad whose corner a
// the texel is. Behind the emitters of each object is one that is never drawn.
#ifndef LODESTONE_LAYOUT_EMITTERS_H
#define LODESTONE_LAYOUT_EMITTERS_H

#include "layout/path.h"

LODESTONE_LAYOUT_BEGIN

struct EmitterPush {
  uint first_ray;
  uint rays;
  uint sample_index;
  uint vertex;         // of the paths
  uint first_number;   // LightRecord::first_number of the emitters
  uint instances;      // 0: all is one object in the world
  uint instance_step;  // where a binary search among them begins (layout/frame.h, EnvironmentRecord) ...
  uint half_step;      // ... and one among the halves of the largest object
};

// Stored a ray, four quads, the last only of layered surfaces.
CONST uint drawn_quads = 4u;
struct DrawnPoint {
  vec3 position;
  vec1 density;  // by area, among all emitters; 0: none was drawn
  vec3 normal;   // geometric, of unit length, on either side
  vec1 offset;   // as in leaving_ray
  vec3 emission;
  vec1 coat;
  vec3 coat_normal;
};

FN DrawnPoint nothing_drawn() {
  DrawnPoint point;
  point.position = vec3(0.0f, 0.0f, 0.0f);
  point.density = 0.0f;
  point.normal = vec3(0.0f, 0.0f, 0.0f);
  point.offset = 0.0f;
  point.emission = vec3(0.0f, 0.0f, 0.0f);
  point.coat = 0.0f;
  point.coat_normal = vec3(0.0f, 0.0f, 0.0f);
  return point;
}

FN DrawnPoint stored_point(uvec4 a, uvec4 b, uvec4 c, uvec4 d) {
  DrawnPoint point;
  point.position = vec3(uintBitsToFloat(a.x), uintBitsToFloat(a.y), uintBitsToFloat(a.z));
  point.density = uintBitsToFloat(a.w);
  point.normal = vec3(uintBitsToFloat(b.x), uintBitsToFloat(b.y), uintBitsToFloat(b.z));
  point.offset = uintBitsToFloat(b.w);
  point.emission = vec3(uintBitsToFloat(c.x), uintBitsToFloat(c.y), uintBitsToFloat(c.z));
  point.coat = uintBitsToFloat(c.w);
  point.coat_normal = vec3(uintBitsToFloat(d.x), uintBitsToFloat(d.y), uintBitsToFloat(d.z));
  return point;
}

// From a density by area to one by solid angle, so far away, seen by that cosine.
FN vec1 seen_density(vec1 density, vec1 distance2, vec1 cosine) {
  return flush_lost(density * distance2 / max2(cosine, 1e-6f));
}

// Light from a drawn point; `chance`: that the light that is drawn is the emitters.
FN DrawnLight emitted_light(IN(DrawnPoint) point, IN(Surface) s, vec1 chance) {
  vec1 side = select(dot3(point.normal, s.position - point.position) < 0.0f, vec1(-1.0f), vec1(1.0f));
  vec3 way = flush_tiny3(point.position + point.normal * (point.offset * side) - s.position);
  vec1 distance2 = dot3(way, way);
  DrawnLight light;
  light.direction = normalize_or(way, s.normal);
  light.distance = sqrt(distance2);
  vec1 density = seen_density(point.density, distance2, abs1(dot3(point.normal, light.direction))) * chance;
  bvec1 possible = density > 1e-20f;
  light.density = select(possible, density, vec1(0.0f));
  vec1 coat = point.coat * (0.04f + 0.96f * fresnel_power(abs1(dot3(point.coat_normal, light.direction))));
  vec3 radiance = point.emission * ((1.0f - coat) / density);
  light.radiance = select(possible, radiance, vec3(0.0f, 0.0f, 0.0f));
  return light;
}

LODESTONE_LAYOUT_END
#endif
