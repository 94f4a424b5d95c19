// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_sizes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <queue>

#include "lodestone/base/parallel.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::BaseComplex;
using base_complex::Cell;
using base_complex::Side;

constexpr uint32_t most_power = 14;  // a chart's sides then fit the layout's Morton codes

ChartPowers least_powers(const BaseComplex& complex, const Cell& cell) {
  const std::array<Side, 4> sides = sides_of(complex, cell);
  const auto power = [](size_t count) { return static_cast<uint32_t>(std::bit_width(count - 1)); };
  const auto arcs = [&](size_t s) { return sides[s].end - sides[s].first; };
  return {power(std::max(arcs(0), arcs(2))), power(std::max(arcs(1), arcs(3)))};
}

// Shares a side's quads among its passages by length, each at least one.
void share(const BaseComplex& complex, const Cell& cell, const Side& side, uint32_t quads,
           std::vector<uint32_t>& segments) {
  uint32_t left = quads;
  double length_left = side.length;
  for (size_t p = side.first; p < side.end; ++p) {
    const double length = complex.arcs[cell.boundary[p].arc].length;
    const auto others = static_cast<uint32_t>(side.end - p - 1);
    const double wanted = length_left > 0 ? left * length / length_left : double(left) / (others + 1);
    segments[p] =
        others == 0 ? left : std::clamp(static_cast<uint32_t>(std::lround(wanted)), 1u, left - others);
    left -= segments[p];
    length_left -= length;
  }
}

uint64_t texels_of(ChartPowers powers) {
  return ((uint64_t(1) << powers.width) + 1) * ((uint64_t(1) << powers.height) + 1);
}

class Refiner {
 public:
  Refiner(const BaseComplex& complex, const std::vector<ChartProfile>& profiles, const Need& need)
      : profiles_(profiles), need_(need), plans_(complex.cells.size()) {
    parallel_for(plans_.size(), 1, [&](uint64_t begin, uint64_t end) {
      for (uint64_t c = begin; c < end; ++c) {
        plans_[c].powers = least_powers(complex, complex.cells[c]);
        plan(c);
      }
    });
    for (const Plan& p : plans_) texels_ += texels_of(p.powers);
  }

  std::vector<ChartPowers> run(uint64_t budget) {
    std::priority_queue<std::pair<double, uint64_t>> queue;  // need, and the lowest chart first
    const auto push = [&](uint64_t c) { queue.push({plans_[c].need, ~c}); };
    for (uint64_t c = 0; c < plans_.size(); ++c) push(c);
    while (!queue.empty()) {
      const uint64_t c = ~queue.top().second;
      queue.pop();
      const uint64_t more = texels_of(plans_[c].next) - texels_of(plans_[c].powers);
      if (more == 0 || texels_ + more > budget) continue;
      texels_ += more;
      plans_[c].powers = plans_[c].next;
      plan(c);
      push(c);
    }
    std::vector<ChartPowers> powers;
    for (const Plan& p : plans_) powers.push_back(p.powers);
    return powers;
  }

 private:
  struct Plan {
    ChartPowers powers, next;
    double need = 0;
  };

  double need_of(uint64_t chart, ChartPowers powers) const {
    const double weight = need_.chart_weights.empty() ? 1.0 : need_.chart_weights[chart];
    const double spacing = profiles_[chart].spacing(powers);
    if (need_.flattest == need_.roughest) return weight * spacing;
    return weight *
           std::clamp(profiles_[chart].error(powers), need_.flattest * spacing, need_.roughest * spacing);
  }

  // Which side to double next: the one that helps more.
  void plan(uint64_t chart) {
    Plan& p = plans_[chart];
    p.need = need_of(chart, p.powers);
    p.next = p.powers;
    const ChartPowers wider = {p.powers.width + 1, p.powers.height},
                      taller = {p.powers.width, p.powers.height + 1};
    const bool can_widen = wider.width <= most_power, can_heighten = taller.height <= most_power;
    if (!can_widen && !can_heighten) return;
    if (can_widen != can_heighten) {
      p.next = can_widen ? wider : taller;
      return;
    }
    // Of two that help as good as alike the one that makes quads less long; nor may they become very long.
    constexpr double clearly = 0.9, longest = 8;
    const double across = profiles_[chart].width_spacing(p.powers),
                 along = profiles_[chart].height_spacing(p.powers);
    const double of_wider = need_of(chart, wider), of_taller = need_of(chart, taller);
    const bool widen = across > longest * along         ? true
                       : along > longest * across       ? false
                       : of_wider < clearly * of_taller ? true
                       : of_taller < clearly * of_wider ? false
                                                        : across >= along;
    p.next = widen ? wider : taller;
  }

  const std::vector<ChartProfile>& profiles_;
  const Need& need_;
  std::vector<Plan> plans_;
  uint64_t texels_ = 0;
};

}  // namespace

glm::dvec2 extent_of(const BaseComplex& complex, const Cell& cell) {
  const std::array<Side, 4> sides = sides_of(complex, cell);
  const double across = sides[0].length + sides[2].length, along = sides[1].length + sides[3].length;
  constexpr double longest = 64;  // times as long as wide; what has no width at all must get some
  const double aspect = std::clamp(across > 0 && along > 0 ? across / along : 1.0, 1 / longest, longest);
  // Of a bent or ragged cell the area says more than the lengths.
  return {std::sqrt(cell.area * aspect), std::sqrt(cell.area / aspect)};
}

std::vector<ChartSize> choose_sizes(const BaseComplex& complex, const std::vector<ChartProfile>& profiles,
                                    const Need& need, uint64_t budget) {
  const std::vector<ChartPowers> powers = Refiner(complex, profiles, need).run(budget);
  std::vector<ChartSize> sizes(complex.cells.size());
  for (size_t c = 0; c < sizes.size(); ++c) {
    const Cell& cell = complex.cells[c];
    sizes[c].powers = powers[c];
    sizes[c].segments.resize(cell.boundary.size());
    const std::array<Side, 4> sides = sides_of(complex, cell);
    for (size_t s = 0; s < 4; ++s)
      share(complex, cell, sides[s], s % 2 == 0 ? sizes[c].width() : sizes[c].height(), sizes[c].segments);
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
