// SPDX-License-Identifier: MIT
// From a batch's sums to the guides and the light that the filter works on (layout/denoise_filter.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/denoise.h"
#include "layout/shading.h"

STRUCTS(0, readonly, FrameRecord, frames);
QUADS(1, readonly, radiance);
QUADS(2, readonly, features);
QUADS(3, readonly, moments);
QUADS(4, writeonly, guides);
QUADS(5, writeonly, light);
COUNTERS(6)
PUSH(ResolvePush, push);

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  FrameRecord frame = frames[0];
  uint px;
  uint py;
  if (!ray_pixel(push.first_ray + index, frame.width, frame.height, px, py)) return;
  uvec4 sum;
  uvec4 squares;
  uvec4 tint;
  uvec4 normal;
  uvec4 position;
  LOAD4(sum, radiance, index);
  LOAD4(squares, moments, 2u * index);
  LOAD4(tint, features, 3u * index);
  LOAD4(normal, features, 3u * index + 1u);
  LOAD4(position, features, 3u * index + 2u);
  PixelFeatures pixel = pixel_features(as_vec4(tint), as_vec3(normal), as_vec3(position), float(frame.spp));
  PixelLight mean = pixel_light(as_vec3(sum), as_vec3(squares), pixel.tint, float(frame.spp));
  uint place = py * frame.width + px;
  STORE4(guides, 3u * place, as_bits(pixel.tint, floatBitsToUint(mean.valid)));
  STORE4(guides, 3u * place + 1u, as_bits(pixel.normal, floatBitsToUint(pixel.coverage)));
  STORE4(guides, 3u * place + 2u, as_bits(pixel.position, 0u));
  STORE4(light, place, as_bits(mean.color, floatBitsToUint(mean.variance)));
  flush_counters();
}
