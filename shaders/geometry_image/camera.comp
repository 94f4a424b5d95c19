// SPDX-License-Identifier: MIT
// Primary rays of one sample of a batch of pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "layout/camera.h"

STRUCTS(0, readonly, FrameRecord, frames);
QUADS(1, writeonly, rays);
QUADS(2, readonly, cameras);  // where something moves, one an end of a segment
WORDS(3, writeonly, times);
COUNTERS(4)
PUSH(RayPush, push);

vec3 moving_axis(Moment moment, uint axis) {
  uvec4 a;
  uvec4 b;
  LOAD4(a, cameras, camera_quads * moment.segment + axis);
  LOAD4(b, cameras, camera_quads * (moment.segment + 1u) + axis);
  return moved3(as_vec3(a), as_vec3(b), moment.fraction);
}

void main() {
  uint index = invocation();
  if (index >= push.rays) return;
  CameraAxes axes = camera_axes(frames[0]);
  if (frames[0].segments != 0u) {
    float time = shutter_time(frames[0], push.first_ray + index, push.sample_index, push.instant);
    STORE1(times, index, floatBitsToUint(time));
    Moment moment = moment_of(time, frames[0].segments);
    axes.origin = moving_axis(moment, 0u);
    axes.right = moving_axis(moment, 1u);
    axes.up = moving_axis(moment, 2u);
    axes.forward = moving_axis(moment, 3u);
    axes.lens_right = moving_axis(moment, 4u);
    axes.lens_up = moving_axis(moment, 5u);
  }
  Ray ray = camera_ray(frames[0], axes, push.first_ray + index, push.sample_index, push.centered, push.pinhole);
  STORE4(rays, 2u * index, as_bits(ray.origin, floatBitsToUint(ray.tmin)));
  STORE4(rays, 2u * index + 1u, as_bits(ray.direction, floatBitsToUint(ray.tmax)));
  flush_counters();
}
