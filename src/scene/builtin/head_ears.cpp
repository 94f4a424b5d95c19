// SPDX-License-Identifier: MIT
// Ears and eyebrows: separate shapes set into and onto the skin.
#include <cmath>

#include "lodestone/scene/builtin/head_parts.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;
constexpr int ear_cells = 15;

// A point of the left ear: a shell with a rolled rim around a hollow.
glm::vec3 ear_point(glm::vec3 d) {
  const float r = std::sqrt(d.x * d.x + d.y * d.y);
  // In the plane of the ear: +x to the back, +y up, +z away from the head.
  const float egg = 1 + 0.22f * d.y;
  glm::vec3 p(0.19f * d.x * egg, 0.265f * d.y, 0.05f * d.z);
  if (d.z > 0) {
    const float rim = bump((r - 0.80f) / 0.28f) * (d.x < 0 && std::abs(d.y) < 0.5f ? 0.4f : 1.0f);
    const glm::vec2 hollow(d.x + 0.12f, d.y + 0.05f);
    p.z += 0.030f * rim - 0.055f * bump(glm::length(hollow) / 0.62f);
    p.z += 0.028f * bump(glm::length(glm::vec2(d.x - 0.28f, d.y - 0.1f) / glm::vec2(0.16f, 0.5f)));
  }
  // Stands off the head at the back and leans backwards.
  const float flare = 0.55f, lean = -0.22f;
  p = {p.x * std::cos(lean) - p.y * std::sin(lean), p.x * std::sin(lean) + p.y * std::cos(lean), p.z};
  const float out = p.x * std::sin(flare) + p.z * std::cos(flare);
  const float back = p.x * std::cos(flare) - p.z * std::sin(flare);
  return glm::vec3(0.80f, -0.05f, -0.09f) + glm::vec3(out, p.y, -back);
}

struct BrowSection {
  Aim middle;
  float width, height;
};

BrowSection brow_section(float along) {
  const float arch = bump((along - 0.62f) / 0.9f);
  BrowSection section;
  section.middle = {glm::mix(0.13f, 0.66f, along), 0.435f + 0.10f * arch - 0.03f * along};
  const float taper = std::sqrt(std::max(1 - std::pow(2 * along - 1, 4.0f), 0.0f));
  section.width = 0.010f + 0.050f * taper * (1 - 0.60f * along);
  section.height = 0.034f * taper;
  return section;
}

}  // namespace

Mesh head_ears(uint32_t material) {
  Mesh mesh;
  mesh.name = "ears";
  std::vector<glm::vec3> positions;
  for (const float side : {1.0f, -1.0f}) {
    const BoxLattice lattice(glm::ivec3{ear_cells}, uint32_t(positions.size()));
    for (const BoxLattice::Face face : BoxLattice::faces) add_grid(mesh, lattice.chart(face));
    for (const glm::ivec3& point : lattice.points()) {
      glm::vec3 d = cube_sphere_direction(lattice, point);
      if (side < 0) d.x = -d.x;  // mirrored twice: the triangles keep facing outwards
      const glm::vec3 p = ear_point(d);
      positions.push_back(snap(glm::vec3(side * p.x, p.y, p.z)));
    }
  }
  add_part(mesh, 0, material);
  sculpt(mesh, [&](const Expression&) { return positions; });
  mesh.colors.assign(mesh.positions.size(), glm::vec4(0.74f, 0.31f, 0.215f, 1));
  return mesh;
}

Mesh head_brows(uint32_t material) {
  Mesh mesh;
  mesh.name = "brows";
  constexpr uint32_t columns = 16, rows = 33;
  const ZippedTube left(columns, rows), right(columns, rows, uint32_t(left.samples().size()));
  add_grid(mesh, left.chart());
  add_grid(mesh, right.chart());
  add_part(mesh, 0, material);
  sculpt(mesh, [&](const Expression& e) {
    std::vector<glm::vec3> out;
    for (const float side : {1.0f, -1.0f})
      for (const ZippedTube::Sample& sample : left.samples()) {
        const float along = float(sample.row) / float(rows - 1);
        const float angle = 2 * pi * float(sample.column) / columns;
        const BrowSection section = brow_section(side > 0 ? along : 1 - along);
        const Aim aim = section.middle + Aim{0, section.width * std::cos(angle)};
        // Combed upwards and outwards.
        const float strand =
            1 + 0.05f * std::sin(60 * (side > 0 ? along : 1 - along) + 2.5f * std::cos(angle));
        const float lift = section.height * std::sin(angle) * strand + 0.004f;
        out.push_back(snap(skin_point({side * aim.azimuth, aim.elevation}, e, lift)));
      }
    return out;
  });
  return mesh;
}

}  // namespace lodestone::scene::builtin
