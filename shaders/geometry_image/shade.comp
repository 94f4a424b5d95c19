// SPDX-License-Identifier: MIT
// What one light would send by way of the hit to the viewer, and the shadow ray that decides whether it does. The first
// light's turn also adds what the surface emits, or the environment where nothing was hit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "geometry_image/surface.glsl"
#include "layout/recursion.h"

QUADS(19, readonly, rays);
STRUCTS(20, readonly, LightRecord, lights);
QUADS(21, writeonly, contributions);
QUADS(22, writeonly, shadow_rays);
QUADS(23, restrict, radiance);
QUADS(24, readonly, environment_quads);
WORDS(25, readonly, environment_cells);
QUADS(26, readonly, paths);  // a Branch each, where `recursion` says so
WORDS(27, readonly, ray_list);
COUNTERS(28)
PUSH(RayPush, push);
layout(constant_id = 4) const uint environment_map = 0u;
layout(constant_id = 5) const uint recursion = recursion_none;

#include "layout/environment.h"
#include "layout/sky_light.h"

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  if (push.vertex != 0u) LOAD1(index, ray_list, index + 1u);
  uvec4 hit;
  uvec4 from;
  uvec4 along;
  LOAD4(hit, hits, index);
  LOAD4(from, rays, 2u * index);
  LOAD4(along, rays, 2u * index + 1u);
  FrameRecord frame = frames[0];
  vec3 direction = as_vec3(along);
  vec3 emitted;
  float alpha = 0.0;
  Branch branch = first_branch();
  scattered = push.vertex != 0u;
  if (recursion != recursion_none && push.vertex != 0u) {
    uvec4 stored;
    LOAD4(stored, paths, index);
    branch = stored_branch(stored);
  }
  uvec4 contribution = uvec4(0u);
  uvec4 shadow_from = uvec4(0u);
  uvec4 shadow_along = uvec4(0u, 0u, 0u, floatBitsToUint(-1.0));
  if (hit.w != no_index) {
    SurfacePoint point = locate_hit(index, hit);
    MaterialRecord material = materials[parts[point.part].material];
    count_read(24u);
    Surface surface = surface_at(material, point, direction);
    if (recursion != recursion_none && layered != 0u)
      branch.throughput = branch.throughput * transmittance(surface, uintBitsToFloat(hit.x));
    emitted = emitted_radiance(surface);
    alpha = 1.0;
    uint px;
    uint py;
    ray_pixel(push.first_ray + index, frame.width, frame.height, px, py);
    vec2 xi = sample_2d(frame.seed, py * frame.width + px, push.sample_index, sky_pair(push.vertex, push.light));
    Traced traced = traced_lobes(recursion, surface, branch.depth < push.last_vertex);
    LightSample light;
    if (lights[push.light].kind == light_sky) {
      light = sample_sky(surface, xi, traced);
    } else {
      light = sample_light(lights[push.light], surface, traced);
    }
    if (recursion != recursion_none) light.radiance = light.radiance * branch.throughput;
    if (dot3(light.direction, surface.geometric) > 0.0 && max_component(light.radiance) > 0.0) {
      Ray shadow = leaving_ray(surface, light.direction, 1.0, light.distance);
      contribution = as_bits(light.radiance, 0u);
      shadow_from = as_bits(shadow.origin, floatBitsToUint(shadow.tmin));
      shadow_along = as_bits(shadow.direction, floatBitsToUint(shadow.tmax));
    }
  } else {
    emitted = environment_radiance(direction);
  }
  STORE4(contributions, index, contribution);
  STORE4(shadow_rays, 2u * index, shadow_from);
  STORE4(shadow_rays, 2u * index + 1u, shadow_along);
  if (push.light == 0u) {
    if (recursion != recursion_none) emitted = emitted * branch.throughput;
    vec4 sum = vec4(emitted.x, emitted.y, emitted.z, push.vertex == 0u ? alpha : 0.0);
    if (uintBitsToFloat(along.w) < 0.0) sum = vec4(0.0, 0.0, 0.0, 0.0);
    if (push.first == 0u) {
      uvec4 before;
      LOAD4(before, radiance, index);
      sum = sum + as_vec4(before);
    }
    STORE4(radiance, index, as_bits(sum));
  }
  flush_counters();
}
