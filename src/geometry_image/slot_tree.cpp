// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/slot_tree.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

namespace lodestone::geometry_image {
namespace {

class SlotTree {
 public:
  SlotTree(const std::vector<uint64_t>& needed, const std::vector<ChartBox>& boxes)
      : needed_(needed), boxes_(boxes), blocks_(needed.size()) {
    for (const ChartBox& box : boxes) centers_.push_back(box.center());
  }

  std::vector<Block> run(uint64_t slots) {
    std::vector<uint32_t> all(needed_.size());
    std::iota(all.begin(), all.end(), 0u);
    fill(0, slots, all);
    return std::move(blocks_);
  }

 private:
  // Shares slots from `first` on among charts that fit. Of no power of 2 the larger part comes first, which
  // is one; of a power of 2 both halves are.
  void fill(uint64_t first, uint64_t slots, std::span<uint32_t> charts) {
    if (charts.size() == 1) {
      blocks_[charts[0]] = {first, slots};
      return;
    }
    const uint64_t left = std::has_single_bit(slots) ? slots / 2 : std::bit_floor(slots);
    const size_t count = split(charts, left, slots - left);
    fill(first, left, charts.first(count));
    fill(first + left, slots - left, charts.subspan(count));
  }

  void sort_along(std::span<uint32_t> charts, glm::length_t axis) const {
    std::sort(charts.begin(), charts.end(), [&](uint32_t a, uint32_t b) {
      return std::tie(centers_[a][axis], a) < std::tie(centers_[b][axis], b);
    });
  }

  struct Split {
    size_t count = 0;  // on the left; 0: there is none
    glm::length_t axis = 0;
    double cost = std::numeric_limits<double>::infinity();
  };

  // Orders the charts so that the first ones go left, and returns how many.
  size_t split(std::span<uint32_t> charts, uint64_t left, uint64_t right) const {
    Split best;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      sort_along(charts, axis);
      const Split found = best_along(charts, axis, left, right);
      if (found.cost < best.cost) best = found;
    }
    if (best.count == 0) return split_tightly(charts, left);
    sort_along(charts, best.axis);
    return best.count;
  }

  // Of the places between charts where both sides get no more than they hold. A side of no power of 2 gets a
  // chart at least for each of the parts that it falls into.
  Split best_along(std::span<const uint32_t> charts, glm::length_t axis, uint64_t left,
                   uint64_t right) const {
    const size_t count = charts.size(), least_right = static_cast<size_t>(std::popcount(right));
    std::vector<double> cost_behind(count + 1, 0);
    ChartBox box;
    uint64_t slots = 0;
    for (size_t i = count; i-- > 0;) {
      slots += needed_[charts[i]];
      box = i + 1 == count ? boxes_[charts[i]] : around(box, boxes_[charts[i]]);
      cost_behind[i] = half_area(box) * double(slots);
    }
    const uint64_t all = slots;
    Split best;
    best.axis = axis;
    slots = 0;
    for (size_t i = 1; i + least_right <= count; ++i) {
      slots += needed_[charts[i - 1]];
      box = i == 1 ? boxes_[charts[0]] : around(box, boxes_[charts[i - 1]]);
      if (slots > left || all - slots > right) continue;
      const double cost = half_area(box) * double(slots) + cost_behind[i];
      if (best.count == 0 || cost < best.cost) {
        best.count = i;
        best.cost = cost;
      }
    }
    return best;
  }

  static ChartBox around(const ChartBox& a, const ChartBox& b) {
    return {glm::min(a.lo, b.lo), glm::max(a.hi, b.hi)};
  }
  static double half_area(const ChartBox& box) {
    const glm::dvec3 size = glm::dvec3(box.hi) - glm::dvec3(box.lo);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }

  // The largest first into the left side while they fit, those that lie first along the axis before others of
  // their size: powers of 2 fill it to the last slot, or all are in it but the smallest.
  size_t split_tightly(std::span<uint32_t> charts, uint64_t left) const {
    std::stable_sort(charts.begin(), charts.end(),
                     [&](uint32_t a, uint32_t b) { return needed_[a] > needed_[b]; });
    uint64_t room = left;
    return static_cast<size_t>(std::stable_partition(charts.begin(), charts.end(),
                                                     [&](uint32_t chart) {
                                                       if (needed_[chart] > room) return false;
                                                       room -= needed_[chart];
                                                       return true;
                                                     }) -
                               charts.begin());
  }

  const std::vector<uint64_t>& needed_;
  const std::vector<ChartBox>& boxes_;
  std::vector<glm::vec3> centers_;
  std::vector<Block> blocks_;
};

}  // namespace

std::vector<Block> slots_by_place(const std::vector<uint64_t>& needed, const std::vector<ChartBox>& boxes) {
  const uint64_t all = std::accumulate(needed.begin(), needed.end(), uint64_t(0));
  // The tree is of four to eight such parts.
  const uint64_t part = std::bit_floor(all) / 4;
  if (needed.empty() || *std::max_element(needed.begin(), needed.end()) > part / 2) return {};
  return SlotTree(needed, boxes).run((all + part - 1) / part * part);
}

}  // namespace lodestone::geometry_image
