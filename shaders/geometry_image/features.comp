// SPDX-License-Identifier: MIT
// What one sample's ray from the camera has hit, added up for `denoise`: three quads a ray, { demodulator R G B, 1 },
// { normal X Y Z, 0 } and { position from the camera X Y Z, 0 }; where nothing was hit { 1, 1, 1, 0 } and zeros.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "geometry_image/surface.glsl"
#include "layout/denoise.h"

QUADS(19, readonly, rays);
QUADS(20, restrict, features);
COUNTERS(21)
PUSH(FeaturesPush, push);

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  uvec4 hit;
  LOAD4(hit, hits, index);
  vec4 tint = vec4(1.0, 1.0, 1.0, 0.0);
  vec4 normal = vec4(0.0);
  vec4 position = vec4(0.0);
  if (hit.w != no_index) {
    uvec4 along;
    LOAD4(along, rays, 2u * index + 1u);
    SurfacePoint point = locate_hit(index, hit);
    MaterialRecord material = materials[parts[point.part].material];
    count_read(24u);
    Surface surface = surface_at(material, point, as_vec3(along));
    vec3 dimmed = demodulator(surface.albedo);
    if (push.tinted == 0u) dimmed = vec3(1.0);
    tint = vec4(dimmed, 1.0);
    normal = vec4(surface.normal, 0.0);
    position = vec4(surface.position - frames[0].origin, 0.0);
  }
  if (push.first == 0u) {
    uvec4 before;
    LOAD4(before, features, 3u * index);
    tint = tint + as_vec4(before);
    LOAD4(before, features, 3u * index + 1u);
    normal = normal + as_vec4(before);
    LOAD4(before, features, 3u * index + 2u);
    position = position + as_vec4(before);
  }
  STORE4(features, 3u * index, as_bits(tint));
  STORE4(features, 3u * index + 1u, as_bits(normal));
  STORE4(features, 3u * index + 2u, as_bits(position));
  flush_counters();
}
