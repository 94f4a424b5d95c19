// SPDX-License-Identifier: MIT
#include "lodestone/scene/builtin/surface.h"

#include <cmath>

#include "lodestone/scene/mesh_tools.h"

namespace lodestone::scene::builtin {

float snap(float value) {
  constexpr float steps = 1048576.0f;
  return std::floor(value * steps + 0.5f) / steps;
}
glm::vec2 snap(glm::vec2 value) {
  return {snap(value.x), snap(value.y)};
}
glm::vec3 snap(glm::vec3 value) {
  return {snap(value.x), snap(value.y), snap(value.z)};
}

BoxLattice::BoxLattice(glm::ivec3 cells, uint32_t first_vertex) : cells_(cells), first_vertex_(first_vertex) {
  const glm::ivec3 n = cells + 1;
  vertex_of_.assign(size_t(n.x) * n.y * n.z, none);
  for (int k = 0; k < n.z; ++k)
    for (int j = 0; j < n.y; ++j)
      for (int i = 0; i < n.x; ++i) {
        const bool inside = i > 0 && i < cells.x && j > 0 && j < cells.y && k > 0 && k < cells.z;
        if (inside) continue;
        vertex_of_[(size_t(k) * n.y + j) * n.x + i] = first_vertex_ + uint32_t(points_.size());
        points_.emplace_back(i, j, k);
      }
}

uint32_t BoxLattice::vertex(glm::ivec3 point) const {
  return vertex_of_[(size_t(point.z) * (cells_.y + 1) + point.y) * (cells_.x + 1) + point.x];
}

glm::ivec2 BoxLattice::face_cells(Face face) const {
  switch (face) {
    case Face::front:
    case Face::back:
      return {cells_.x, cells_.y};
    case Face::right:
    case Face::left:
      return {cells_.z, cells_.y};
    default:
      return {cells_.x, cells_.z};
  }
}

glm::ivec3 BoxLattice::face_point(Face face, glm::ivec2 sample) const {
  const auto [x, y] = std::pair(sample.x, sample.y);
  switch (face) {
    case Face::front:
      return {x, y, cells_.z};
    case Face::right:
      return {cells_.x, y, cells_.z - x};
    case Face::back:
      return {cells_.x - x, y, 0};
    case Face::left:
      return {0, y, x};
    case Face::top:
      return {x, cells_.y, cells_.z - y};
    default:
      return {x, 0, y};
  }
}

Grid BoxLattice::chart(Face face) const {
  return chart(face, {0, 0}, face_cells(face));
}

Grid BoxLattice::chart(Face face, glm::ivec2 lo, glm::ivec2 hi) const {
  Grid grid;
  grid.width = uint32_t(hi.x - lo.x + 1);
  grid.height = uint32_t(hi.y - lo.y + 1);
  for (int y = lo.y; y <= hi.y; ++y)
    for (int x = lo.x; x <= hi.x; ++x) grid.vertices.push_back(vertex(face_point(face, {x, y})));
  return grid;
}

glm::vec3 cube_sphere_direction(const BoxLattice& lattice, glm::ivec3 point) {
  const glm::vec3 box = 2.0f * glm::vec3(point) / glm::vec3(lattice.cells()) - 1.0f;
  const glm::vec3 warped(std::tan(box.x * 0.7853982f), std::tan(box.y * 0.7853982f),
                         std::tan(box.z * 0.7853982f));
  return glm::normalize(warped);
}

ZippedTube::ZippedTube(uint32_t columns, uint32_t rows, uint32_t first_vertex)
    : columns_(columns), rows_(rows), first_vertex_(first_vertex) {
  for (uint32_t row = 0; row < rows; ++row) {
    const bool zipped = row == 0 || row + 1 == rows;
    const uint32_t count = zipped ? columns / 2 + 1 : columns;
    for (uint32_t column = 0; column < count; ++column) samples_.push_back({column, row});
  }
}

uint32_t ZippedTube::vertex(uint32_t column, uint32_t row) const {
  const uint32_t zipped_count = columns_ / 2 + 1;
  const uint32_t c = column % columns_;
  const uint32_t folded = std::min(c, columns_ - c);
  if (row == 0) return first_vertex_ + folded;
  const uint32_t before = first_vertex_ + zipped_count + (row - 1) * columns_;
  return before + (row + 1 == rows_ ? folded : c);
}

Grid ZippedTube::chart() const {
  Grid grid;
  grid.width = columns_ + 1;
  grid.height = rows_;
  for (uint32_t row = 0; row < rows_; ++row)
    for (uint32_t column = 0; column <= columns_; ++column) grid.vertices.push_back(vertex(column, row));
  return grid;
}

void add_grid(Mesh& mesh, Grid grid) {
  grid.first_triangle = uint32_t(mesh.triangles.size());
  for (uint32_t y = 0; y + 1 < grid.height; ++y)
    for (uint32_t x = 0; x + 1 < grid.width; ++x) {
      const uint32_t* corner = &grid.vertices[size_t(y) * grid.width + x];
      const uint32_t a = corner[0], b = corner[1], c = corner[grid.width], d = corner[grid.width + 1];
      mesh.triangles.emplace_back(a, b, c);
      mesh.triangles.emplace_back(d, c, b);
    }
  mesh.grids.push_back(std::move(grid));
}

void add_part(Mesh& mesh, uint32_t first_triangle, uint32_t material) {
  mesh.parts.push_back({first_triangle, uint32_t(mesh.triangles.size()) - first_triangle, material});
}

std::vector<glm::vec3> snapped_normals(const Mesh& mesh, const std::vector<glm::vec3>& positions) {
  std::vector<glm::vec3> normals = smooth_normals(positions, mesh.triangles);
  for (glm::vec3& n : normals) n = snap(n);
  return normals;
}

MorphTarget morph_target(const Mesh& mesh, const std::string& name, const std::vector<glm::vec3>& posed) {
  MorphTarget target;
  target.name = name;
  if (posed == mesh.positions) return target;
  const std::vector<glm::vec3> normals = snapped_normals(mesh, posed);
  for (uint32_t v = 0; v < posed.size(); ++v) {
    const glm::vec3 move = posed[v] - mesh.positions[v];
    const glm::vec3 turn = normals[v] - mesh.normals[v];
    if (move == glm::vec3(0) && turn == glm::vec3(0)) continue;
    target.vertices.push_back(v);
    target.positions.push_back(move);
    target.normals.push_back(turn);
  }
  return target;
}

void add_target(Mesh& mesh, MorphTarget target) {
  if (target.vertices.empty()) return;
  mesh.targets.push_back(std::move(target));
  mesh.weights.push_back(0);
}

Mesh ball(const std::string& name, int cells, uint32_t material) {
  Mesh mesh;
  mesh.name = name;
  const BoxLattice lattice(glm::ivec3{cells});
  for (const glm::ivec3& point : lattice.points())
    mesh.positions.push_back(snap(cube_sphere_direction(lattice, point)));
  mesh.normals = mesh.positions;
  for (const BoxLattice::Face face : BoxLattice::faces) add_grid(mesh, lattice.chart(face));
  add_part(mesh, 0, material);
  return mesh;
}

}  // namespace lodestone::scene::builtin
