// SPDX-License-Identifier: MIT
// Sculpted hair: a cap that dips below the skin at the hairline, and locks that sweep up from it into a
// quiff.
#include <cmath>

#include "lodestone/scene/builtin/head_parts.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

using glm::vec3;

constexpr float pi = 3.14159265f;
constexpr glm::ivec3 cap_cells(32, 26, 32);
constexpr uint32_t lock_columns = 16, lock_rows = 27;

// Elevation of the hairline by azimuth: forehead, temple, sideburn, behind the ear, nape.
float hairline(float azimuth) {
  constexpr std::array<glm::vec2, 8> line = {{{0, 0.70f},
                                              {0.45f, 0.72f},
                                              {0.80f, 0.60f},
                                              {1.05f, 0.30f},
                                              {1.30f, -0.02f},
                                              {1.55f, 0.05f},
                                              {1.95f, -0.55f},
                                              {3.2f, -0.72f}}};
  const float a = std::abs(azimuth);
  size_t k = 1;
  while (k + 1 < line.size() && a > line[k].x) ++k;
  const float t = glm::clamp((a - line[k - 1].x) / (line[k].x - line[k - 1].x), 0.0f, 1.0f);
  return glm::mix(line[k - 1].y, line[k].y, t * t * (3 - 2 * t));
}

vec3 cap_point(vec3 d) {
  const Aim aim = aim_at(head_centre + d);
  const vec3 skin = head_point(aim);
  const float inside = aim.elevation - hairline(aim.azimuth);
  const float cover = glm::smoothstep(-0.05f, 0.07f, inside);
  // Strands run down from the crown.
  const vec3 crown = glm::normalize(vec3(-0.12f, 1, -0.35f));
  const vec3 ahead = glm::normalize(glm::cross(vec3(1, 0, 0), crown));
  const float around = std::atan2(d.x, glm::dot(d, ahead));
  const float away = 1 - glm::dot(d, crown);
  const float strands = std::sin(17 * around + 5 * away) + 0.5f * std::sin(41 * around - 4 * away + 1);
  const float thick = 0.055f + 0.045f * glm::smoothstep(0.0f, 0.5f, inside);
  const float ripple = 0.011f * strands * glm::smoothstep(0.05f, 0.4f, away);
  return skin + d * (glm::mix(-0.12f, thick, cover) + ripple * cover);
}

// A tapering strip along a cubic Bezier curve; `flat` is the direction it is thin in, near its root.
struct Lock {
  vec3 curve[4];
  vec3 flat;
  float width, thickness;
};

vec3 bezier(const Lock& lock, float t) {
  const float s = 1 - t;
  return lock.curve[0] * (s * s * s) + lock.curve[1] * (3 * s * s * t) + lock.curve[2] * (3 * s * t * t) +
         lock.curve[3] * (t * t * t);
}

vec3 lock_point(const Lock& lock, float t, float angle) {
  const vec3 along = glm::normalize(bezier(lock, t + 0.01f) - bezier(lock, t - 0.01f));
  const vec3 side = glm::normalize(glm::cross(lock.flat, along));
  const vec3 up = glm::cross(along, side);
  const float c = std::cos(angle), s = std::sin(angle);
  // Full at a third of the length, pointed at the end.
  const float root = std::min(t / 0.12f, 1.0f);
  const float taper =
      std::sqrt(std::max(1 - (1 - root) * (1 - root), 0.0f)) * std::pow(std::max(1 - t * t * t, 0.0f), 0.7f);
  const float groove = 1 - 0.16f * bump((c - 0.35f) / 0.22f) - 0.16f * bump((c + 0.35f) / 0.22f);
  return bezier(lock, t) + side * (lock.width * (0.06f + 0.94f * taper) * c) +
         up * (lock.thickness * taper * s * groove);
}

const std::array<Lock, 9>& locks() {
  static const std::array<Lock, 9> all = {{
      {{{-0.42f, 0.80f, 0.42f}, {-0.46f, 1.15f, 0.72f}, {-0.15f, 1.42f, 0.75f}, {0.30f, 1.42f, 0.62f}},
       {-0.5f, 0.4f, 1},
       0.17f,
       0.085f},
      {{{-0.22f, 0.82f, 0.56f}, {-0.25f, 1.10f, 0.95f}, {0.10f, 1.38f, 0.92f}, {0.52f, 1.30f, 0.72f}},
       {-0.2f, 0.4f, 1},
       0.17f,
       0.09f},
      {{{0.02f, 0.80f, 0.62f}, {0.02f, 1.05f, 1.02f}, {0.32f, 1.28f, 0.98f}, {0.68f, 1.14f, 0.72f}},
       {0, 0.4f, 1},
       0.16f,
       0.09f},
      {{{0.24f, 0.80f, 0.56f}, {0.28f, 1.00f, 0.92f}, {0.52f, 1.15f, 0.85f}, {0.80f, 0.98f, 0.58f}},
       {0.3f, 0.5f, 1},
       0.15f,
       0.085f},
      {{{0.44f, 0.76f, 0.44f}, {0.52f, 0.92f, 0.70f}, {0.72f, 0.98f, 0.60f}, {0.88f, 0.78f, 0.36f}},
       {0.6f, 0.5f, 0.8f},
       0.13f,
       0.075f},
      {{{-0.30f, 0.98f, 0.20f}, {-0.36f, 1.35f, 0.40f}, {0.00f, 1.52f, 0.40f}, {0.42f, 1.38f, 0.28f}},
       {-0.4f, 0.8f, 0.6f},
       0.19f,
       0.09f},
      {{{0.05f, 1.02f, 0.15f}, {0.05f, 1.35f, 0.45f}, {0.38f, 1.40f, 0.40f}, {0.74f, 1.12f, 0.20f}},
       {0.1f, 0.8f, 0.6f},
       0.19f,
       0.09f},
      {{{-0.58f, 0.72f, 0.26f}, {-0.70f, 1.02f, 0.45f}, {-0.55f, 1.22f, 0.48f}, {-0.20f, 1.32f, 0.42f}},
       {-0.8f, 0.4f, 0.6f},
       0.14f,
       0.075f},
      {{{-0.10f, 1.02f, -0.35f}, {-0.16f, 1.20f, -0.50f}, {-0.12f, 1.30f, -0.66f}, {0.02f, 1.24f, -0.86f}},
       {0, 1, -0.4f},
       0.10f,
       0.06f},
  }};
  return all;
}

}  // namespace

Mesh head_hair(uint32_t material) {
  Mesh mesh;
  mesh.name = "hair";
  std::vector<vec3> positions;
  const BoxLattice cap(cap_cells);
  for (const BoxLattice::Face face : BoxLattice::faces) add_grid(mesh, cap.chart(face));
  for (const glm::ivec3& point : cap.points())
    positions.push_back(snap(cap_point(cube_sphere_direction(cap, point))));
  for (const Lock& lock : locks()) {
    const ZippedTube tube(lock_columns, lock_rows, uint32_t(positions.size()));
    add_grid(mesh, tube.chart());
    for (const ZippedTube::Sample& sample : tube.samples())
      positions.push_back(snap(lock_point(lock, float(sample.row) / (lock_rows - 1),
                                          2 * pi * float(sample.column) / lock_columns)));
  }
  add_part(mesh, 0, material);
  sculpt(mesh, [&](const Expression&) { return positions; });
  return mesh;
}

}  // namespace lodestone::scene::builtin
