// SPDX-License-Identifier: MIT
// The skin of the head: a cylinder wall of directions with caps, and rings of edge loops around eyes and
// mouth.
#pragma once

#include <array>
#include <vector>

#include "lodestone/scene/builtin/head_expression.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {

// The colour of the skin that rests at an aim, linear.
glm::vec3 skin_color(Aim rest);

class HeadSkin {
 public:
  static constexpr uint32_t eye_ring_rows = 26, mouth_ring_rows = 39;

  HeadSkin();
  const std::vector<Grid>& grids() const { return grids_; }
  std::vector<glm::vec3> posed(const Expression& expression) const;
  std::vector<glm::vec4> colors() const;

 private:
  // Columns run counter-clockwise around an opening, rows inwards; the last row is the border of a cap.
  struct Ring {
    glm::ivec2 lo, hi;          // the samples of the front that it replaces
    uint32_t first_vertex = 0;  // of row 1; row 0 is the border of the hole
    std::vector<uint32_t> border;
    uint32_t rows = 0;
  };
  Aim lattice_aim(glm::ivec3 point) const;
  void add_front();
  Ring add_ring(glm::ivec2 lo, glm::ivec2 hi, uint32_t rows);
  uint32_t ring_vertex(const Ring& ring, uint32_t column, uint32_t row) const;
  // Where a column meets the slit of its opening: 0 at the right corner, 1 at the left, on the lower or upper
  // side.
  struct Seam {
    float turn;
    bool upper;
  };
  Seam ring_seam(const Ring& ring, uint32_t column) const;
  void lay_lids(const Ring& ring, float side);
  void lay_lips(const Ring& ring);
  glm::vec3 face_point(uint32_t vertex, Aim aim) const;
  glm::vec3 face_normal(uint32_t vertex, Aim aim, glm::vec3 point) const;
  glm::vec3 posed_vertex(uint32_t vertex, const Expression& expression, float lift = 0) const;
  void pose_eye(const Ring& ring, float side, const Expression& expression,
                std::vector<glm::vec3>& out) const;
  void pose_mouth(const Ring& ring, const Expression& expression, std::vector<glm::vec3>& out) const;
  void color_eye(const Ring& ring, float side, std::vector<glm::vec4>& out) const;
  void color_mouth(const Ring& ring, std::vector<glm::vec4>& out) const;
  void pose_cap(const Ring& ring, std::vector<glm::vec3>& out) const;

  BoxLattice lattice_;
  std::vector<Grid> grids_;
  // Of every vertex on the face, lattice points first: what it rests at. Casting rays is most of the work,
  // and most of the face rests in most expressions.
  std::vector<Aim> aims_;
  std::vector<glm::vec3> points_, normals_;
  std::array<Ring, 2> eyes_;  // right (-X), left
  Ring mouth_;
  uint32_t vertex_count_ = 0;
};

}  // namespace lodestone::scene::builtin
