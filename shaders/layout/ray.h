// SPDX-License-Identifier: MIT
#ifndef LODESTONE_LAYOUT_RAY_H
#define LODESTONE_LAYOUT_RAY_H

#include "layout/arithmetic.h"

LODESTONE_LAYOUT_BEGIN

struct Ray {
  vec3 origin;
  vec1 tmin;  // hits are beyond tmin ...
  vec3 direction;
  vec1 tmax;  // ... and not beyond tmax; negative: no ray
};

FN Ray no_ray() {
  Ray ray;
  ray.origin = vec3(0.0f, 0.0f, 0.0f);
  ray.tmin = 0.0f;
  ray.direction = vec3(0.0f, 0.0f, 0.0f);
  ray.tmax = -1.0f;
  return ray;
}

// From its two quads in a buffer. One that is not finite is no ray: it would pass comparisons with bounds by
// chance.
FN Ray stored_ray(uvec4 from, uvec4 along) {
  Ray ray;
  ray.origin = vec3(uintBitsToFloat(from.x), uintBitsToFloat(from.y), uintBitsToFloat(from.z));
  ray.tmin = uintBitsToFloat(from.w);
  ray.direction = vec3(uintBitsToFloat(along.x), uintBitsToFloat(along.y), uintBitsToFloat(along.z));
  vec1 sum = abs1(ray.origin.x) + abs1(ray.origin.y) + abs1(ray.origin.z) + abs1(ray.direction.x) +
             abs1(ray.direction.y) + abs1(ray.direction.z);
  ray.tmax = select(sum <= infinity_bits_as_max, uintBitsToFloat(along.w), -1.0f);
  return ray;
}

LODESTONE_LAYOUT_END
#endif
