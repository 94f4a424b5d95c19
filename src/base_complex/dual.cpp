// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/dual.h"

#include <algorithm>
#include <map>
#include <set>

namespace lodestone::base_complex {
namespace {

class Dual {
 public:
  explicit Dual(const BaseComplex& complex) : complex_(complex), beside_(cells_beside_arcs(complex)) {}

  std::vector<uint32_t> run() {
    for (uint32_t c = 0; c < complex_.cells.size(); ++c) find_double_edges(c);
    find_double_triangles();
    return {to_split_.begin(), to_split_.end()};
  }

 private:
  uint32_t beyond(uint32_t cell, const Passage& passage) const {
    const std::vector<uint32_t>& cells = beside_[passage.arc];
    if (cells.size() != 2) return none;
    return cells[0] == cell ? cells[1] : cells[0];
  }

  void find_double_edges(uint32_t cell) {
    const std::vector<Passage>& boundary = complex_.cells[cell].boundary;
    std::map<uint32_t, int> stretches;
    for (size_t i = 0; i < boundary.size(); ++i) {
      const uint32_t here = beyond(cell, boundary[i]);
      const uint32_t before = beyond(cell, boundary[i > 0 ? i - 1 : boundary.size() - 1]);
      if (here != none && here != before && ++stretches[here] == 2) split_largest({cell, here});
    }
  }

  void find_double_triangles() {
    std::map<uint32_t, std::set<uint32_t>> cells_at;  // each node
    std::set<uint32_t> other_nodes;                   // where the surface is no manifold
    for (uint32_t a = 0; a < beside_.size(); ++a) {
      for (const uint32_t node : {complex_.arcs[a].points.front(), complex_.arcs[a].points.back()}) {
        cells_at[node].insert(beside_[a].begin(), beside_[a].end());
        if (beside_[a].size() > 2) other_nodes.insert(node);
      }
    }
    std::set<std::set<uint32_t>> triangles;
    for (const auto& [node, cells] : cells_at)
      if (cells.size() == 3 && other_nodes.count(node) == 0 && !triangles.insert(cells).second)
        split_largest(cells);
  }

  void split_largest(const std::set<uint32_t>& cells) {
    to_split_.insert(*std::max_element(cells.begin(), cells.end(), [&](uint32_t a, uint32_t b) {
      return complex_.cells[a].area < complex_.cells[b].area;
    }));
  }

  const BaseComplex& complex_;
  std::vector<std::vector<uint32_t>> beside_;  // of each arc, its cells
  std::set<uint32_t> to_split_;
};

}  // namespace

std::vector<uint32_t> cells_against_proper_dual(const BaseComplex& complex) {
  return Dual(complex).run();
}

}  // namespace lodestone::base_complex
