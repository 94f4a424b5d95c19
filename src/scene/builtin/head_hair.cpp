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
constexpr glm::ivec3 cap_cells(30, 18, 30);

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
  // Hermite's cubic, so that no step shows at a knot; level at both ends.
  const auto slope = [&](size_t n) {
    if (n == 0 || n + 1 == line.size()) return 0.0f;
    return (line[n + 1].y - line[n - 1].y) / (line[n + 1].x - line[n - 1].x);
  };
  const float width = line[k].x - line[k - 1].x;
  const float t = glm::clamp((a - line[k - 1].x) / width, 0.0f, 1.0f), s = 1 - t;
  return s * s * (1 + 2 * t) * line[k - 1].y + t * t * (3 - 2 * t) * line[k].y +
         width * t * s * (s * slope(k - 1) - t * slope(k));
}

// `inside`: elevation above the hairline.
vec3 cap_surface(float azimuth, float inside) {
  const Aim aim{azimuth, hairline(azimuth) + inside};
  const vec3 d = direction(aim);
  const vec3 skin = head_point(aim);
  const float cover = glm::smoothstep(-0.06f, 0.04f, inside);
  // Strands run down from the crown.
  const vec3 crown = glm::normalize(vec3(-0.12f, 1, -0.35f));
  const vec3 ahead = glm::normalize(glm::cross(vec3(1, 0, 0), crown));
  const float around = std::atan2(d.x, glm::dot(d, ahead));
  const float away = 1 - glm::dot(d, crown);
  const float strands = std::sin(19 * around + 5 * away) + 0.5f * std::sin(43 * around - 4 * away + 1);
  const float thick = 0.045f + 0.045f * glm::smoothstep(0.0f, 0.4f, inside);
  const float ripple = 0.011f * strands * glm::smoothstep(0.05f, 0.4f, away);
  return skin + d * (glm::mix(-0.10f, thick, cover) + ripple * cover);
}

// The cap's rows follow the hairline, the lowest below the skin; its floor is inside the skull.
vec3 cap_point(glm::ivec3 point) {
  const glm::vec2 plan = 2.0f * glm::vec2(point.x, point.z) / glm::vec2(cap_cells.x, cap_cells.z) - 1.0f;
  const float m = std::max(std::abs(plan.x), std::abs(plan.y));
  const glm::vec2 border = m > 0 ? plan / m : glm::vec2(0, 1);
  float azimuth = 0.25f * pi * border.x;
  if (border.y < 1) azimuth = std::copysign(0.25f * pi * (2 - border.y), border.x);
  if (border.y <= -1) azimuth = std::copysign(0.25f * pi * (4 - std::abs(border.x)), border.x);
  const float up = float(point.y) / float(cap_cells.y);
  const float pole = 0.5f * pi - hairline(azimuth);
  const float wall = -0.08f + 0.14f * up + (0.55f * pole - 0.06f) * up * up;
  if (point.y == cap_cells.y) return cap_surface(azimuth, glm::mix(pole, wall, m));
  const vec3 p = cap_surface(azimuth, wall);
  return point.y == 0 ? glm::mix(vec3(0, 0.3f, -0.1f), p, m) : p;
}

// A place over the scalp: `pitch` from the brow (0) over the top (90) to the back (180), `side` towards the
// left ear (90), both in degrees; `lift` in units.
struct Place {
  float pitch, side, lift;
};

// A tapering strip along the cubic Bezier curve of four places.
struct Lock {
  Place path[4];
  float width, thickness;
  uint32_t columns, rows;  // samples around and along
};

constexpr vec3 scalp_centre(0, 0.27f, -0.10f);
constexpr vec3 scalp_radii(0.86f, 0.84f, 0.93f);

vec3 place_point(Place place) {
  const float pitch = glm::radians(place.pitch), side = glm::radians(place.side);
  const vec3 d(std::sin(side), std::cos(side) * std::sin(pitch), std::cos(side) * std::cos(pitch));
  return scalp_centre + d * (1 / glm::length(d / scalp_radii) + place.lift);
}

vec3 lock_point(const Lock& lock, float t, float angle) {
  const vec3 p[4] = {place_point(lock.path[0]), place_point(lock.path[1]), place_point(lock.path[2]),
                     place_point(lock.path[3])};
  const float s = 1 - t;
  const vec3 spine =
      p[0] * (s * s * s) + p[1] * (3 * s * s * t) + p[2] * (3 * s * t * t) + p[3] * (t * t * t);
  const vec3 along =
      glm::normalize((p[1] - p[0]) * (s * s) + (p[2] - p[1]) * (2 * s * t) + (p[3] - p[2]) * (t * t));
  const vec3 away = glm::normalize(spine - scalp_centre);
  const vec3 side = glm::normalize(glm::cross(away, along));
  const vec3 up = glm::cross(along, side);
  // Round at the root, pointed at the end.
  const float root = std::min(t / 0.22f, 1.0f);
  const float taper =
      std::sqrt(std::max(1 - (1 - root) * (1 - root), 0.0f)) * std::pow(std::max(1 - t * t * t, 0.0f), 0.75f);
  const float x = std::cos(angle), y = std::sin(angle);
  const float groove = 1 - 0.20f * bump((x - 0.30f) / 0.22f) - 0.14f * bump((x + 0.38f) / 0.20f);
  return spine + side * (lock.width * (0.05f + 0.95f * taper) * x) +
         up * (lock.thickness * taper * y * groove);
}

// The quiff rises from the forehead and sweeps to the left; shingles follow it over the top and down the
// back.
std::vector<Lock> make_locks() {
  std::vector<Lock> locks;
  // What makes the outline of the quiff is the finest.
  uint32_t columns = 16, rows = 26;
  const auto add = [&](Place a, Place b, Place c, Place d, float width, float thickness) {
    locks.push_back({{a, b, c, d}, width, thickness, columns, rows});
  };
  for (int k = 0; k < 7; ++k) {
    const float x = float(k), side = -38 + 11.5f * x, full = 1 - 0.09f * x;
    add({22 + 0.6f * x, side, -0.03f}, {26, side, 0.33f * full}, {60 - 2 * x, side + 12, 0.68f * full},
        {78 - 4 * x, side + 46 - 2 * x, 0.36f * full}, 0.150f - 0.006f * x, 0.085f - 0.004f * x);
  }
  add({25, 3, 0.0f}, {30, 2, 0.34f}, {18, -2, 0.32f}, {10, -8, 0.12f}, 0.052f, 0.034f);  // a curl
  columns = 12, rows = 18;
  for (int k = 0; k < 6; ++k) {
    const float x = float(k), side = -44 + 14 * x;
    add({52, side, 0.04f}, {62, side + 2, 0.38f - 0.03f * x}, {92, side + 14, 0.34f - 0.03f * x},
        {120, side + 28, 0.06f}, 0.165f, 0.080f);
  }
  columns = 10, rows = 14;
  for (int k = 0; k < 6; ++k) {
    const float side = -50 + 19 * float(k);
    add({94, side, 0.04f}, {112, side, 0.25f}, {140, side + 5, 0.22f}, {172, side + 8, 0.04f}, 0.175f,
        0.075f);
  }
  for (int k = 0; k < 6; ++k) {
    const float side = -52 + 20.5f * float(k);
    add({138, side, 0.04f}, {154, side, 0.20f}, {180, side * 0.95f, 0.19f}, {208, side * 0.8f, 0.03f}, 0.170f,
        0.065f);
  }
  for (int k = 0; k < 5; ++k) {
    const float side = -48 + 24 * float(k);
    add({172, side, 0.04f}, {186, side, 0.16f}, {206, side * 0.85f, 0.15f}, {230, side * 0.65f, 0.0f}, 0.155f,
        0.055f);
  }
  // One that will not lie down.
  add({128, -6, 0.0f}, {132, -8, 0.22f}, {142, -2, 0.32f}, {156, 8, 0.30f}, 0.075f, 0.045f);
  return locks;
}

}  // namespace

Mesh head_hair(uint32_t material) {
  Mesh mesh;
  mesh.name = "hair";
  std::vector<vec3> positions;
  const BoxLattice cap(cap_cells);
  for (const BoxLattice::Face face : BoxLattice::faces) add_grid(mesh, cap.chart(face));
  for (const glm::ivec3& point : cap.points()) positions.push_back(snap(cap_point(point)));
  for (const Lock& lock : make_locks()) {
    const ZippedTube tube(lock.columns, lock.rows, uint32_t(positions.size()));
    add_grid(mesh, tube.chart());
    for (const ZippedTube::Sample& sample : tube.samples())
      positions.push_back(snap(lock_point(lock, float(sample.row) / float(lock.rows - 1),
                                          2 * pi * float(sample.column) / float(lock.columns))));
  }
  add_part(mesh, 0, material);
  sculpt(mesh, [&](const Expression&) { return positions; });
  return mesh;
}

}  // namespace lodestone::scene::builtin
