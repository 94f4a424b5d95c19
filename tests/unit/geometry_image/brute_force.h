// SPDX-License-Identifier: MIT
// Edges counted the slow and obvious way.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <utility>

namespace lodestone::geometry_image::test {

using PositionBits = std::array<uint32_t, 3>;

inline PositionBits bits_of(const glm::vec3& p) {
  return std::bit_cast<PositionBits>(p);
}

// Triangles by edge; an edge is two different points, whichever comes first.
class EdgeCounts {
 public:
  void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const PositionBits corners[3] = {bits_of(a), bits_of(b), bits_of(c)};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    for (int i = 0; i < 3; ++i) ++edges_[std::minmax(corners[i], corners[(i + 1) % 3])];
  }
  uint64_t boundary() const {
    return count([](uint32_t n) { return n == 1; });
  }
  uint64_t non_manifold() const {
    return count([](uint32_t n) { return n > 2; });
  }
  uint64_t odd() const {
    return count([](uint32_t n) { return n % 2 == 1; });
  }

 private:
  template <class Test>
  uint64_t count(const Test& test) const {
    uint64_t found = 0;
    for (const auto& [edge, triangles] : edges_) found += test(triangles) ? 1 : 0;
    return found;
  }
  std::map<std::pair<PositionBits, PositionBits>, uint32_t> edges_;
};

}  // namespace lodestone::geometry_image::test
