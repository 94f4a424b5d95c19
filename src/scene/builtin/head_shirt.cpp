// SPDX-License-Identifier: MIT
// Shoulders in a pullover: the foot of the bust. It stands still while the head turns.
#include <cmath>

#include "lodestone/scene/builtin/head_parts.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;
constexpr glm::ivec3 body_cells(32, 14, 18);
constexpr uint32_t collar_around = 144, collar_section = 12;

glm::vec3 body_point(glm::vec3 d) {
  // Broader than deep, sloping from the neck to the shoulders, cut flat below.
  const float slope = 0.34f * bump(d.x * 1.02f);
  glm::vec3 p = glm::vec3(1.12f, 0.55f, 0.56f) * d;
  p.y += d.y > 0 ? slope * d.y * d.y : 0;
  p.y = std::max(p.y, -0.45f) + 0.1f * std::min(p.y + 0.45f, 0.0f);
  p.z += 0.06f * bump((d.y - 0.1f) / 0.8f) * std::max(d.z, 0.0f);
  return p + glm::vec3(0, -1.98f, -0.10f);
}

// A rolled collar with ribs, around the neck.
glm::vec3 collar_point(float turn, float angle) {
  const float ribs = 0.010f * std::cos(36 * turn);
  const float radius = 0.115f + ribs * (0.6f + 0.4f * std::cos(angle));
  const glm::vec3 out(std::sin(turn), 0, std::cos(turn));
  const glm::vec3 ring =
      out * (0.40f + 0.8f * radius * std::cos(angle)) + glm::vec3(0, 1.25f * radius * std::sin(angle), 0);
  // Higher at the back.
  return ring + glm::vec3(0, -1.22f - 0.16f * ring.z, -0.10f);
}

}  // namespace

Mesh head_shirt(uint32_t material) {
  Mesh mesh;
  mesh.name = "shirt";
  std::vector<glm::vec3> positions;
  const BoxLattice body(body_cells);
  for (const BoxLattice::Face face : BoxLattice::faces) add_grid(mesh, body.chart(face));
  for (const glm::ivec3& point : body.points())
    positions.push_back(snap(body_point(cube_sphere_direction(body, point))));

  // A torus: one chart whose opposite borders are the same vertices.
  const uint32_t first = uint32_t(positions.size());
  Grid torus{collar_around + 1, collar_section + 1, 0, {}};
  for (uint32_t y = 0; y <= collar_section; ++y)
    for (uint32_t x = 0; x <= collar_around; ++x)
      torus.vertices.push_back(first + (y % collar_section) * collar_around + x % collar_around);
  for (uint32_t y = 0; y < collar_section; ++y)
    for (uint32_t x = 0; x < collar_around; ++x)
      positions.push_back(
          snap(collar_point(2 * pi * float(x) / collar_around, 2 * pi * float(y) / collar_section)));
  add_grid(mesh, std::move(torus));
  add_part(mesh, 0, material);
  sculpt(mesh, [&](const Expression&) { return positions; });
  return mesh;
}

}  // namespace lodestone::scene::builtin
