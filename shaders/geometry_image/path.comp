// SPDX-License-Identifier: MIT
// One vertex of each path: what its ray met adds to the pixel, a shadow ray to one light, and the ray that goes on.
#version 460
#extension GL_GOOGLE_include_directive : require
#define INSTANCES_ACCESS restrict
#include "geometry_image/surface.glsl"
#include "layout/path.h"

QUADS(19, restrict, rays);
STRUCTS(20, readonly, LightRecord, lights);
QUADS(21, writeonly, contributions);
QUADS(22, writeonly, shadow_rays);
QUADS(23, restrict, radiance);
QUADS(24, restrict, paths);
STRUCTS(25, restrict, uint, going_on);
STRUCTS(26, readonly, EnvironmentRecord, environments);
QUADS(27, readonly, environment_quads);
WORDS(28, readonly, environment_cells);
COUNTERS(29)
PUSH(PathPush, push);
layout(constant_id = 4) const uint environment_map = 0u;

#include "layout/environment.h"

void store_ray(uint index, Ray ray) {
  STORE4(rays, 2u * index, as_bits(ray.origin, floatBitsToUint(ray.tmin)));
  STORE4(rays, 2u * index + 1u, as_bits(ray.direction, floatBitsToUint(ray.tmax)));
}

DrawnLight draw_light(Surface surface, float choice, vec2 xi) {
  float count = float(push.lights);
  LightRecord light = lights[min(uint(choice * count), push.lights - 1u)];
  DrawnLight drawn;
  if (light.kind == light_sky) {
    EnvironmentSample chosen = sample_environment(xi);
    drawn.direction = chosen.direction;
    drawn.distance = 1e30;
    drawn.density = chosen.pdf / count;
    drawn.radiance = environment_radiance(chosen.direction) / drawn.density;
  } else {
    Arrival arrival = arriving_light(light, surface.position, surface.normal);
    drawn.direction = arrival.direction;
    drawn.distance = arrival.distance;
    drawn.density = 0.0;
    drawn.radiance = light.color * (arrival.falloff * count);
  }
  return drawn;
}

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  uvec4 hit;
  uvec4 along;
  LOAD4(hit, hits, index);
  LOAD4(along, rays, 2u * index + 1u);
  FrameRecord frame = frames[0];
  vec3 direction = as_vec3(along);
  bool alive = !(uintBitsToFloat(along.w) < 0.0);
  Path path = first_path();
  if (push.vertex != 0u) {
    uvec4 stored;
    LOAD4(stored, paths, index);
    path = stored_path(stored);
  }
  vec4 added = vec4(0.0);
  uvec4 contribution = uvec4(0u);
  Ray shadow = no_ray();
  Ray next = no_ray();
  scattered = push.vertex != 0u;
  if (alive && hit.w == no_index) {
    float density = environment_pdf(direction) * float(push.sky_lights) / float(push.lights);
    added = vec4(path.throughput * environment_radiance(direction) * sky_weight(path, density), 0.0);
  }
  if (alive && hit.w != no_index) {
    SurfacePoint point = locate_hit(index, hit);
    MaterialRecord material = materials[parts[point.part].material];
    count_read(24u);
    Surface surface = surface_at(material, point, direction);
    Bsdf bsdf = surface_bsdf(surface, layered != 0u);
    if (layered != 0u) path.throughput = path.throughput * transmittance(surface, uintBitsToFloat(hit.x));
    added = vec4(path.throughput * emitted_radiance(surface), 1.0);
    uint px;
    uint py;
    ray_pixel(push.first_ray + index, frame.width, frame.height, px, py);
    uint pixel = py * frame.width + px;
    vec2 choice = sample_2d(frame.seed, pixel, push.sample_index, vertex_pair(push.vertex, of_light));
    vec2 xi = sample_2d(frame.seed, pixel, push.sample_index, vertex_pair(push.vertex, of_light_direction));
    DrawnLight light = draw_light(surface, choice.x, xi);
    vec3 direct = direct_light(path, bsdf, light);
    if (max_component(direct) > 0.0) {
      float side = dot3(light.direction, surface.geometric) < 0.0 ? -1.0 : 1.0;
      shadow = leaving_ray(surface, light.direction, side, light.distance);
      contribution = as_bits(direct, 0u);
    }
    choice = sample_2d(frame.seed, pixel, push.sample_index, vertex_pair(push.vertex, of_lobe));
    xi = sample_2d(frame.seed, pixel, push.sample_index, vertex_pair(push.vertex, of_direction));
    BsdfSample drawn = sample_bsdf(bsdf, choice.x, xi);
    path.throughput = path.throughput * drawn.weight;
    path.density = drawn.density;
    path = survived(path, push.vertex, choice.y);
    if (push.vertex < push.last_vertex && max_component(path.throughput) > 0.0) {
      next = leaving_ray(surface, drawn.direction, drawn.through ? -1.0 : 1.0, 1e30);
      atomicAdd(going_on[0], 1u);
      if (placing == placing_cones) {
        float spread = scattered_spread(drawn.density, frame.tolerance_spread, frame.steepest);
        RayCone cone = leaving_cone(point, surface.position, tolerance_of(index), spread);
        STORE_CONE(instances, 2u * index, cone);
      }
    }
  }
  store_ray(index, next);
  STORE4(paths, index, as_bits(path.throughput, floatBitsToUint(path.density)));
  STORE4(contributions, index, contribution);
  STORE4(shadow_rays, 2u * index, as_bits(shadow.origin, floatBitsToUint(shadow.tmin)));
  STORE4(shadow_rays, 2u * index + 1u, as_bits(shadow.direction, floatBitsToUint(shadow.tmax)));
  if (push.vertex != 0u) added.w = 0.0;
  if (push.first == 0u) {
    uvec4 before;
    LOAD4(before, radiance, index);
    added = added + as_vec4(before);
  }
  STORE4(radiance, index, as_bits(added));
  flush_counters();
}
