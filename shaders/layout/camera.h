// SPDX-License-Identifier: MIT
#ifndef LODESTONE_LAYOUT_CAMERA_H
#define LODESTONE_LAYOUT_CAMERA_H

#include "layout/frame.h"
#include "layout/motion.h"
#include "layout/ray.h"
#include "layout/shading.h"

LODESTONE_LAYOUT_BEGIN

// Where the camera is, and half the picture's width and height at a distance of 1 (see render::View).
struct CameraAxes {
  vec3 origin;
  vec3 right;
  vec3 up;
  vec3 forward;
  vec3 lens_right;
  vec3 lens_up;
};
CONST uint camera_quads = 6u;  // a camera's, in that order

FN CameraAxes camera_axes(IN(FrameRecord) frame) {
  CameraAxes axes;
  axes.origin = frame.origin;
  axes.right = frame.right;
  axes.up = frame.up;
  axes.forward = frame.forward;
  axes.lens_right = frame.lens_right;
  axes.lens_up = frame.lens_up;
  return axes;
}

// When ray `ray` of the picture starts, in [0, 1) of the time that the shutter is open.
FN vec1 shutter_time(IN(FrameRecord) frame, uvec1 ray, uint index, uint instant) {
  uvec1 px;
  uvec1 py;
  ray_pixel(ray, frame.width, frame.height, px, py);
  if (instant != 0u) return vec1(0.5f);
  return sample_2d(frame.seed, py * frame.width + px, index, pair_time).x;
}

// Ray `ray` of the picture (numbered in tiles), through a point of its pixel: the centre, or where sample
// `index` of the pixel lies. It starts in the middle of the lens, or where the sample lies on it, and meets
// the others of its point at the distance of focus. A ray outside the picture has tmax = -1.
FN Ray camera_ray(IN(FrameRecord) frame, IN(CameraAxes) axes, uvec1 ray, uint index, uint centered,
                  uint pinhole) {
  uvec1 px;
  uvec1 py;
  bvec1 inside = ray_pixel(ray, frame.width, frame.height, px, py);
  vec2 within = vec2(0.5f, 0.5f);
  if (centered == 0u) within = sample_2d(frame.seed, py * frame.width + px, index, pair_pixel);
  vec1 x = (vec1(px) + within.x) / float(frame.width) * 2.0f - 1.0f;
  vec1 y = 1.0f - (vec1(py) + within.y) / float(frame.height) * 2.0f;
  vec3 offset = axes.right * x + axes.up * y;
  vec3 origin = axes.origin;
  vec3 direction = axes.forward;
  if (frame.perspective != 0u) {
    direction = normalize_or(axes.forward + offset, axes.forward);
  } else {
    origin = flush_tiny3(axes.origin + offset);
    direction = normalize_or(axes.forward, axes.forward);
  }
  if (pinhole == 0u) {
    vec2 lens = concentric_disc(sample_2d(frame.seed, py * frame.width + px, index, pair_lens));
    vec3 on_lens = axes.lens_right * lens.x + axes.lens_up * lens.y;
    vec3 through = frame.perspective != 0u ? axes.forward + offset : axes.forward;
    origin = flush_tiny3(origin + on_lens);
    direction = normalize_or(through * frame.focus - on_lens, axes.forward);
  }
  Ray result;
  result.origin = select(inside, origin, axes.origin);
  result.direction = select(inside, direction, axes.forward);
  result.tmin = 0.0f;
  result.tmax = select(inside, 1e30f, -1.0f);
  return result;
}

LODESTONE_LAYOUT_END
#endif
