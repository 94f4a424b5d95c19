// SPDX-License-Identifier: MIT
// One level of the filter over the whole picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/denoise.h"

QUADS(0, readonly, guides);
QUADS(1, readonly, light);
QUADS(2, writeonly, filtered);
COUNTERS(3)
PUSH(DenoisePush, grid);

#include "layout/denoise_filter.h"

void main() {
  uint index = invocation();
  if (index >= grid.width * grid.height) return;
  FilteredLight level = filtered_light(index % grid.width, index / grid.width);
  STORE4(filtered, index, as_bits(level.color, floatBitsToUint(level.variance)));
  flush_counters();
}
