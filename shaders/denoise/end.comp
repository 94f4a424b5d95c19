// SPDX-License-Identifier: MIT
// From filtered light to pixels: the radiance, and the same through exposure, view transform and encoding. Pixels that
// could not be filtered stay what they were.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/denoise.h"
#include "layout/shading.h"

STRUCTS(0, readonly, FrameRecord, frames);
QUADS(1, readonly, guides);
QUADS(2, readonly, light);
QUADS(3, readonly, noisy);
QUADS(4, writeonly, beauty);
QUADS(5, writeonly, display);
COUNTERS(6)
PUSH(CountPush, push);

void main() {
  uint index = invocation();
  if (index >= push.count) return;
  FrameRecord frame = frames[0];
  uvec4 guide;
  uvec4 filtered;
  uvec4 before;
  LOAD4(guide, guides, 3u * index);
  LOAD4(filtered, light, index);
  LOAD4(before, noisy, index);
  uvec4 color = as_bits(as_vec3(filtered) * as_vec3(guide), before.w);
  if (uintBitsToFloat(guide.w) == 0.0) color = before;
  STORE4(beauty, index, color);
  STORE4(display, index, as_bits(display_color(frame, as_vec3(color)), before.w));
  flush_counters();
}
