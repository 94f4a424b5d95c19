// SPDX-License-Identifier: MIT
// The buffers that surface.h reads: slots 0 to 18 of `mask`, `shade`, `aov` and their like.
#include "kernel.glsl"
#include "layout/shading.h"
#include "layout/detail.h"
#include "layout/motion.h"
#include "layout/objects.h"

QUADS(0, readonly, hits);
QUADS(1, readonly, geometry);
QUADS(2, readonly, normal_map);
QUADS(3, readonly, texel_map);
QUADS(4, readonly, triangles);
QUADS(5, readonly, positions);
QUADS(6, readonly, normals);
QUADS(7, readonly, tangents);
QUADS(8, readonly, texcoords);
WORDS(9, readonly, images);
WORDS(10, readonly, emitter_numbers);
QUADS(11, readonly, charts);
STRUCTS(12, readonly, PartRecord, parts);
STRUCTS(13, readonly, MaterialRecord, materials);
STRUCTS(14, readonly, TextureRecord, textures);
STRUCTS(15, readonly, FrameRecord, frames);
WORDS(16, readonly, ray_words);  // of each ray the instance that it hit, or its time
// Instances; or with levels of detail the cones of the batch's rays that have been scattered, two quads each.
#ifndef INSTANCES_ACCESS
#define INSTANCES_ACCESS readonly
#endif
QUADS(17, INSTANCES_ACCESS, instances);
WORDS(18, readonly, collapses);

layout(constant_id = 2) const uint sources = 1u;
layout(constant_id = 3) const uint layered = 0u;
layout(constant_id = 6) const uint placing = 0u;  // what slot 17 has (layout/detail.h)
const uint instanced = placing & placing_instances;
layout(constant_id = 7) const uint segments = 0u;

#define WHERE(condition) if (condition)
#define SET(variable, value) variable = value
#include "layout/surface.h"

// The instance in which ray `index` has hit something.
uint placed_by(uint index) {
  uint instance = 0u;
  if (instanced != 0u) LOAD1(instance, ray_words, index);
  return instance;
}

// When it has.
Moment moment_at(uint index) {
  Moment moment;
  moment.segment = 0u;
  moment.fraction = 0.0;
  if (segments != 0u) {
    uint time;
    LOAD1(time, ray_words, index);
    moment = moment_of(uintBitsToFloat(time), segments);
  }
  return moment;
}

bool scattered = true;  // whether rays have been, before this

// What the ray tolerates.
Tolerance tolerance_of(uint index) {
  Tolerance tolerance;
  tolerance.camera.apex = frames[0].origin;
  tolerance.camera.width = frames[0].tolerance;
  tolerance.camera.spread = frames[0].tolerance_spread;
  tolerance.scattered = no_cone();
  if (placing == placing_cones && scattered) {
    uvec4 a;
    uvec4 b;
    LOAD4(a, instances, 2u * index);
    LOAD4(b, instances, 2u * index + 1u);
    tolerance.scattered = stored_cone(a, b);
  }
  return tolerance;
}

#define STORE_CONE(quads, first, cone)                                    \
  {                                                                       \
    STORE4(quads, first, as_bits((cone).apex, floatBitsToUint((cone).width))); \
    STORE4(quads, (first) + 1u, uvec4(floatBitsToUint((cone).spread), 0u, 0u, 0u)); \
  }

SurfacePoint locate_hit(uint index, uvec4 hit) {
  return locate(hit.w, uintBitsToFloat(hit.y), uintBitsToFloat(hit.z), placed_by(index), moment_at(index),
                tolerance_of(index));
}
