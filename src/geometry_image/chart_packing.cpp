// SPDX-License-Identifier: MIT
// Best fit on a skyline (E. K. Burke, G. Kendall, G. Whitwell, A New Placement Heuristic for the Orthogonal
// Stock-Cutting Problem, 2004): always the lowest gap, and of what fits it the first in a given order.
// Several orders and widths are tried; there are few sizes, so that is cheap.
#include "lodestone/geometry_image/chart_packing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace lodestone::geometry_image {
namespace {

// Charts of one size, the gutter to the right and below included.
struct SizeClass {
  uint32_t width = 0, height = 0;
  std::vector<uint32_t> charts;
};

// How high a strip of some width is filled, from left to right without gaps.
class Skyline {
 public:
  explicit Skyline(uint32_t width) { insert(0, {width, 0}); }

  struct Gap {
    uint32_t x, y, width;
  };
  // The leftmost of the lowest.
  Gap lowest() const {
    const auto [y, x] = *by_height_.begin();
    return {x, y, steps_.at(x).width};
  }
  // Fills the left end of the gap.
  void put(const Gap& gap, uint32_t width, uint32_t height) {
    erase(gap.x);
    if (width < gap.width) insert(gap.x + width, {gap.width - width, gap.y});
    insert(gap.x, {width, gap.y + height});
  }
  // Gives the gap up to the lower one of what stands beside it. It must not be all there is.
  void close(const Gap& gap) {
    const auto here = steps_.find(gap.x);
    const auto right = std::next(here);
    uint32_t y = 0;
    if (here == steps_.begin()) {
      y = right->second.y;
    } else {
      y = std::prev(here)->second.y;
      if (right != steps_.end()) y = std::min(y, right->second.y);
    }
    erase(gap.x);
    insert(gap.x, {gap.width, y});
  }

 private:
  struct Step {
    uint32_t width, y;
  };
  void erase(uint32_t x) {
    const auto step = steps_.find(x);
    by_height_.erase({step->second.y, x});
    steps_.erase(step);
  }
  // Joins it to neighbours of its height.
  void insert(uint32_t x, Step step) {
    const auto right = steps_.find(x + step.width);
    if (right != steps_.end() && right->second.y == step.y) {
      step.width += right->second.width;
      erase(right->first);
    }
    const auto after = steps_.lower_bound(x);
    if (after != steps_.begin() && std::prev(after)->second.y == step.y) {
      const auto left = std::prev(after);
      step.width += left->second.width;
      x = left->first;
      erase(x);
    }
    steps_[x] = step;
    by_height_.insert({step.y, x});
  }

  std::map<uint32_t, Step> steps_;                     // by where they begin
  std::set<std::pair<uint32_t, uint32_t>> by_height_;  // y, x
};

// Charts in a strip that is `width` wide, sizes tried in the order in which they are given.
ChartPacking pack_strip(const std::vector<SizeClass>& classes, size_t charts, uint32_t width,
                        uint32_t gutter) {
  ChartPacking packing;
  packing.places.resize(charts);
  std::vector<std::pair<const SizeClass*, size_t>> left;  // and how many of them are placed
  for (const SizeClass& c : classes) left.emplace_back(&c, 0);
  Skyline skyline(width);
  while (!left.empty()) {
    const Skyline::Gap gap = skyline.lowest();
    const auto fits =
        std::find_if(left.begin(), left.end(), [&](const auto& c) { return c.first->width <= gap.width; });
    if (fits == left.end()) {
      skyline.close(gap);
      continue;
    }
    const SizeClass& size = *fits->first;
    packing.places[size.charts[fits->second]] = {gap.x, gap.y};
    packing.width = std::max(packing.width, gap.x + size.width - gutter);
    packing.height = std::max(packing.height, gap.y + size.height - gutter);
    skyline.put(gap, size.width, size.height);
    if (++fits->second == size.charts.size()) left.erase(fits);
  }
  return packing;
}

std::vector<SizeClass> classify(const std::vector<glm::uvec2>& sizes, uint32_t gutter) {
  std::map<std::pair<uint32_t, uint32_t>, SizeClass> by_size;
  for (uint32_t i = 0; i < sizes.size(); ++i) {
    SizeClass& c = by_size[{sizes[i].x, sizes[i].y}];
    c.width = sizes[i].x + gutter;
    c.height = sizes[i].y + gutter;
    c.charts.push_back(i);
  }
  std::vector<SizeClass> classes;
  for (auto& [size, c] : by_size) classes.push_back(std::move(c));
  return classes;
}

// Widths from that of a square without waste, or of a picture as high as the highest chart, upwards.
std::vector<uint32_t> widths_to_try(const std::vector<SizeClass>& classes, size_t charts) {
  // As many as take a second or so: to place a chart takes as long as to look at a few hundred sizes.
  constexpr size_t work = 1u << 28, of_placing = 256, fewest = 3, most = 32;
  constexpr double widest = 1.25;
  uint32_t least = 0, highest = 0;
  double area = 0;
  for (const SizeClass& c : classes) {
    least = std::max(least, c.width);
    highest = std::max(highest, c.height);
    area += double(c.width) * c.height * double(c.charts.size());
  }
  const double tight = std::max(double(least), std::ceil(area / std::max(std::sqrt(area), double(highest))));
  const size_t count = std::clamp(work / (charts * (of_placing + classes.size())), fewest, most);
  std::vector<uint32_t> widths;
  for (size_t i = 0; i < count; ++i) {
    const auto width =
        static_cast<uint32_t>(std::ceil(tight * (1 + (widest - 1) * double(i) / double(count - 1))));
    if (widths.empty() || width != widths.back()) widths.push_back(width);
  }
  return widths;
}

}  // namespace

ChartPacking pack_charts(const std::vector<glm::uvec2>& sizes, uint32_t gutter) {
  ChartPacking best;
  if (sizes.empty()) return best;
  std::vector<SizeClass> classes = classify(sizes, gutter);
  const std::vector<uint32_t> widths = widths_to_try(classes, sizes.size());
  const auto cost = [](const ChartPacking& p) {
    return std::pair(std::max(p.width, p.height), uint64_t(p.width) * p.height);
  };
  using Order = bool (*)(const SizeClass&, const SizeClass&);
  constexpr Order highest_first = [](const SizeClass& a, const SizeClass& b) {
    return a.height != b.height ? a.height > b.height : a.width > b.width;
  };
  constexpr Order widest_first = [](const SizeClass& a, const SizeClass& b) {
    return a.width != b.width ? a.width > b.width : a.height > b.height;
  };
  for (const Order order : {highest_first, widest_first}) {
    std::sort(classes.begin(), classes.end(), order);
    for (const uint32_t width : widths) {
      ChartPacking packing = pack_strip(classes, sizes.size(), width, gutter);
      if (best.places.empty() || cost(packing) < cost(best)) best = std::move(packing);
    }
    if (classes.size() == 1) break;
  }
  const double texels =
      std::accumulate(sizes.begin(), sizes.end(), 0.0,
                      [](double sum, const glm::uvec2& size) { return sum + double(size.x) * size.y; });
  best.filled = texels / (double(best.width) * best.height);
  return best;
}

}  // namespace lodestone::geometry_image
