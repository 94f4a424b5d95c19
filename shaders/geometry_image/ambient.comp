// SPDX-License-Identifier: MIT
// Ambient occlusion: a ray to a cosine-distributed direction, and 1 where nothing is met within its length. Where the
// camera's ray met nothing it is 1 as well.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "geometry_image/surface.glsl"

QUADS(19, readonly, rays);
QUADS(20, writeonly, contributions);
QUADS(21, writeonly, shadow_rays);
QUADS(22, restrict, radiance);
COUNTERS(23)
PUSH(AmbientPush, push);

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  uvec4 hit;
  uvec4 along;
  LOAD4(hit, hits, index);
  LOAD4(along, rays, 2u * index + 1u);
  FrameRecord frame = frames[0];
  vec3 direction = as_vec3(along);
  vec4 added = vec4(1.0, 1.0, 1.0, 0.0);
  uvec4 contribution = uvec4(0u);
  Ray shadow = no_ray();
  if (hit.w != no_index) {
    SurfacePoint point = locate_hit(index, hit);
    MaterialRecord material = materials[parts[point.part].material];
    count_read(24u);
    Surface surface = surface_at(material, point, direction);
    uint px;
    uint py;
    ray_pixel(push.first_ray + index, frame.width, frame.height, px, py);
    vec3 outward = cosine_direction(
        surface.normal, sample_2d(frame.seed, py * frame.width + px, push.sample_index, pair_ambient));
    if (dot3(outward, surface.geometric) > 0.0) {
      shadow = leaving_ray(surface, outward, 1.0, push.distance);
      contribution = as_bits(vec3(1.0), 0u);
    }
    added = vec4(0.0, 0.0, 0.0, 1.0);
  }
  if (uintBitsToFloat(along.w) < 0.0) added = vec4(0.0);
  STORE4(contributions, index, contribution);
  STORE4(shadow_rays, 2u * index, as_bits(shadow.origin, floatBitsToUint(shadow.tmin)));
  STORE4(shadow_rays, 2u * index + 1u, as_bits(shadow.direction, floatBitsToUint(shadow.tmax)));
  if (push.first == 0u) {
    uvec4 before;
    LOAD4(before, radiance, index);
    added = added + as_vec4(before);
  }
  STORE4(radiance, index, as_bits(added));
  flush_counters();
}
