// SPDX-License-Identifier: MIT
// The arbitrary output variables of a pixel, from the hit of the ray through its centre: four quads a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "geometry_image/surface.glsl"

QUADS(19, readonly, rays);
WORDS(20, readonly, steps);
QUADS(21, writeonly, aovs);
COUNTERS(22)
PUSH(RayPush, push);

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  FrameRecord frame = frames[0];
  uint px;
  uint py;
  if (!ray_pixel(push.first_ray + index, frame.width, frame.height, px, py)) return;
  uvec4 hit;
  uint visited;
  LOAD4(hit, hits, index);
  LOAD1(visited, steps, index);
  uint pixel = py * frame.width + px;
  uvec4 first = uvec4(0x7f800000u, 0u, 0u, 0u);  // depth +inf, normal 0
  uvec4 second = uvec4(0u);
  float level = 0.0;
  uvec4 third = uvec4(0u, 0u, no_index, no_index);
  if (hit.w != no_index) {
    uvec4 along;
    LOAD4(along, rays, 2u * index + 1u);
    SurfacePoint point = locate_hit(index, hit);
    level = detail_of(hit.w, point);
    PartRecord part = parts[point.part];
    MaterialRecord material = materials[part.material];
    count_read(24u);
    Surface surface = surface_at(material, point, as_vec3(along));
    first = uvec4(hit.x, as_bits(surface.normal, 0u).xyz);
    second = as_bits(surface.albedo, 0u);
    uint triangle = point.source[0].triangle;
    if ((placing & placing_found) != 0u) {
      uvec4 vertex;
      LOAD4(vertex, positions, point.source[0].vertex[0]);
      triangle = vertex.w;
    }
    third = uvec4(floatBitsToUint(surface.texcoord.x), floatBitsToUint(surface.texcoord.y), part.mesh,
                  part.first_mesh_triangle + (triangle - part.first_triangle));
  }
  STORE4(aovs, 4u * pixel, first);
  STORE4(aovs, 4u * pixel + 1u, second);
  STORE4(aovs, 4u * pixel + 2u, third);
  STORE4(aovs, 4u * pixel + 3u, uvec4(floatBitsToUint(level), visited, 0u, 0u));
  flush_counters();
}
