// SPDX-License-Identifier: MIT
// The bound of every instance in the world, and the key by which instances are sorted: the place of its middle along a
// Morton curve.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/objects.h"

QUADS(0, readonly, objects);
QUADS(1, readonly, instances);
QUADS(2, writeonly, instance_lo);
QUADS(3, writeonly, instance_hi);
WORDS(4, writeonly, keys);  // two an instance: the key and the instance
COUNTERS(5)
PUSH(PlacePush, push);

void main() {
  uint instance = invocation();
  if (instance >= push.instances) return;
  uvec4 row0;
  uvec4 row1;
  uvec4 row2;
  uvec4 rest;
  LOAD4(row0, instances, instance_quads * instance + 3u);
  LOAD4(row1, instances, instance_quads * instance + 4u);
  LOAD4(row2, instances, instance_quads * instance + 5u);
  LOAD4(rest, instances, instance_quads * instance + 6u);
  uvec4 lo;
  uvec4 hi;
  LOAD4(lo, objects, 4u * rest.x + 1u);
  LOAD4(hi, objects, 4u * rest.x + 2u);
  Bound bound = instance_bound(as_vec3(lo), as_vec3(hi), as_vec4(row0), as_vec4(row1), as_vec4(row2));
  uint key = morton_key((bound.lo + bound.hi) * 0.5, push.base, push.per_step);
  if (uintBitsToFloat(rest.z) < 0.0) {
    bound = empty_bound();
    key = last_morton_key;
  }
  STORE4(instance_lo, instance, as_bits(bound.lo, 0u));
  STORE4(instance_hi, instance, as_bits(bound.hi, 0u));
  STORE1(keys, 2u * instance, key);
  STORE1(keys, 2u * instance + 1u, instance);
  flush_counters();
}
