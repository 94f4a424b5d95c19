// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/edge_use.h"

#include <algorithm>
#include <utility>

#include "lodestone/geometry_image/first_equal.h"

namespace lodestone::geometry_image {
namespace {

std::pair<uint32_t, uint32_t> undirected(HalfEdge edge) {
  return std::minmax({edge.from, edge.to});
}

}  // namespace

HalfEdge half_edge(const scene::Assembly& assembly, const std::vector<uint32_t>& welded, uint32_t index) {
  const glm::uvec4& triangle = assembly.triangles[index / 3];
  const auto corner = static_cast<glm::length_t>(index % 3);
  return {welded[triangle[corner]], welded[triangle[(corner + 1) % 3]]};
}

EdgeUse::EdgeUse(const scene::Assembly& assembly, const std::vector<uint32_t>& welded,
                 const std::vector<uint32_t>& half_edges) {
  const auto edge = [&](uint32_t i) { return undirected(half_edge(assembly, welded, half_edges[i])); };
  first_ = first_equal(
      static_cast<uint32_t>(half_edges.size()),
      [&](uint32_t i) {
        const auto [low, high] = edge(i);
        WordHash hash;
        hash.add((uint64_t(low) << 32) | high);
        return hash.value();
      },
      [&](uint32_t i, uint32_t j) { return edge(i) == edge(j); });
  uses_.resize(first_.size(), 0);
  for (const uint32_t first : first_) ++uses_[first];
}

uint64_t EdgeUse::boundary_edges() const {
  return static_cast<uint64_t>(std::count(uses_.begin(), uses_.end(), 1u));
}

uint64_t EdgeUse::non_manifold_edges() const {
  return static_cast<uint64_t>(
      std::count_if(uses_.begin(), uses_.end(), [](uint32_t uses) { return uses > 2; }));
}

}  // namespace lodestone::geometry_image
