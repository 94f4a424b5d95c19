// SPDX-License-Identifier: MIT
// Primary rays of one sample of a batch of pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/camera.h"

STRUCTS(0, readonly, FrameRecord, frames);
QUADS(1, writeonly, rays);
COUNTERS(2)
PUSH(RayPush, push);

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  Ray ray = camera_ray(frames[0], push.first_ray + index, push.sample_index, push.centered, push.pinhole);
  STORE4(rays, 2u * index, as_bits(ray.origin, floatBitsToUint(ray.tmin)));
  STORE4(rays, 2u * index + 1u, as_bits(ray.direction, floatBitsToUint(ray.tmax)));
  flush_counters();
}
