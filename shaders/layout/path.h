// SPDX-License-Identifier: MIT
// Path tracing, a vertex at a time: next-event estimation and directions drawn from the surface, weighed by
// the power heuristic (Veach 1997, section 9.2.4) where both can find the same light, and Russian roulette.
#ifndef LODESTONE_LAYOUT_PATH_H
#define LODESTONE_LAYOUT_PATH_H

#include "layout/bsdf.h"
#include "layout/frame.h"

LODESTONE_LAYOUT_BEGIN

// Stored between bounces, a quad a path.
struct Path {
  vec3 throughput;
  vec1 density;  // with which its ray's direction was drawn; 0: by the camera or a mirror, as lights are not
};

FN Path stored_path(uvec4 bits) {
  Path path;
  path.throughput = vec3(uintBitsToFloat(bits.x), uintBitsToFloat(bits.y), uintBitsToFloat(bits.z));
  path.density = uintBitsToFloat(bits.w);
  return path;
}
FN Path first_path() {
  Path path;
  path.throughput = vec3(1.0f, 1.0f, 1.0f);
  path.density = 0.0f;
  return path;
}

// The share of a direction that was drawn with density `own` (not 0) where it could have been with `other`.
FN vec1 power_heuristic(vec1 own, vec1 other) {
  vec1 ratio = other / own;
  return 1.0f / (1.0f + ratio * ratio);
}

// Light of one direction, or of a direction that was drawn with a density, that reached a vertex.
struct DrawnLight {
  vec3 direction;
  vec1 distance;
  vec3 radiance;  // over the chance that this light is drawn; of a drawn direction over its density too
  vec1 density;   // of the direction, times the chance of the light; 0: the light has one direction
};

// What it adds to the pixel if nothing is in the way. `last`: no ray goes on that could find it by chance.
FN vec3 direct_light(IN(Path) path, IN(Bsdf) b, IN(DrawnLight) light, bool last) {
  BsdfValue f = bsdf_value(b, light.direction);
  vec1 shared_weight = power_heuristic(light.density, f.density);
  vec1 weight = select(light.density > 0.0f && !last, shared_weight, vec1(1.0f));
  return flush_lost3(path.throughput * f.value * light.radiance * weight);
}

// How much of the light that a path's ray met counts, whose direction lights were drawn with `density`.
FN vec1 met_weight(IN(Path) path, vec1 density) {
  return select(path.density > 0.0f, power_heuristic(path.density, density), vec1(1.0f));
}

// From the fourth ray on a path ends by chance where it carries little.
FN Path survived(Path path, uint vertex, vec1 xi) {
  vec1 chance = vertex < 3u ? vec1(1.0f) : min2(max_component(path.throughput), 0.95f);
  vec3 kept = path.throughput / max2(chance, 1e-6f);
  path.throughput = flush_lost3(select(xi < chance, kept, vec3(0.0f, 0.0f, 0.0f)));
  return path;
}

LODESTONE_LAYOUT_END
#endif
