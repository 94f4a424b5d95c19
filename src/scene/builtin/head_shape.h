// SPDX-License-Identifier: MIT
// The resting face as an implicit surface, without openings. It is star-shaped about `head_centre`, so a
// direction names one point of it. The head looks along +Z, +Y up, +X is its left; it is about 2.1 units
// high.
#pragma once

#include <glm/glm.hpp>

namespace lodestone::scene::builtin {

inline constexpr glm::vec3 head_centre(0, -0.1f, 0);
inline constexpr glm::vec3 eye_centre(0.335f, 0.03f, 0.53f);  // the left one; the right has -x
inline constexpr float eye_radius = 0.27f;
inline constexpr float lid_radius = 0.30f;

// A direction from head_centre: azimuth from +Z towards +X, elevation towards +Y, radians.
struct Aim {
  float azimuth = 0, elevation = 0;
  bool operator==(const Aim&) const = default;
};
inline Aim operator+(Aim a, Aim b) {
  return {a.azimuth + b.azimuth, a.elevation + b.elevation};
}
inline Aim operator-(Aim a, Aim b) {
  return {a.azimuth - b.azimuth, a.elevation - b.elevation};
}
inline Aim operator*(float s, Aim a) {
  return {s * a.azimuth, s * a.elevation};
}

glm::vec3 direction(Aim aim);
Aim aim_at(glm::vec3 point);

// Negative inside; near the surface roughly the distance.
float head_distance(glm::vec3 point);
// The surface point in a direction.
glm::vec3 head_point(Aim aim);
// The unit outward normal at a point near the surface.
glm::vec3 head_normal(glm::vec3 point);

// (1 - x^2)^2 for |x| < 1, else 0: a bump without tails.
float bump(float x);
// The bump of the distance of two aims, in units of `radius` (one a coordinate).
float bump(Aim from, Aim to, Aim radius);

}  // namespace lodestone::scene::builtin
