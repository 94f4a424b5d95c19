// SPDX-License-Identifier: MIT
#include "lodestone/scene/builtin/island.h"

#include <algorithm>
#include <cmath>

#include "lodestone/scene/builtin/noise.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;
constexpr float shore_radius = 82;  // roughly

constexpr int ground_charts = 3, chart_cells = 32;
constexpr int ground_cells = ground_charts * chart_cells;

constexpr uint32_t sea_charts = 8, sea_columns = 16, sea_rows = 32;  // quads of a chart around and outwards
constexpr float sea_inner = 56, sea_outer = 800;

// The coordinate of a column or row: samples are denser in the middle of the island.
float spread(int sample) {
  const float s = 2 * float(sample) / ground_cells - 1;
  return ground_half_width * (0.5f * s + 0.5f * s * s * s);
}

glm::vec3 sea_point(uint32_t column, uint32_t row) {
  const float out = float(row) / sea_rows;
  const float radius = sea_inner * std::pow(sea_outer / sea_inner, out);
  const float turn = 2 * pi * float(column % (sea_charts * sea_columns)) / (sea_charts * sea_columns);
  const glm::vec2 p = radius * glm::vec2(std::cos(turn), std::sin(turn));
  // A swell that dies away where samples get too far apart for it.
  const float swell = fractal_noise(p, 0.055f, 2) * 0.30f * (1 - glm::smoothstep(120.0f, 320.0f, radius));
  return {p.x, sea_level + swell, p.y};
}

glm::vec4 sea_color(glm::vec3 p) {
  const glm::vec3 shallow(0.06f, 0.36f, 0.34f), deep(0.006f, 0.055f, 0.13f);
  const float depth = sea_level - island_height({p.x, p.z});
  const float far = glm::smoothstep(
      90.0f, 200.0f, glm::length(glm::vec2(p.x, p.z)) + 20 * fractal_noise({p.x, p.z}, 0.02f, 2));
  return glm::vec4(glm::mix(shallow, deep, std::max(far, 0.5f * glm::smoothstep(1.0f, 6.0f, depth))), 1);
}

}  // namespace

float island_height(glm::vec2 place) {
  const float radius = glm::length(place);
  // A shore with bays; the bed of the lagoon is 4 deep.
  const float shore = shore_radius + 14 * fractal_noise(place, 0.022f, 2);
  const float land = 1 - glm::smoothstep(shore - 26, shore + 26, radius);
  // Hills leave the middle alone and end before the beach.
  const float hills = (1.2f + 1.3f * fractal_noise(place, 0.05f, 3)) *
                      glm::smoothstep(plateau_radius, 3 * plateau_radius, radius) *
                      glm::smoothstep(0.4f, 1.0f, land);
  return (sea_level - 4) * (1 - land) + hills * land;
}

Mesh island_ground(uint32_t material) {
  Mesh mesh;
  mesh.name = "ground";
  // Columns run along +X and rows along -Z, so that columns x rows points up.
  for (int y = 0; y <= ground_cells; ++y)
    for (int x = 0; x <= ground_cells; ++x) {
      const glm::vec2 place(spread(x), -spread(y));
      mesh.positions.push_back(snap(glm::vec3(place.x, island_height(place), place.y)));
      mesh.texcoords[0].push_back(snap(0.5f + 0.5f * place / ground_half_width));
    }
  for (int chart = 0; chart < ground_charts * ground_charts; ++chart) {
    Grid grid{chart_cells + 1, chart_cells + 1, 0, {}};
    const int first =
        chart / ground_charts * chart_cells * (ground_cells + 1) + chart % ground_charts * chart_cells;
    for (int y = 0; y <= chart_cells; ++y)
      for (int x = 0; x <= chart_cells; ++x)
        grid.vertices.push_back(uint32_t(first + y * (ground_cells + 1) + x));
    add_grid(mesh, std::move(grid));
  }
  add_part(mesh, 0, material);
  mesh.normals = snapped_normals(mesh, mesh.positions);
  return mesh;
}

Mesh island_sea(uint32_t material) {
  Mesh mesh;
  mesh.name = "sea";
  constexpr uint32_t around = sea_charts * sea_columns;
  for (uint32_t row = 0; row <= sea_rows; ++row)
    for (uint32_t column = 0; column < around; ++column)
      mesh.positions.push_back(snap(sea_point(column, row)));
  for (uint32_t chart = 0; chart < sea_charts; ++chart) {
    Grid grid{sea_columns + 1, sea_rows + 1, 0, {}};
    // From +X towards +Z, and outwards: columns x rows points up.
    for (uint32_t row = 0; row <= sea_rows; ++row)
      for (uint32_t column = 0; column <= sea_columns; ++column)
        grid.vertices.push_back(row * around + (chart * sea_columns + column) % around);
    add_grid(mesh, std::move(grid));
  }
  add_part(mesh, 0, material);
  mesh.normals = snapped_normals(mesh, mesh.positions);
  for (const glm::vec3& p : mesh.positions) mesh.colors.push_back(sea_color(p));
  return mesh;
}

}  // namespace lodestone::scene::builtin
