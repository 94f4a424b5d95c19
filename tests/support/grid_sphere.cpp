// SPDX-License-Identifier: MIT
#include "lodestone/test_support/grid_sphere.h"

#include <cmath>

namespace lodestone::test {

scene::Scene grid_sphere(uint32_t quads) {
  constexpr double pi = 3.14159265358979;
  scene::Mesh mesh;
  mesh.name = "bumpy sphere";
  scene::Grid grid;
  grid.width = grid.height = quads + 1;
  std::vector<uint32_t> rows;  // first vertex of each row; poles have one vertex
  for (uint32_t y = 0; y <= quads; ++y) {
    rows.push_back(static_cast<uint32_t>(mesh.positions.size()));
    const bool pole = y == 0 || y == quads;
    for (uint32_t x = 0; x < (pole ? 1 : quads); ++x) {
      const double theta = pi * y / quads, phi = 2 * pi * x / quads;
      const double bump = 1 + 0.08 * std::sin(7 * phi) * std::pow(std::sin(theta), 3) * std::sin(5 * theta);
      const glm::vec3 p(bump * std::sin(theta) * std::cos(phi), bump * std::cos(theta),
                        bump * std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(p);
      mesh.normals.push_back(glm::normalize(p));
    }
  }
  for (uint32_t y = 0; y <= quads; ++y) {
    for (uint32_t x = 0; x <= quads; ++x) {
      grid.vertices.push_back(rows[y] + (y == 0 || y == quads ? 0 : x % quads));
    }
  }
  for (uint32_t y = 0; y < quads; ++y) {
    for (uint32_t x = 0; x < quads; ++x) {
      const uint32_t a = grid.vertices[y * (quads + 1) + x], b = grid.vertices[y * (quads + 1) + x + 1];
      const uint32_t c = grid.vertices[(y + 1) * (quads + 1) + x],
                     d = grid.vertices[(y + 1) * (quads + 1) + x + 1];
      mesh.triangles.emplace_back(a, b, c);
      mesh.triangles.emplace_back(d, c, b);
    }
  }
  mesh.parts = {{0, static_cast<uint32_t>(mesh.triangles.size()), scene::none}};
  mesh.grids = {grid};
  scene::Scene scene;
  scene.name = "grid sphere";
  scene.meshes = {mesh};
  scene::Node node;
  node.mesh = 0;
  scene.nodes = {node};
  return scene;
}

}  // namespace lodestone::test
