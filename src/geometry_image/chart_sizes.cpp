// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_sizes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <queue>
#include <span>
#include <utility>

#include "lodestone/base/parallel.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::BaseComplex;
using base_complex::Cell;
using base_complex::Side;

constexpr uint32_t longest_side = 1u << 14;  // a chart's sides then fit the layout's Morton codes

// In quads.
struct Sides {
  uint32_t width = 1, height = 1;
};

Sides least_sides(const BaseComplex& complex, const Cell& cell) {
  const std::array<Side, 4> sides = sides_of(complex, cell);
  const auto arcs = [&](size_t s) { return sides[s].end - sides[s].first; };
  return {static_cast<uint32_t>(std::max(arcs(0), arcs(2))),
          static_cast<uint32_t>(std::max(arcs(1), arcs(3)))};
}

// Short sides may have any length: there are often many of them, and twice the quads would be far too many.
// Of long ones powers of 2 fill their MIP pyramids.
uint32_t next_longer(uint32_t side) {
  constexpr uint32_t any_to = 8;
  return side < any_to ? side + 1 : std::bit_ceil(side + 1);
}

uint64_t texels_of(const Sides& sides) {
  return uint64_t(sides.width + 1) * (sides.height + 1);
}

// What each arc needs: that its segments be short and that it be near to its samples, above all where it is
// firm or belongs to a chart that was too far from the surface.
class ArcNeeds {
 public:
  ArcNeeds(const BaseComplex& complex, const ArcErrors& errors, const Need& need)
      : complex_(complex),
        errors_(errors),
        share_(complex.arcs.size(), need.share),
        roughness_(complex.arcs.size(), need.flattest) {
    for (size_t a = 0; a < complex.arcs.size(); ++a)
      if (complex.arcs[a].firm) share_[a] = 1;
    for (size_t c = 0; c < need.found.size(); ++c) {
      if (need.found[c] == 0) continue;
      for (const base_complex::Passage& p : complex.cells[c].boundary) {
        share_[p.arc] = 1;
        if (!complex.arcs[p.arc].firm) roughness_[p.arc] = std::max(roughness_[p.arc], need.found[c]);
      }
    }
  }

  // Whatever a line does, it is hardly farther from its chord than half the chord's length.
  double of(uint32_t arc, uint32_t segments) const {
    constexpr double farthest = 0.5;
    const double spacing = complex_.arcs[arc].length / segments;
    return std::max(roughness_[arc] * spacing,
                    share_[arc] * std::min(errors_.error(arc, segments), farthest * spacing));
  }

  // Shares a side's quads among its passages, at least one each; returns the greatest need that is left.
  double share(const Cell& cell, const Side& side, uint32_t quads, std::span<uint32_t> segments) const {
    std::priority_queue<std::pair<double, size_t>> queue;  // need, and the first passage first
    const auto push = [&](size_t p) { queue.push({of(cell.boundary[p].arc, segments[p]), ~p}); };
    for (size_t p = side.first; p < side.end; ++p) {
      segments[p] = 1;
      push(p);
    }
    for (auto left = quads - static_cast<uint32_t>(side.end - side.first); left > 0; --left) {
      const size_t p = ~queue.top().second;
      queue.pop();
      ++segments[p];
      push(p);
    }
    return queue.top().first;
  }

 private:
  const BaseComplex& complex_;
  const ArcErrors& errors_;
  std::vector<double> share_;      // of each arc's error what counts
  std::vector<double> roughness_;  // of each arc, the expected error by the spacing
};

class Refiner {
 public:
  Refiner(const BaseComplex& complex, const std::vector<ChartProfile>& profiles, const ArcNeeds& arcs,
          const Need& need)
      : complex_(complex), profiles_(profiles), arcs_(arcs), need_(need), plans_(complex.cells.size()) {
    parallel_for(plans_.size(), 1, [&](uint64_t begin, uint64_t end) {
      for (uint64_t c = begin; c < end; ++c) {
        plans_[c].sides = least_sides(complex, complex.cells[c]);
        if (is_fixed(c)) plans_[c].sides = {need.fixed[c].width, need.fixed[c].height};
        plan(c);
      }
    });
    for (const Plan& p : plans_) texels_ += texels_of(p.sides);
  }

  std::vector<Sides> run(uint64_t budget) {
    std::priority_queue<std::pair<double, uint64_t>> queue;  // need, and the lowest chart first
    const auto push = [&](uint64_t c) { queue.push({plans_[c].need, ~c}); };
    for (uint64_t c = 0; c < plans_.size(); ++c)
      if (!is_fixed(c)) push(c);
    while (!queue.empty()) {
      const uint64_t c = ~queue.top().second;
      queue.pop();
      const uint64_t more = texels_of(plans_[c].next) - texels_of(plans_[c].sides);
      if (more == 0 || texels_ + more > budget) continue;
      texels_ += more;
      plans_[c].sides = plans_[c].next;
      plan(c);
      push(c);
    }
    std::vector<Sides> sides;
    for (const Plan& p : plans_) sides.push_back(p.sides);
    return sides;
  }

 private:
  struct Plan {
    Sides sides, next;
    double need = 0;
  };

  bool is_fixed(uint64_t chart) const { return !need_.fixed.empty() && need_.fixed[chart].width != 0; }

  double need_of(uint64_t chart, const Sides& quads) const {
    const double weight = need_.chart_weights.empty() ? 1.0 : need_.chart_weights[chart];
    const double found = need_.found.empty() ? 0.0 : need_.found[chart];
    const double spacing = profiles_[chart].spacing(quads.width, quads.height);
    double error = std::max(need_.flattest, found) * spacing;
    if (need_.flattest != need_.roughest) {
      error = std::clamp(need_.share * profiles_[chart].error(quads.width, quads.height), error,
                         std::max(std::max(need_.roughest, found) * spacing, error));
    }
    const Cell& cell = complex_.cells[chart];
    const std::array<Side, 4> sides = sides_of(complex_, cell);
    std::vector<uint32_t> segments(cell.boundary.size());
    for (size_t s = 0; s < 4; ++s) {
      error = std::max(error, arcs_.share(cell, sides[s], s % 2 == 0 ? quads.width : quads.height, segments));
    }
    return weight * error;
  }

  // Which side to make longer next: the one that helps more.
  void plan(uint64_t chart) {
    Plan& p = plans_[chart];
    p.need = need_of(chart, p.sides);
    p.next = p.sides;
    const Sides wider = {next_longer(p.sides.width), p.sides.height},
                taller = {p.sides.width, next_longer(p.sides.height)};
    const bool can_widen = wider.width <= longest_side, can_heighten = taller.height <= longest_side;
    if (!can_widen && !can_heighten) return;
    if (can_widen != can_heighten) {
      p.next = can_widen ? wider : taller;
      return;
    }
    // Of two that help as good as alike the one that makes quads less long; nor may they become very long.
    constexpr double clearly = 0.9, longest = 8;
    const double across = profiles_[chart].width_spacing(p.sides.width),
                 along = profiles_[chart].height_spacing(p.sides.height);
    // One more quad shows little of what a side is good for; twice as many do.
    const double of_wider = need_of(chart, {2 * p.sides.width, p.sides.height}),
                 of_taller = need_of(chart, {p.sides.width, 2 * p.sides.height});
    const bool widen = across > longest * along         ? true
                       : along > longest * across       ? false
                       : of_wider < clearly * of_taller ? true
                       : of_taller < clearly * of_wider ? false
                                                        : across >= along;
    p.next = widen ? wider : taller;
  }

  const BaseComplex& complex_;
  const std::vector<ChartProfile>& profiles_;
  const ArcNeeds& arcs_;
  const Need& need_;
  std::vector<Plan> plans_;
  uint64_t texels_ = 0;
};

}  // namespace

uint64_t least_texels(const BaseComplex& complex) {
  uint64_t texels = 0;
  for (const Cell& cell : complex.cells) texels += texels_of(least_sides(complex, cell));
  return texels;
}

glm::dvec2 extent_of(const BaseComplex& complex, const Cell& cell) {
  const std::array<Side, 4> sides = sides_of(complex, cell);
  const double across = sides[0].length + sides[2].length, along = sides[1].length + sides[3].length;
  constexpr double longest = 64;  // times as long as wide; what has no width at all must get some
  const double aspect = std::clamp(across > 0 && along > 0 ? across / along : 1.0, 1 / longest, longest);
  // Of a bent or ragged cell the area says more than the lengths.
  return {std::sqrt(cell.area * aspect), std::sqrt(cell.area / aspect)};
}

std::vector<ChartSize> choose_sizes(const BaseComplex& complex, const std::vector<ChartProfile>& profiles,
                                    const ArcErrors& arc_errors, const Need& need, uint64_t budget) {
  const ArcNeeds arcs(complex, arc_errors, need);
  const std::vector<Sides> quads = Refiner(complex, profiles, arcs, need).run(budget);
  std::vector<ChartSize> sizes(complex.cells.size());
  for (size_t c = 0; c < sizes.size(); ++c) {
    const Cell& cell = complex.cells[c];
    sizes[c].width = quads[c].width;
    sizes[c].height = quads[c].height;
    sizes[c].segments.resize(cell.boundary.size());
    const std::array<Side, 4> sides = sides_of(complex, cell);
    for (size_t s = 0; s < 4; ++s)
      arcs.share(cell, sides[s], s % 2 == 0 ? sizes[c].width : sizes[c].height, sizes[c].segments);
  }
  return sizes;
}

std::vector<uint32_t> arc_segments(const BaseComplex& complex, const std::vector<ChartSize>& sizes) {
  std::vector<uint32_t> segments(complex.arcs.size(), base_complex::none);
  for (size_t c = 0; c < complex.cells.size(); ++c) {
    for (size_t p = 0; p < complex.cells[c].boundary.size(); ++p) {
      uint32_t& least = segments[complex.cells[c].boundary[p].arc];
      least = std::min(least, sizes[c].segments[p]);
    }
  }
  return segments;
}

}  // namespace lodestone::geometry_image
