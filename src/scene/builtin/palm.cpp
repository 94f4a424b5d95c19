// SPDX-License-Identifier: MIT
// A coconut palm: a ringed trunk, leaves with a fringe, and a few nuts.
#include <algorithm>
#include <cmath>

#include "lodestone/scene/builtin/island.h"
#include "lodestone/scene/builtin/noise.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;
constexpr uint32_t trunk_columns = 8, trunk_rows = 16;  // quads
constexpr int leaves = 15, nuts = 4;
constexpr uint32_t leaf_rows = 24;
constexpr glm::vec3 up(0, 1, 0);

// Numbers in [0, 1) that say how a palm differs from another.
float chance(uint32_t kind, int what) {
  return lattice_noise(int(kind), what, 77);
}

// The middle of the trunk: it rises at a slant and straightens.
glm::vec3 trunk_middle(uint32_t kind, float along) {
  const float height = 19 + 5 * chance(kind, 0), lean = 3 + 4 * chance(kind, 1);
  return {lean * along * (1.6f - 0.6f * along), height * along, 0.8f * std::sin(pi * along)};
}

void add_trunk(Mesh& mesh, uint32_t kind) {
  const uint32_t first = uint32_t(mesh.positions.size());
  for (uint32_t row = 0; row <= trunk_rows; ++row) {
    // From below the ground, which is uneven, to just inside the crown.
    const float along = glm::mix(-0.1f, 1.01f, float(row) / trunk_rows);
    const float scar = row % 2 == 0 ? 1.0f : 0.86f;  // where leaves have been
    const float foot = std::max(0.25f - along, 0.0f);
    const float radius = scar * (0.62f - 0.24f * along + 4 * foot * foot);
    const glm::vec3 middle = trunk_middle(kind, along);
    for (uint32_t column = 0; column < trunk_columns; ++column) {
      const float turn = -2 * pi * float(column) / trunk_columns;  // columns x rows points outwards
      mesh.positions.push_back(middle + radius * glm::vec3(std::cos(turn), 0, std::sin(turn)));
      mesh.colors.emplace_back(
          glm::mix(glm::vec3(0.17f, 0.12f, 0.08f), glm::vec3(0.30f, 0.24f, 0.17f), scar * 7 - 6), 1);
    }
  }
  Grid grid{trunk_columns + 1, trunk_rows + 1, 0, {}};
  for (uint32_t row = 0; row <= trunk_rows; ++row)
    for (uint32_t column = 0; column <= trunk_columns; ++column)
      grid.vertices.push_back(first + row * trunk_columns + column % trunk_columns);
  add_grid(mesh, std::move(grid));
}

// Three vertices a row: the left tip of a leaflet, the rib, the right tip; every other row is a notch between
// two leaflets.
void add_leaf(Mesh& mesh, glm::vec3 root, float azimuth, float elevation, float length, float tint) {
  const uint32_t first = uint32_t(mesh.positions.size());
  const glm::vec3 out(std::cos(azimuth), 0, std::sin(azimuth)), side = glm::cross(up, out);
  glm::vec3 rib = root;
  for (uint32_t row = 0; row <= leaf_rows; ++row) {
    const float along = float(row) / leaf_rows;
    // Bent by its weight, more and more.
    const float angle = elevation - 1.9f * along * along - 0.35f * along;
    const glm::vec3 forward = std::cos(angle) * out + std::sin(angle) * up;
    const glm::vec3 over = glm::cross(forward, side);
    const float fullness = std::sqrt(std::min(6 * along, 1.0f)) * std::pow(1 - along, 0.7f);
    const bool tip = row % 2 == 0;
    const float width = 0.05f + (tip ? 2.3f : 0.7f) * fullness;
    const float sweep = tip ? 0.45f * width : 0.0f, droop = (0.45f + 0.4f * along) * width;
    for (const float way : {1.0f, 0.0f, -1.0f}) {
      const float reach = std::abs(way);
      mesh.positions.push_back(rib + way * width * side + reach * (sweep * forward - droop * over));
      const glm::vec3 green = glm::mix(glm::vec3(0.05f, 0.13f, 0.02f), glm::vec3(0.17f, 0.26f, 0.05f),
                                       reach * 0.5f + tint * 0.5f);
      mesh.colors.emplace_back(glm::mix(green, glm::vec3(0.42f, 0.36f, 0.10f), 0.6f * along * along * tint),
                               1);
    }
    rib += forward * (length / leaf_rows);
  }
  Grid grid{3, leaf_rows + 1, 0, {}};
  for (uint32_t v = 0; v < 3 * (leaf_rows + 1); ++v) grid.vertices.push_back(first + v);
  add_grid(mesh, std::move(grid));
}

void add_nut(Mesh& mesh, glm::vec3 centre, float radius) {
  const BoxLattice lattice(glm::ivec3(3), uint32_t(mesh.positions.size()));
  for (const glm::ivec3& point : lattice.points()) {
    mesh.positions.push_back(centre + radius * glm::vec3(1, 1.2f, 1) * cube_sphere_direction(lattice, point));
    mesh.colors.emplace_back(0.20f, 0.13f, 0.04f, 1);
  }
  for (const BoxLattice::Face face : BoxLattice::faces) add_grid(mesh, lattice.chart(face));
}

}  // namespace

Mesh palm(const std::string& name, uint32_t kind, uint32_t material) {
  Mesh mesh;
  mesh.name = name;
  add_trunk(mesh, kind);
  const glm::vec3 crown = trunk_middle(kind, 1);
  for (int leaf = 0; leaf < leaves; ++leaf) {
    // By the golden angle, the old ones at the bottom.
    const float age = float(leaf) / (leaves - 1);
    const float azimuth = 2.3999632f * float(leaf) + 6 * chance(kind, 2);
    const float elevation = 1.25f - 1.35f * age + 0.2f * (chance(kind, 10 + leaf) - 0.5f);
    const float length = 10.5f + 2 * chance(kind, 30 + leaf) - 2.5f * (1 - age);
    add_leaf(mesh, crown, azimuth, elevation, length, age);
  }
  for (int nut = 0; nut < nuts; ++nut) {
    const float turn = 2 * pi * (float(nut) + chance(kind, 3)) / nuts;
    add_nut(mesh, crown + glm::vec3(0.75f * std::cos(turn), -0.85f, 0.75f * std::sin(turn)), 0.5f);
  }
  add_part(mesh, 0, material);
  for (glm::vec3& p : mesh.positions) p = snap(p);
  mesh.normals = snapped_normals(mesh, mesh.positions);
  return mesh;
}

}  // namespace lodestone::scene::builtin
