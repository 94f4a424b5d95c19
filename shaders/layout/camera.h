// SPDX-License-Identifier: MIT
#ifndef LODESTONE_LAYOUT_CAMERA_H
#define LODESTONE_LAYOUT_CAMERA_H

#include "layout/frame.h"
#include "layout/ray.h"
#include "layout/shading.h"

LODESTONE_LAYOUT_BEGIN

// Ray `ray` of the picture (numbered in tiles), through a point of its pixel: the centre, or where sample
// `index` of the pixel lies. It starts in the middle of the lens, or where the sample lies on it, and meets
// the others of its point at the distance of focus. A ray outside the picture has tmax = -1.
FN Ray camera_ray(IN(FrameRecord) frame, uvec1 ray, uint index, uint centered, uint pinhole) {
  uvec1 px;
  uvec1 py;
  bvec1 inside = ray_pixel(ray, frame.width, frame.height, px, py);
  vec2 within = vec2(0.5f, 0.5f);
  if (centered == 0u) within = sample_2d(frame.seed, py * frame.width + px, index, pair_pixel);
  vec1 x = (vec1(px) + within.x) / float(frame.width) * 2.0f - 1.0f;
  vec1 y = 1.0f - (vec1(py) + within.y) / float(frame.height) * 2.0f;
  vec3 offset = frame.right * x + frame.up * y;
  vec3 origin = frame.origin;
  vec3 direction = frame.forward;
  if (frame.perspective != 0u) {
    direction = normalize_or(frame.forward + offset, frame.forward);
  } else {
    origin = flush_tiny3(frame.origin + offset);
    direction = normalize_or(frame.forward, frame.forward);
  }
  if (pinhole == 0u) {
    vec2 lens = concentric_disc(sample_2d(frame.seed, py * frame.width + px, index, pair_lens));
    vec3 on_lens = frame.lens_right * lens.x + frame.lens_up * lens.y;
    vec3 through = frame.perspective != 0u ? frame.forward + offset : vec3(frame.forward);
    origin = flush_tiny3(origin + on_lens);
    direction = normalize_or(through * frame.focus - on_lens, frame.forward);
  }
  Ray result;
  result.origin = select(inside, origin, vec3(frame.origin));
  result.direction = select(inside, direction, vec3(frame.forward));
  result.tmin = 0.0f;
  result.tmax = select(inside, 1e30f, -1.0f);
  return result;
}

LODESTONE_LAYOUT_END
#endif
