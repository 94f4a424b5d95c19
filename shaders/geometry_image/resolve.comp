// SPDX-License-Identifier: MIT
// From a batch's sums to pixels: the mean radiance, linear, and the same through exposure, view transform and encoding.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/shading.h"

STRUCTS(0, readonly, FrameRecord, frames);
QUADS(1, readonly, radiance);
QUADS(2, writeonly, beauty);
QUADS(3, writeonly, display);
COUNTERS(4)
PUSH(ResolvePush, push);

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  FrameRecord frame = frames[0];
  uint px;
  uint py;
  if (!ray_pixel(push.first_ray + index, frame.width, frame.height, px, py)) return;
  uvec4 bits;
  LOAD4(bits, radiance, index);
  vec4 mean = as_vec4(bits) / float(frame.spp);
  vec3 seen = display_color(frame, vec3(mean.x, mean.y, mean.z));
  uint pixel = py * frame.width + px;
  STORE4(beauty, pixel, as_bits(mean));
  STORE4(display, pixel, as_bits(seen, floatBitsToUint(mean.w)));
  flush_counters();
}
