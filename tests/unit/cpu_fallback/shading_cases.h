// SPDX-License-Identifier: MIT
// Surfaces and lights of all kinds, by a number; compiled as scalar code and for invocations side by side.
#ifndef LODESTONE_SHADING_CASES_H
#define LODESTONE_SHADING_CASES_H

#include "lodestone/layout/shading.h"

LODESTONE_LAYOUT_BEGIN

FN vec2 case_pair(uvec1 i, uint pair) {
  return sample_2d(5u, i, 0u, pair);
}
FN vec3 case_direction(uvec1 i, uint pair) {
  vec2 a = case_pair(i, pair);
  vec2 b = case_pair(i, pair + 1u);
  return normalize_or(vec3(a.x, a.y, b.x) * 2.0f - vec3(1.0f, 1.0f, 1.0f), vec3(0.0f, 0.0f, 1.0f));
}
FN vec3 toward(vec3 direction, vec3 axis) {
  return select(dot3(direction, axis) < 0.0f, direction * -1.0f, direction);
}

// A fifth has no coat, a fifth all of one; likewise with the other shares.
FN vec1 case_share(vec1 x) {
  return saturate(x * 1.6666666f - 0.33333333f);
}

FN Surface shading_case(uvec1 i) {
  Surface s;
  s.position = case_direction(i, 0u);
  s.reach = 2.0f;
  s.view = case_direction(i, 2u);
  s.geometric = toward(case_direction(i, 4u), s.view);
  s.normal = toward(case_direction(i, 6u), s.geometric);
  s.clearcoat_normal = toward(case_direction(i, 8u), s.geometric);
  vec2 a = case_pair(i, 10u);
  vec2 b = case_pair(i, 11u);
  vec2 c = case_pair(i, 12u);
  vec2 d = case_pair(i, 13u);
  s.albedo = vec3(a.x, a.y, b.x);
  s.emission = vec3(b.y, c.x, c.y);
  s.f0 = vec3(d.x, d.y, a.x);
  s.alpha = 1.0f;
  s.occlusion = 1.0f;
  s.texcoord = a;
  s.metallic = case_share(b.y);
  s.roughness = case_share(c.x);
  s.f90 = case_share(c.y);
  s.transmission = case_share(d.x);
  s.clearcoat = case_share(d.y);
  s.clearcoat_roughness = case_share(a.y);
  s.ior = 1.5f;
  s.solid = a.x > 0.5f;
  s.inside = b.x > 0.5f;
  s.attenuation = vec3(c.x, c.y, d.x);
  return s;
}

LODESTONE_LAYOUT_END
#endif
