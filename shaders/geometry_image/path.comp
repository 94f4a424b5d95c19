// SPDX-License-Identifier: MIT
// One vertex of each path: what its ray met adds to the pixel, a shadow ray to one light, and the ray that goes on. The
// lights are those of the frame and, where `emitting` says so, one more: the surfaces that shine, of which `draw_emitters`
// has drawn a point.
#version 460
#extension GL_GOOGLE_include_directive : require
#define INSTANCES_ACCESS restrict
#include "geometry_image/surface.glsl"
#include "layout/emitters.h"

QUADS(19, restrict, rays);
STRUCTS(20, readonly, LightRecord, lights);
QUADS(21, writeonly, contributions);
QUADS(22, writeonly, shadow_rays);
QUADS(23, restrict, radiance);
QUADS(24, restrict, paths);
STRUCTS(25, restrict, uint, going_on);  // how many; behind the first vertex a list of the rays that this is about
QUADS(26, readonly, environment_quads);
WORDS(27, readonly, environment_cells);
QUADS(28, readonly, drawn_points);
COUNTERS(29)
PUSH(PathPush, push);
layout(constant_id = 4) const uint environment_map = 0u;
layout(constant_id = 5) const uint emitting = 0u;

#include "layout/environment.h"

void store_ray(uint index, Ray ray) {
  STORE4(rays, 2u * index, as_bits(ray.origin, floatBitsToUint(ray.tmin)));
  STORE4(rays, 2u * index + 1u, as_bits(ray.direction, floatBitsToUint(ray.tmax)));
}

DrawnPoint load_drawn(uint index) {
  uvec4 a;
  uvec4 b;
  uvec4 c;
  uvec4 d = uvec4(0u);
  LOAD4(a, drawn_points, drawn_quads * index);
  LOAD4(b, drawn_points, drawn_quads * index + 1u);
  LOAD4(c, drawn_points, drawn_quads * index + 2u);
  if (layered != 0u) LOAD4(d, drawn_points, drawn_quads * index + 3u);
  return stored_point(a, b, c, d);
}

uint drawn_light(float choice) {
  uint number = uint(choice * drawn_numbers);
  uint light = 0u;
  for (uint step = push.light_step; step != 0u; step >>= 1u) {
    uint place = min(light + step, push.lights - 1u);
    light = number >= lights[place].first_number ? place : light;
  }
  return light;
}

DrawnLight draw_light(uint index, Surface surface, float choice, vec2 xi) {
  LightRecord light = lights[drawn_light(choice)];
  float chance = float(light.numbers) / drawn_numbers;
  if (emitting != 0u && light.kind == light_emitters) return emitted_light(load_drawn(index), surface, chance);
  DrawnLight drawn;
  if (light.kind == light_sky) {
    EnvironmentSample chosen = sample_environment(xi);
    drawn.direction = chosen.direction;
    drawn.distance = 1e30;
    drawn.density = chosen.pdf * chance;
    drawn.radiance = environment_radiance(chosen.direction) / drawn.density;
  } else {
    Arrival arrival = arriving_light(light, surface.position, surface.normal);
    drawn.direction = arrival.direction;
    drawn.distance = arrival.distance;
    drawn.density = 0.0;
    drawn.radiance = light.color * (arrival.falloff / chance);
  }
  return drawn;
}

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  if (push.vertex != 0u) {
    index = going_on[index + 1u];
    count_read(1u);
  }
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
    float density = environment_pdf(direction) * push.sky_chance;
    added = vec4(path.throughput * environment_radiance(direction) * met_weight(path, density), 0.0);
  }
  if (alive && hit.w != no_index) {
    SurfacePoint point = locate_hit(index, hit);
    MaterialRecord material = materials[parts[point.part].material];
    count_read(24u);
    Surface surface = surface_at(material, point, direction);
    Bsdf bsdf = surface_bsdf(surface, layered != 0u);
    if (layered != 0u) path.throughput = path.throughput * transmittance(surface, uintBitsToFloat(hit.x));
    vec3 emitted = path.throughput * emitted_radiance(surface);
    if (emitting != 0u) {
      float met = uintBitsToFloat(hit.x);
      float density = seen_density(drawn_density(point), met * met, abs1(dot3(surface.geometric, direction)));
      emitted = emitted * met_weight(path, density * push.emitter_chance);
    }
    added = vec4(emitted, 1.0);
    uint px;
    uint py;
    ray_pixel(push.first_ray + index, frame.width, frame.height, px, py);
    uint pixel = py * frame.width + px;
    vec2 choice = sample_2d(frame.seed, pixel, push.sample_index, vertex_pair(push.vertex, of_light));
    vec2 xi = sample_2d(frame.seed, pixel, push.sample_index, vertex_pair(push.vertex, of_light_direction));
    DrawnLight light = draw_light(index, surface, choice.x, xi);
    vec3 direct = direct_light(path, bsdf, light, push.vertex >= push.last_vertex);
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
