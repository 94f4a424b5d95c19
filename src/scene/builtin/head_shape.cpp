// SPDX-License-Identifier: MIT
#include "lodestone/scene/builtin/head_shape.h"

#include <cmath>

#include "lodestone/scene/builtin/field.h"

namespace lodestone::scene::builtin {
namespace {

using glm::vec3;

// Skull, jaw, cheeks, chin, muzzle, neck; p.x >= 0.
float bones(vec3 p) {
  float d = ellipsoid_distance(p, {0, 0.30f, -0.10f}, {0.84f, 0.80f, 0.90f});
  d = smooth_union(d, ellipsoid_distance(p, {0, -0.42f, 0.16f}, {0.60f, 0.52f, 0.60f}), 0.30f);
  d = smooth_union(d, sphere_distance(p, {0.38f, -0.32f, 0.46f}, 0.33f), 0.22f);
  d = smooth_union(d, sphere_distance(p, {0, -0.83f, 0.54f}, 0.17f), 0.25f);
  d = smooth_union(d, ellipsoid_distance(p, {0, -0.50f, 0.58f}, {0.30f, 0.22f, 0.27f}), 0.18f);
  const float neck = capsule_distance(p, {0, -0.55f, -0.10f}, {0, -2.2f, -0.16f}, 0.34f, 0.38f);
  return smooth_union(d, neck, 0.20f);
}

// Brow ridge, socket and the lids, closed over the eyeball.
float eye_region(float d, vec3 p) {
  d = smooth_union(d, capsule_distance(p, {0.16f, 0.33f, 0.72f}, {0.52f, 0.36f, 0.52f}, 0.08f, 0.10f), 0.16f);
  d = smooth_difference(d, ellipsoid_distance(p, {0.33f, 0.04f, 0.86f}, {0.27f, 0.22f, 0.20f}), 0.16f);
  return smooth_union(d, sphere_distance(p, eye_centre, lid_radius), 0.05f);
}

float nose(float d, vec3 p) {
  d = smooth_union(d, capsule_distance(p, {0, 0.12f, 0.74f}, {0, -0.14f, 0.90f}, 0.06f, 0.075f), 0.12f);
  d = smooth_union(d, sphere_distance(p, {0, -0.20f, 0.955f}, 0.115f), 0.08f);
  d = smooth_union(d, sphere_distance(p, {0.105f, -0.235f, 0.875f}, 0.068f), 0.05f);
  return smooth_difference(d, ellipsoid_distance(p, {0.055f, -0.31f, 0.93f}, {0.035f, 0.03f, 0.045f}), 0.03f);
}

}  // namespace

vec3 direction(Aim aim) {
  const float c = std::cos(aim.elevation);
  return {c * std::sin(aim.azimuth), std::sin(aim.elevation), c * std::cos(aim.azimuth)};
}

Aim aim_at(vec3 point) {
  const vec3 d = point - head_centre;
  return {std::atan2(d.x, d.z), std::atan2(d.y, std::sqrt(d.x * d.x + d.z * d.z))};
}

float head_distance(vec3 point) {
  const vec3 p(std::abs(point.x), point.y, point.z);
  return nose(eye_region(bones(p), p), p);
}

vec3 head_point(Aim aim) {
  const vec3 d = direction(aim);
  // March outwards from the inside, then settle by halving the bracket: no step depends on the exactness of
  // the distance.
  float inside = 0.3f, outside = inside;
  for (int step = 0; step < 64; ++step) {
    const float distance = head_distance(head_centre + d * outside);
    if (distance > 0) break;
    inside = outside;
    outside += std::max(0.7f * -distance, 0.004f);
  }
  for (int step = 0; step < 20; ++step) {
    const float middle = 0.5f * (inside + outside);
    (head_distance(head_centre + d * middle) > 0 ? outside : inside) = middle;
  }
  return head_centre + d * inside;
}

vec3 head_normal(vec3 point) {
  constexpr float h = 0.002f;
  const auto slope = [&](vec3 axis) {
    return head_distance(point + axis * h) - head_distance(point - axis * h);
  };
  return glm::normalize(vec3(slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})));
}

float bump(float x) {
  const float t = std::max(1 - x * x, 0.0f);
  return t * t;
}

float bump(Aim from, Aim to, Aim radius) {
  const float x = (from.azimuth - to.azimuth) / radius.azimuth;
  const float y = (from.elevation - to.elevation) / radius.elevation;
  return bump(std::sqrt(x * x + y * y));
}

}  // namespace lodestone::scene::builtin
