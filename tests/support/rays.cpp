// SPDX-License-Identifier: MIT
#include "lodestone/test_support/rays.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lodestone/layout/atlas.h"

namespace lodestone::test {

using glm::vec3;

void add_ray(Rays& rays, const vec3& origin, const vec3& direction) {
  rays.emplace_back(origin, 0.0f);
  rays.emplace_back(glm::normalize(direction), 1e30f);
}

Rays primary_rays(const vec3& eye, const vec3& target, float half_angle, uint32_t size) {
  const float half = std::tan(half_angle);
  render::View view;
  view.origin = eye;
  view.forward = glm::normalize(target - eye);
  const vec3 right = glm::normalize(glm::cross(view.forward, vec3(0, 1, 0)));
  view.up = glm::cross(right, view.forward) * half;
  view.right = right * half;
  return primary_rays(view, size);
}

Rays primary_rays(const render::View& view, uint32_t size) {
  Rays rays;
  for (uint32_t i = 0; i < size * size; ++i) {
    const uint32_t tile = i / 64, within = i % 64;
    const uint32_t x = tile % (size / 8) * 8 + layout::gather_bits(within);
    const uint32_t y = tile / (size / 8) * 8 + layout::gather_bits(within >> 1);
    const float sx = 2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(size) - 1;
    const float sy = 1 - 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(size);
    const vec3 across = view.right * sx + view.up * sy;
    if (view.perspective) {
      add_ray(rays, view.origin, view.forward + across);
    } else {
      add_ray(rays, view.origin + across, view.forward);
    }
  }
  return rays;
}

vec3 random_direction(std::mt19937& random) {
  std::uniform_real_distribution<float> signed_unit(-1, 1);
  for (;;) {
    const vec3 v(signed_unit(random), signed_unit(random), signed_unit(random));
    const float length2 = glm::dot(v, v);
    if (length2 > 1e-4f && length2 <= 1) return v / std::sqrt(length2);
  }
}

Rays random_rays(const vec3& lo, const vec3& hi, uint32_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  const auto point = [&] { return lo + (hi - lo) * vec3(unit(random), unit(random), unit(random)); };
  const vec3 center = (lo + hi) * 0.5f;
  const float radius = glm::length(hi - lo);
  Rays rays;
  for (uint32_t i = 0; i < count; ++i) {
    const vec3 target = point();
    const vec3 origin = i % 2 == 0 ? center + random_direction(random) * radius : point();
    add_ray(rays, origin, target - origin + random_direction(random) * (1e-6f * radius));
  }
  return rays;
}

Rays surface_rays(const std::vector<vec3>& points, const std::vector<glm::uvec3>& triangles, uint32_t count,
                  uint32_t seed, float clearance) {
  const auto area_of = [&](const glm::uvec3& t) {
    return glm::length(glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]));
  };
  if (std::none_of(triangles.begin(), triangles.end(), [&](const glm::uvec3& t) { return area_of(t) > 0; }))
    throw std::invalid_argument("no triangle that rays could start from has an area");
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::uniform_int_distribution<size_t> pick(0, triangles.size() - 1);
  Rays rays;
  while (rays.size() < 2 * size_t(count)) {
    const glm::uvec3 t = triangles[pick(random)];
    const vec3 normal = glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]);
    const float area = glm::length(normal);
    if (!(area > 0)) continue;
    float u = unit(random), v = unit(random);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const vec3 on = points[t.x] * (1 - u - v) + points[t.y] * u + points[t.z] * v;
    const vec3 outward = normal / area;
    const vec3 direction = outward + random_direction(random) * 0.999f;
    add_ray(rays, on + outward * clearance, direction);
  }
  return rays;
}

}  // namespace lodestone::test
