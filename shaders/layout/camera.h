// SPDX-License-Identifier: MIT
#ifndef LODESTONE_LAYOUT_CAMERA_H
#define LODESTONE_LAYOUT_CAMERA_H

#include "layout/frame.h"
#include "layout/shading.h"
#include "layout/trace.h"

LODESTONE_LAYOUT_BEGIN

// Ray `ray` of the picture (numbered in tiles), through a point of its pixel: the centre, or where sample
// `index` of the pixel lies. A ray outside the picture has tmax = -1.
FN Ray camera_ray(FrameRecord frame, uint ray, uint index, uint centered) {
  Ray result;
  result.origin = frame.origin;
  result.direction = frame.forward;
  result.tmin = 0.0f;
  result.tmax = -1.0f;
  uint px = 0u;
  uint py = 0u;
  if (!ray_pixel(ray, frame.width, frame.height, px, py)) return result;
  vec2 within = vec2(0.5f, 0.5f);
  if (centered == 0u) within = sample_2d(frame.seed, py * frame.width + px, index, pair_pixel);
  float x = (float(px) + within.x) / float(frame.width) * 2.0f - 1.0f;
  float y = 1.0f - (float(py) + within.y) / float(frame.height) * 2.0f;
  vec3 offset = frame.right * x + frame.up * y;
  if (frame.perspective != 0u) {
    result.direction = normalize_or(frame.forward + offset, frame.forward);
  } else {
    result.origin = flush_tiny3(frame.origin + offset);
    result.direction = normalize_or(frame.forward, frame.forward);
  }
  result.tmax = 1e30f;
  return result;
}

LODESTONE_LAYOUT_END
#endif
