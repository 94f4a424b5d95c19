// SPDX-License-Identifier: MIT
// The variance of each pixel's light from those around it as well.
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
  vec1 variance = shared_variance(index % grid.width, index / grid.width);
  STORE4(filtered, index, as_bits(light_of(index).color, floatBitsToUint(variance)));
  flush_counters();
}
