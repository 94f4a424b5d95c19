// SPDX-License-Identifier: MIT
// Signed distances of simple solids, and their smooth union and difference. Only + - * / and square roots:
// the same bits everywhere.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace lodestone::scene::builtin {

inline float sphere_distance(glm::vec3 p, glm::vec3 centre, float radius) {
  return glm::length(p - centre) - radius;
}

// First-order estimate, exact on the surface.
inline float ellipsoid_distance(glm::vec3 p, glm::vec3 centre, glm::vec3 radii) {
  const glm::vec3 q = (p - centre) / radii;
  const float scale = glm::length(q);
  const float gradient = glm::length(q / radii);
  return gradient > 0 ? scale * (scale - 1) / gradient : -std::min({radii.x, radii.y, radii.z});
}

// A capsule whose radius goes linearly from ra at a to rb at b.
inline float capsule_distance(glm::vec3 p, glm::vec3 a, glm::vec3 b, float ra, float rb) {
  const glm::vec3 axis = b - a;
  const float t = glm::clamp(glm::dot(p - a, axis) / glm::dot(axis, axis), 0.0f, 1.0f);
  return glm::length(p - a - axis * t) - glm::mix(ra, rb, t);
}

// The union with a fillet of about `width` where the two meet.
inline float smooth_union(float a, float b, float width) {
  const float h = std::max(width - std::abs(a - b), 0.0f) / width;
  return std::min(a, b) - 0.25f * h * h * width;
}

// a without b.
inline float smooth_difference(float a, float b, float width) {
  return -smooth_union(-a, b, width);
}

}  // namespace lodestone::scene::builtin
