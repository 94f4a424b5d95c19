// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/slot_tree.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <span>
#include <tuple>

namespace lodestone::geometry_image {
namespace {

class SlotTree {
 public:
  SlotTree(const std::vector<uint64_t>& needed, const std::vector<glm::vec3>& centers)
      : needed_(needed), centers_(centers), blocks_(needed.size()) {}

  std::vector<Block> run(uint64_t slots) {
    std::vector<uint32_t> all(needed_.size());
    std::iota(all.begin(), all.end(), 0u);
    fill(0, slots, all);
    return std::move(blocks_);
  }

 private:
  uint64_t sum(std::span<const uint32_t> charts) const {
    uint64_t slots = 0;
    for (const uint32_t chart : charts) slots += needed_[chart];
    return slots;
  }

  // Shares slots from `first` on among charts that fit. Of no power of 2 the larger part comes first, which
  // is one; of a power of 2 both halves are.
  void fill(uint64_t first, uint64_t slots, std::span<uint32_t> charts) {
    if (charts.size() == 1) {
      blocks_[charts[0]] = {first, slots};
      return;
    }
    const uint64_t left = std::has_single_bit(slots) ? slots / 2 : std::bit_floor(slots);
    sort_along_longest_axis(charts);
    const size_t count = split(charts, left, slots - left);
    fill(first, left, charts.first(count));
    fill(first + left, slots - left, charts.subspan(count));
  }

  void sort_along_longest_axis(std::span<uint32_t> charts) const {
    glm::vec3 lo = centers_[charts[0]], hi = lo;
    for (const uint32_t chart : charts) {
      lo = glm::min(lo, centers_[chart]);
      hi = glm::max(hi, centers_[chart]);
    }
    const glm::vec3 size = hi - lo;
    const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::sort(charts.begin(), charts.end(), [&](uint32_t a, uint32_t b) {
      return std::tie(centers_[a][axis], a) < std::tie(centers_[b][axis], b);
    });
  }

  // How many of the charts go left, each side getting its share as far as it can; reorders them where no
  // place between them will do. A side of no power of 2 gets charts for each of the parts that it falls into.
  size_t split(std::span<uint32_t> charts, uint64_t left, uint64_t right) const {
    const uint64_t all = sum(charts);
    const size_t least_right = static_cast<size_t>(std::popcount(right));
    const double wanted = double(all) * double(left) / double(left + right);
    size_t best = 0;
    double least = 0;
    uint64_t before = 0;
    for (size_t i = 1; i + least_right <= charts.size(); ++i) {
      before += needed_[charts[i - 1]];
      if (before > left || all - before > right) continue;
      const double off = std::abs(double(before) - wanted);
      if (best == 0 || off < least) {
        best = i;
        least = off;
      }
    }
    return best != 0 ? best : split_tightly(charts, left);
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
  const std::vector<glm::vec3>& centers_;
  std::vector<Block> blocks_;
};

}  // namespace

std::vector<Block> slots_by_place(const std::vector<uint64_t>& needed,
                                  const std::vector<glm::vec3>& centers) {
  const uint64_t all = std::accumulate(needed.begin(), needed.end(), uint64_t(0));
  // The tree is of four to eight such parts.
  const uint64_t part = std::bit_floor(all) / 4;
  if (needed.empty() || *std::max_element(needed.begin(), needed.end()) > part / 2) return {};
  return SlotTree(needed, centers).run((all + part - 1) / part * part);
}

}  // namespace lodestone::geometry_image
