// SPDX-License-Identifier: MIT
// Of each path whose next light is the surfaces that shine: a point of them (layout/emitters.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "geometry_image/surface.glsl"
#include "layout/emitters.h"

QUADS(19, readonly, rays);
WORDS(20, readonly, emitter_texels);
WORDS(21, readonly, emitter_objects);
WORDS(22, readonly, instance_numbers);
QUADS(23, writeonly, drawn_points);
WORDS(24, readonly, ray_list);
COUNTERS(25)
PUSH(EmitterPush, push);

#include "layout/draw_emitter.h"

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  if (push.vertex != 0u) LOAD1(index, ray_list, index + 1u);
  uvec4 hit;
  uvec4 along;
  LOAD4(hit, hits, index);
  LOAD4(along, rays, 2u * index + 1u);
  DrawnPoint drawn = nothing_drawn();
  if (!(uintBitsToFloat(along.w) < 0.0) && hit.w != no_index) {
    FrameRecord frame = frames[0];
    uint px;
    uint py;
    ray_pixel(push.first_ray + index, frame.width, frame.height, px, py);
    uint pixel = py * frame.width + px;
    vec2 choice = sample_2d(frame.seed, pixel, push.sample_index, vertex_pair(push.vertex, of_light));
    if (uint(choice.x * drawn_numbers) >= push.first_number) {
      vec2 which = sample_2d(frame.seed, pixel, push.sample_index, emitter_pair(push.vertex));
      vec2 xi = sample_2d(frame.seed, pixel, push.sample_index, vertex_pair(push.vertex, of_light_direction));
      SurfacePoint point = draw_emitter(push, which, xi, moment_at(index));
      MaterialRecord material = materials[parts[point.part].material];
      count_read(24u);
      drawn = drawn_point(material, point);
    }
  }
  uint first = drawn_quads * index;
  STORE4(drawn_points, first, as_bits(drawn.position, floatBitsToUint(drawn.density)));
  STORE4(drawn_points, first + 1u, as_bits(drawn.normal, floatBitsToUint(drawn.offset)));
  STORE4(drawn_points, first + 2u, as_bits(drawn.emission, floatBitsToUint(drawn.coat)));
  if (layered != 0u) STORE4(drawn_points, first + 3u, as_bits(drawn.coat_normal, 0u));
  flush_counters();
}
