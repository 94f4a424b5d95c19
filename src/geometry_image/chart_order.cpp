// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_order.h"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>
#include <vector>

#include "lodestone/base/parallel.h"

namespace lodestone::geometry_image {
namespace {

struct Box {
  glm::vec3 lo, hi;
};

Box bounds(std::span<const ChartCenter> run) {
  Box box{run[0].center, run[0].center};
  for (const ChartCenter& chart : run) {
    box.lo = glm::min(box.lo, chart.center);
    box.hi = glm::max(box.hi, chart.center);
  }
  return box;
}

glm::length_t longest_axis(const Box& box) {
  const glm::vec3 size = box.hi - box.lo;
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

void order_by_median(std::span<ChartCenter> run, uint64_t first_slot, uint64_t block) {
  constexpr size_t worth_a_task = 1u << 14;
  if (run.size() < 2) return;
  const uint64_t left = aligned_split(first_slot, block, run.size());
  const glm::length_t axis = longest_axis(bounds(run));
  std::nth_element(run.begin(), run.begin() + static_cast<std::ptrdiff_t>(left), run.end(),
                   [axis](const ChartCenter& a, const ChartCenter& b) {
                     return std::tie(a.center[axis], a.chart) < std::tie(b.center[axis], b.chart);
                   });
  const auto order_side = [&](bool upper) {
    order_by_median(upper ? run.subspan(left) : run.first(left),
                    upper ? first_slot + left * block : first_slot, block);
  };
  if (run.size() >= worth_a_task) {
    parallel_for(2, 1, [&](uint64_t side, uint64_t) { order_side(side == 1); });
  } else {
    order_side(false);
    order_side(true);
  }
}

void order_by_hilbert(std::span<ChartCenter> run) {
  constexpr uint32_t bits = 20;
  constexpr float cells = float(1u << bits);
  const Box box = bounds(run);
  const glm::vec3 size = box.hi - box.lo;
  const float side = std::max({size.x, size.y, size.z});
  std::vector<std::pair<uint64_t, ChartCenter>> keyed(run.size());
  std::transform(run.begin(), run.end(), keyed.begin(), [&](const ChartCenter& chart) {
    const glm::vec3 unit = side > 0 ? (chart.center - box.lo) / side : glm::vec3(0);
    const glm::uvec3 cell = glm::min(glm::uvec3(unit * cells), glm::uvec3((1u << bits) - 1));
    return std::pair(hilbert_index(cell, bits), chart);
  });
  std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first, a.second.chart) < std::tie(b.first, b.second.chart);
  });
  std::transform(keyed.begin(), keyed.end(), run.begin(), [](const auto& key) { return key.second; });
}

}  // namespace

void order_charts(std::span<ChartCenter> run, uint64_t first_slot, uint64_t block, ChartOrder order) {
  if (run.empty()) return;
  if (order == ChartOrder::median) {
    order_by_median(run, first_slot, block);
  } else {
    order_by_hilbert(run);
  }
}

uint64_t aligned_split(uint64_t first_slot, uint64_t block, uint64_t count) {
  const uint64_t last = first_slot + (count - 1) * block;
  // The highest bit in which the first and the last block differ tells the largest subtree that holds no more
  // than one of them; every slot at which such a subtree starts is a multiple of its size. Two blocks that
  // share a node are parted where one of them ends.
  const auto level = static_cast<uint32_t>(std::bit_width(first_slot ^ last) - 1) / 2;
  const uint64_t subtree = std::max(uint64_t(1) << (2 * level), block);
  const uint64_t lowest = (first_slot / subtree + 1) * subtree, highest = last / subtree * subtree;
  const uint64_t middle = first_slot + count / 2 * block;
  const uint64_t nearest = (middle + subtree / 2) / subtree * subtree;
  return (std::clamp(nearest, lowest, highest) - first_slot) / block;
}

// John Skilling, "Programming the Hilbert curve", AIP Conference Proceedings 707 (2004): undo the rotations
// from the highest bit down, then the Gray code, and interleave the bits of the axes.
uint64_t hilbert_index(glm::uvec3 cell, uint32_t bits) {
  for (uint32_t bit = 1u << (bits - 1); bit > 1; bit >>= 1) {
    const uint32_t below = bit - 1;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      if ((cell[axis] & bit) != 0) {
        cell.x ^= below;
      } else {
        const uint32_t exchanged = (cell.x ^ cell[axis]) & below;
        cell.x ^= exchanged;
        cell[axis] ^= exchanged;
      }
    }
  }
  cell.y ^= cell.x;
  cell.z ^= cell.y;
  uint32_t flips = 0;
  for (uint32_t bit = 1u << (bits - 1); bit > 1; bit >>= 1) {
    if ((cell.z & bit) != 0) flips ^= bit - 1;
  }
  cell ^= glm::uvec3(flips);
  uint64_t index = 0;
  for (uint32_t bit = bits; bit-- > 0;) {
    for (glm::length_t axis = 0; axis < 3; ++axis) index = (index << 1) | ((cell[axis] >> bit) & 1);
  }
  return index;
}

}  // namespace lodestone::geometry_image
