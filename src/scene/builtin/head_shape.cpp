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
  d = smooth_union(d, ellipsoid_distance(p, {0, -0.46f, 0.14f}, {0.64f, 0.50f, 0.62f}), 0.30f);
  d = smooth_union(d, sphere_distance(p, {0.40f, -0.26f, 0.46f}, 0.32f), 0.22f);
  d = smooth_union(d, sphere_distance(p, {0, -0.80f, 0.56f}, 0.20f), 0.26f);
  d = smooth_union(d, ellipsoid_distance(p, {0, -0.50f, 0.58f}, {0.30f, 0.22f, 0.27f}), 0.18f);
  const float neck = capsule_distance(p, {0, -0.55f, -0.10f}, {0, -2.2f, -0.16f}, 0.34f, 0.38f);
  return smooth_union(d, neck, 0.20f);
}

// Brow ridge, socket and the lids, closed over the eyeball.
float eye_region(float d, vec3 p) {
  if (sphere_distance(p, eye_centre, 0.75f) > 0) return d;  // too far for any of it to matter
  d = smooth_union(d, capsule_distance(p, {0.16f, 0.33f, 0.72f}, {0.52f, 0.36f, 0.52f}, 0.08f, 0.10f), 0.16f);
  d = smooth_difference(d, ellipsoid_distance(p, {0.33f, 0.04f, 0.86f}, {0.27f, 0.22f, 0.20f}), 0.16f);
  return smooth_union(d, sphere_distance(p, eye_centre, lid_radius), 0.05f);
}

float bridge(float d, vec3 p) {
  if (sphere_distance(p, {0, -0.05f, 0.85f}, 0.45f) > 0) return d;
  return smooth_union(d, capsule_distance(p, {0, 0.12f, 0.71f}, {0, -0.17f, 0.875f}, 0.05f, 0.07f), 0.14f);
}

// Blows up the skin around `centre` like a balloon: forwards by `height`, and sideways by the share `spread`
// of the distance, so that its flanks stand up or overhang. That is what rays from one point cannot see.
void inflate(vec3& p, glm::vec2 centre, glm::vec2 radius, float height, float spread) {
  const glm::vec2 offset = glm::vec2(p) - centre;
  const float b = bump(glm::length(offset / radius));
  p += vec3(offset * (spread * b), height * b * (2 - b));
}

// Tip, wings and nostrils of the nose; p.x >= 0.
vec3 nose_tip(vec3 p) {
  const vec3 flat = p;
  inflate(p, {0, -0.195f}, {0.190f, 0.180f}, 0.125f, 0.34f);
  p.y -= 0.035f * bump(glm::length(glm::vec2(flat.x, flat.y + 0.20f) / glm::vec2(0.17f, 0.14f)));
  inflate(p, {0.110f, -0.25f}, {0.075f, 0.070f}, 0.035f, 0.25f);
  p.x +=
      0.025f * bump(glm::length((glm::vec2(flat) - glm::vec2(0.085f, -0.24f)) / glm::vec2(0.070f, 0.075f)));
  const float nostril =
      bump(glm::length((glm::vec2(flat) - glm::vec2(0.048f, -0.285f)) / glm::vec2(0.042f, 0.032f)));
  return p + vec3(0, 0.035f, -0.03f) * nostril;
}

vec3 mirrored(vec3 p) {
  return {std::abs(p.x), p.y, p.z};
}

// Where a ray from inside leaves the head: marches outwards to a bracket, then closes it by false position,
// halving the weight of an end that stays (the Illinois rule).
vec3 leave(vec3 origin, vec3 d) {
  float inside = 0.3f, at_inside = head_distance(origin + d * inside);
  float outside = inside, at_outside = at_inside;
  for (int step = 0; step < 96 && at_outside <= 0; ++step) {
    inside = outside;
    at_inside = at_outside;
    outside += std::max(-at_outside, 0.004f);
    at_outside = head_distance(origin + d * outside);
  }
  int stayed = 0;
  for (int step = 0; step < 12 && outside - inside > 1e-7f; ++step) {
    const float middle = (inside * at_outside - outside * at_inside) / (at_outside - at_inside);
    const float at_middle = head_distance(origin + d * middle);
    if (std::abs(at_middle) < 1e-7f) return origin + d * middle;
    if (at_middle > 0) {
      outside = middle;
      at_outside = at_middle;
      if (stayed == -1) at_inside *= 0.5f;
      stayed = -1;
    } else {
      inside = middle;
      at_inside = at_middle;
      if (stayed == 1) at_outside *= 0.5f;
      stayed = 1;
    }
  }
  return origin + d * inside;
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
  // Rounded where the mirror images meet, so that no crease runs down the middle of the face.
  const vec3 p(std::sqrt(point.x * point.x + 0.0012f), point.y, point.z);
  return bridge(eye_region(bones(p), p), p);
}

vec3 head_point(Aim aim) {
  const vec3 p = leave(head_centre, direction(aim));
  const vec3 with_nose = nose_tip(mirrored(p));
  return {std::copysign(with_nose.x, p.x), with_nose.y, with_nose.z};
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
