// SPDX-License-Identifier: MIT
// Closed surfaces made of rectangular grids of samples: what every built-in scene is assembled from.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::scene::builtin {

// Generated numbers are rounded to multiples of 2^-20, so that sin and exp of another C library, which may
// differ in the last bit, give the same scene.
float snap(float value);
glm::vec2 snap(glm::vec2 value);
glm::vec3 snap(glm::vec3 value);

// The surface of a box of nx x ny x nz cells as six charts. Faces share the vertices of their common edges.
// Nothing is said of where a vertex lies: the owner maps lattice points to positions.
class BoxLattice {
 public:
  enum class Face { front, right, back, left, top, bottom };  // +Z, +X, -Z, -X, +Y, -Y
  static constexpr std::array<Face, 6> faces = {Face::front, Face::right, Face::back,
                                                Face::left,  Face::top,   Face::bottom};

  // Vertices are numbered from `first_vertex`.
  BoxLattice(glm::ivec3 cells, uint32_t first_vertex = 0);

  glm::ivec3 cells() const { return cells_; }
  // The lattice points on the surface, in the order of their vertices.
  const std::vector<glm::ivec3>& points() const { return points_; }
  uint32_t vertex(glm::ivec3 point) const;  // `point` must lie on the surface

  // Samples of a face in both directions; columns run so that columns x rows points outwards.
  glm::ivec2 face_cells(Face face) const;
  glm::ivec3 face_point(Face face, glm::ivec2 sample) const;
  Grid chart(Face face) const;
  // The samples lo .. hi of a face, both included.
  Grid chart(Face face, glm::ivec2 lo, glm::ivec2 hi) const;

 private:
  glm::ivec3 cells_;
  uint32_t first_vertex_;
  std::vector<glm::ivec3> points_;
  std::vector<uint32_t> vertex_of_;  // by lattice point, `none` inside the box
};

// The direction of a surface point of a cube lattice, spread evenly: the corners of a cube-sphere.
glm::vec3 cube_sphere_direction(const BoxLattice& lattice, glm::ivec3 point);

// A unit sphere of six charts of `cells` x `cells` quads that share the vertices of their borders.
Mesh ball(const std::string& name, int cells, uint32_t material);

// A tube of `columns` samples around (even) and `rows` along, closed by zipping the first and the last row
// onto themselves: one chart without a pole. Sample (column, row) and (columns - column, row) of a zipped row
// are one vertex, so a cross-section there must be flat: a line.
class ZippedTube {
 public:
  ZippedTube(uint32_t columns, uint32_t rows, uint32_t first_vertex = 0);
  struct Sample {
    uint32_t column, row;
  };
  const std::vector<Sample>& samples() const { return samples_; }  // in the order of the vertices
  Grid chart() const;
  uint32_t columns() const { return columns_; }
  uint32_t rows() const { return rows_; }

 private:
  uint32_t vertex(uint32_t column, uint32_t row) const;
  uint32_t columns_, rows_, first_vertex_;
  std::vector<Sample> samples_;
};

// Appends the triangles of a grid to a mesh by the rule of Grid, which gets its first_triangle.
void add_grid(Mesh& mesh, Grid grid);
// Closes the part that began at triangle `first`.
void add_part(Mesh& mesh, uint32_t first_triangle, uint32_t material);
// Smooth unit normals, rounded.
std::vector<glm::vec3> snapped_normals(const Mesh& mesh, const std::vector<glm::vec3>& positions);
// The blendshape that takes the mesh to `posed`, normals included; empty where no vertex moves. Normals of
// the mesh must be set.
MorphTarget morph_target(const Mesh& mesh, const std::string& name, const std::vector<glm::vec3>& posed);
// Adds it, at rest, unless it is empty.
void add_target(Mesh& mesh, MorphTarget target);

}  // namespace lodestone::scene::builtin
