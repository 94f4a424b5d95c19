// SPDX-License-Identifier: MIT
// A triangle surface that can be cut: faces with neighbours, each a piece of an input triangle. It starts as
// the input itself; splitting an edge puts a point on it and makes two faces of each one beside it, so arcs
// may run where the input has no edges, and every point still says where on the input it lies.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lodestone::base_complex {

inline constexpr uint32_t none = 0xffffffffu;

// Half-edge 3 f + k of face f goes from its corner k to the next one.
inline uint32_t face_of(uint32_t half_edge) {
  return half_edge / 3;
}
inline uint32_t next(uint32_t half_edge) {
  return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}
inline uint32_t previous(uint32_t half_edge) {
  return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1;
}

class HalfEdgeMesh {
 public:
  // `triangles` list three different points each. Half-edges are twins where exactly two faces share an edge
  // and run along it in opposite directions. Coordinates that are no finite numbers become 0: a transform may
  // overflow, and distances must have an order.
  HalfEdgeMesh(std::vector<glm::dvec3> positions, std::span<const glm::uvec3> triangles);

  uint32_t faces() const { return static_cast<uint32_t>(triangle_.size()); }
  uint32_t points() const { return static_cast<uint32_t>(positions_.size()); }

  const glm::dvec3& position(uint32_t point) const { return positions_[point]; }
  uint32_t from(uint32_t half_edge) const { return from_[half_edge]; }
  uint32_t to(uint32_t half_edge) const { return from_[next(half_edge)]; }
  std::array<uint32_t, 3> corners(uint32_t face) const {
    return {from_[3 * size_t(face)], from_[3 * size_t(face) + 1], from_[3 * size_t(face) + 2]};
  }

  // The half-edge on the other side, where the surface goes on: `none` on a boundary, where more than two
  // faces meet, and where the two faces have opposite orientations.
  uint32_t twin(uint32_t half_edge) const { return twin_[half_edge]; }
  // All half-edges between the same two points, whatever their direction, are a cycle.
  uint32_t next_on_edge(uint32_t half_edge) const { return ring_[half_edge]; }
  // One half-edge of that cycle, the same for all of them: a name for the edge, until an edge is split.
  uint32_t edge_name(uint32_t half_edge) const { return name_[half_edge]; }
  double length(uint32_t half_edge) const {
    return glm::distance(positions_[from(half_edge)], positions_[to(half_edge)]);
  }

  // A barrier is an edge that must become an arc. Both sides are marked; edges without a twin always are.
  bool is_barrier(uint32_t half_edge) const { return twin_[half_edge] == none || barrier_[half_edge] != 0; }
  void make_barrier(uint32_t half_edge);

  // The input triangle that a face is a piece of, and where the face's corner `half_edge % 3` lies on it. The
  // barycentrics of a point on an edge of the triangle have an exact 0.
  uint32_t triangle(uint32_t face) const { return triangle_[face]; }
  glm::dvec3 barycentrics(uint32_t half_edge) const { return barycentrics_[half_edge]; }

  // Puts a point at `fraction` (0 .. 1, from the half-edge's start) of its edge, in all faces that share it,
  // and returns it. Of a face (u, v, w) with half-edge h from u to v there remain (u, new, w), in place, and
  // a new face (new, v, w): h then ends at the new point. `halves` lists, when given, each split face and the
  // face that was taken from it.
  struct Halves {
    uint32_t face, taken;
  };
  uint32_t split_edge(uint32_t half_edge, double fraction, std::vector<Halves>* halves = nullptr);

  // Halves edges, the longest first, until none is longer or there are `most_faces` or more.
  void split_longer_than(double length, uint32_t most_faces = none);

  double area(uint32_t face) const;
  // Unit length, or zero where the face has no area.
  glm::dvec3 normal(uint32_t face) const;
  glm::dvec3 centroid(uint32_t face) const;

 private:
  void connect(uint32_t a, uint32_t b);                // twins
  void link(const std::vector<uint32_t>& half_edges);  // a ring, named after the first
  void replace_in_ring(uint32_t old_one, uint32_t new_one);
  uint32_t split_face(uint32_t half_edge, uint32_t point, double fraction);

  std::vector<glm::dvec3> positions_;
  std::vector<uint32_t> from_, twin_, ring_, ring_back_, name_;
  std::vector<uint8_t> barrier_;
  std::vector<uint32_t> triangle_;
  std::vector<glm::dvec3> barycentrics_;
};

}  // namespace lodestone::base_complex
