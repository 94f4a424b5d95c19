// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/corners.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "lodestone/base/parallel.h"
#include "lodestone/base_complex/outline.h"

namespace lodestone::base_complex {
namespace {

// Chooses four corners so that the sides opposite each other are about equally long, the rectangle not long,
// and the surface's own corners are corners.
class CornerChoice {
 public:
  CornerChoice(const HalfEdgeMesh& mesh, const std::vector<uint32_t>& boundary,
               const std::vector<double>& angles, const std::vector<bool>& is_node)
      : mesh_(mesh), boundary_(boundary), is_node_(is_node), outline_(mesh, boundary) {
    nodes_before_.push_back(0);
    for (const uint32_t h : boundary)
      nodes_before_.push_back(nodes_before_.back() + (is_node[mesh.from(h)] ? 1 : 0));
    find_bends(angles);
    find_candidates();
  }

  std::array<uint32_t, 4> run() const {
    std::array<uint32_t, 4> best{};
    double least = std::numeric_limits<double>::infinity();
    const size_t count = candidates_.size();
    for (size_t a = 0; a + 3 < count; ++a) {
      for (size_t b = a + 1; b + 2 < count; ++b) {
        for (size_t c = b + 1; c + 1 < count; ++c) {
          for (size_t d = c + 1; d < count; ++d) {
            const std::array<uint32_t, 4> corners = {candidates_[a], candidates_[b], candidates_[c],
                                                     candidates_[d]};
            const double found = cost(corners);
            if (found < least) {
              least = found;
              best = corners;
            }
          }
        }
      }
    }
    return best;
  }

 private:
  static constexpr double right_angle = std::numbers::pi / 2;
  static constexpr size_t fewest = 4;

  // How far the boundary turns round each point and its near neighbours, the nearer ones counting more, as
  // measured on the surface (the turns of a whole disc and its curvature make 2 pi): of a zigzag little, of a
  // corner of a rectangle a right angle, of the points beside it less.
  void find_bends(const std::vector<double>& angles) {
    constexpr double near = 0.04;
    const size_t count = boundary_.size();
    const double reach = near * outline_.length;
    bends_.resize(count);
    for (size_t i = 0; i < count; ++i) {
      double bend = 2 * right_angle - angles[i];
      for (size_t j = (i + 1) % count; j != i && outline_.between(i, j) < reach; j = (j + 1) % count)
        bend += (2 * right_angle - angles[j]) * (1 - outline_.between(i, j) / reach);
      for (size_t j = (i + count - 1) % count; j != i && outline_.between(j, i) < reach;
           j = (j + count - 1) % count)
        bend += (2 * right_angle - angles[j]) * (1 - outline_.between(j, i) / reach);
      bends_[i] = bend;
    }
  }

  // All nodes, and points between those that are far apart; but few enough to try all choices.
  void find_candidates() {
    constexpr size_t most = 24, evenly = 12;
    const size_t count = boundary_.size();
    std::vector<bool> chosen(count, false);
    size_t nodes = 0;
    for (size_t i = 0; i < count; ++i) nodes += is_node_[mesh_.from(boundary_[i])] ? 1 : 0;
    if (nodes + evenly <= most) {
      for (size_t i = 0; i < count; ++i) chosen[i] = is_node_[mesh_.from(boundary_[i])];
    } else {
      // Of many nodes those where the boundary bends most.
      std::vector<size_t> order;
      for (size_t i = 0; i < count; ++i)
        if (is_node_[mesh_.from(boundary_[i])]) order.push_back(i);
      std::sort(order.begin(), order.end(),
                [&](size_t a, size_t b) { return bends_[a] != bends_[b] ? bends_[a] > bends_[b] : a < b; });
      for (size_t i = 0; i < most - evenly; ++i) chosen[order[i]] = true;
    }
    // Of each twelfth of the way the first point or one where the boundary clearly bends more; with four
    // edges, all four.
    constexpr double clearly = 1e-6;
    const double twelfth = outline_.length / evenly;
    double end = twelfth > 0 ? twelfth : std::numeric_limits<double>::infinity();
    size_t best = 0;
    for (size_t i = 1; i < count; ++i) {
      if (outline_.along[i] < end && count > fewest) {
        if (bends_[i] > bends_[best] + clearly) best = i;
        continue;
      }
      chosen[best] = true;
      best = i;
      while (end <= outline_.along[i]) end += twelfth;
    }
    chosen[best] = true;
    choose_sharp(chosen);
    for (size_t i = 0; i < count; ++i)
      if (chosen[i]) candidates_.push_back(static_cast<uint32_t>(i));
    for (size_t i = 0; candidates_.size() < fewest; ++i)
      if (!chosen[i]) {
        chosen[i] = true;
        candidates_.push_back(static_cast<uint32_t>(i));
      }
    std::sort(candidates_.begin(), candidates_.end());
  }

  // Corners of the surface that are close to another, and so not the sharpest of their twelfth.
  void choose_sharp(std::vector<bool>& chosen) const {
    constexpr size_t most = 4;
    constexpr double sharp = right_angle / 2;
    const size_t count = boundary_.size();
    std::vector<size_t> order;
    for (size_t i = 0; i < count; ++i) {
      const bool sharpest =
          bends_[i] > bends_[(i + 1) % count] && bends_[i] > bends_[(i + count - 1) % count];
      if (!chosen[i] && sharpest && bends_[i] > sharp) order.push_back(i);
    }
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return bends_[a] != bends_[b] ? bends_[a] > bends_[b] : a < b; });
    for (size_t i = 0; i < std::min(most, order.size()); ++i) chosen[order[i]] = true;
  }

  // From one corner to the next.
  size_t arcs_between(uint32_t from, uint32_t to) const {
    const size_t inside =
        nodes_before_[to] - nodes_before_[from + 1] + (from < to ? 0 : nodes_before_.back());
    return inside + 1;
  }

  double cost(const std::array<uint32_t, 4>& corners) const {
    constexpr double of_shape = 0.15, of_new_node = 0.3, of_bend = 0.5, of_doubling = 0.15;
    const double tiny = 1e-6 * outline_.length + 1e-300;
    double sides[4];
    double sum = 0;
    for (size_t i = 0; i < 4; ++i) sides[i] = outline_.between(corners[i], corners[(i + 1) % 4]) + tiny;
    const double across = std::log(sides[0] / sides[2]), along = std::log(sides[1] / sides[3]);
    sum += across * across + along * along;
    const double aspect = std::log((sides[0] + sides[2]) / (sides[1] + sides[3]));
    sum += of_shape * aspect * aspect;
    // A side has a segment for each of its arcs at least, and so has the one opposite: counted in doublings.
    size_t arcs[4];
    for (size_t i = 0; i < 4; ++i) arcs[i] = arcs_between(corners[i], corners[(i + 1) % 4]);
    sum += of_doubling * double(std::bit_width(std::max(arcs[0], arcs[2]) - 1) +
                                std::bit_width(std::max(arcs[1], arcs[3]) - 1));
    for (const uint32_t corner : corners) {
      const double missing = bends_[corner] / right_angle - 1;
      sum += of_bend * std::min(missing * missing, 4.0);
      if (!is_node_[mesh_.from(boundary_[corner])]) sum += of_new_node;
    }
    return sum;
  }

  const HalfEdgeMesh& mesh_;
  const std::vector<uint32_t>& boundary_;
  const std::vector<bool>& is_node_;
  Outline outline_;
  std::vector<size_t> nodes_before_;  // on the boundary
  std::vector<double> bends_;
  std::vector<uint32_t> candidates_;
};

}  // namespace

std::vector<std::array<uint32_t, 4>> choose_corners(const HalfEdgeMesh& mesh, const Cells& cells,
                                                    const Boundaries& boundaries,
                                                    std::vector<bool>& is_node) {
  std::vector<std::array<uint32_t, 4>> corners(boundaries.size());
  parallel_for(boundaries.size(), 1, [&](uint64_t begin, uint64_t end) {
    for (uint64_t cell = begin; cell < end; ++cell) {
      const std::vector<double> angles = boundary_angles(mesh, cells.of_face, boundaries[cell]);
      corners[cell] = CornerChoice(mesh, boundaries[cell], angles, is_node).run();
    }
  });
  for (size_t cell = 0; cell < boundaries.size(); ++cell)
    for (const uint32_t corner : corners[cell]) is_node[mesh.from(boundaries[cell][corner])] = true;
  return corners;
}

}  // namespace lodestone::base_complex
