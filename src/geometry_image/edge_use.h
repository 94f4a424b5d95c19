// SPDX-License-Identifier: MIT
// How many triangles share each edge.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

// Half-edge 3 t + k of triangle t goes from its corner k to the next one. Corners are welded vertices.
struct HalfEdge {
  uint32_t from, to;
};
HalfEdge half_edge(const scene::Assembly& assembly, const std::vector<uint32_t>& welded, uint32_t index);

class EdgeUse {
 public:
  // Counts the triangles of the given half-edges (at most 2^32 - 1), whatever way each runs along its edge.
  EdgeUse(const scene::Assembly& assembly, const std::vector<uint32_t>& welded,
          const std::vector<uint32_t>& half_edges);

  // Triangles at the edge of half_edges[i].
  uint32_t triangles(size_t i) const { return uses_[first_[i]]; }
  // Takes back half_edges[i]. Each one once.
  void remove(size_t i) { --uses_[first_[i]]; }

  uint64_t boundary_edges() const;
  uint64_t non_manifold_edges() const;

 private:
  std::vector<uint32_t> first_;  // of each half-edge, the first one of the same edge
  std::vector<uint32_t> uses_;   // by first half-edge
};

}  // namespace lodestone::geometry_image
