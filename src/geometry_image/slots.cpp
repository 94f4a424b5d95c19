// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/slots.h"

#include <algorithm>
#include <array>
#include <bit>

#include "lodestone/base/error.h"
#include "lodestone/base/parallel.h"
#include "lodestone/geometry_image/quad_order.h"
#include "lodestone/geometry_image/slot_tree.h"

namespace lodestone::geometry_image {
namespace {

constexpr uint64_t slot_limit = uint64_t(1) << (2 * layout::max_depth);

uint64_t slots_of(const std::vector<layout::ChartRecord>& charts) {
  uint64_t slots = 0;
  for (const layout::ChartRecord& chart : charts) slots += QuadOrder::block_slots(chart);
  return slots;
}

// Mapped charts are of many sizes and lie anywhere. Returns the number of slots; 0 where charts have to be
// placed by size.
uint64_t assign_by_place(std::vector<layout::ChartRecord>& charts, const std::vector<ChartBox>& boxes) {
  const bool mapped = std::any_of(charts.begin(), charts.end(), [](const layout::ChartRecord& chart) {
    return chart.kind == layout::chart_mapped;
  });
  if (!mapped || boxes.empty()) return 0;
  std::vector<uint64_t> needed;
  for (const layout::ChartRecord& chart : charts) needed.push_back(QuadOrder::block_slots(chart));
  const std::vector<Block> blocks = slots_by_place(needed, boxes);
  uint64_t slots = 0;
  for (size_t i = 0; i < blocks.size(); ++i) {
    charts[i].first_slot = static_cast<uint32_t>(blocks[i].first_slot);
    charts[i].slot_count = static_cast<uint32_t>(blocks[i].slots);
    slots += blocks[i].slots;
  }
  return slots;
}

}  // namespace

uint64_t assign_slots(std::vector<layout::ChartRecord>& charts, const std::vector<ChartBox>& boxes,
                      ChartOrder order, const std::string& subject) {
  const uint64_t slots = slots_of(charts);
  if (slots > slot_limit) {
    fail_input(subject,
               "needs a hierarchy of {} leaf slots for {} charts, and {} is the most; draw fewer meshes, or "
               "simplify them",
               slots, charts.size(), slot_limit);
  }
  if (const uint64_t by_place = assign_by_place(charts, boxes); by_place != 0) return by_place;
  // Nodes of 4^k slots, by k: charts that fill one, and charts of which two do.
  std::array<std::vector<ChartCenter>, layout::max_depth + 1> whole, halves;
  for (uint32_t i = 0; i < charts.size(); ++i) {
    const auto bits = static_cast<size_t>(std::bit_width(QuadOrder::block_slots(charts[i])) - 1);
    (bits % 2 == 0 ? whole : halves)[(bits + 1) / 2].push_back(
        {boxes.empty() ? glm::vec3(0) : boxes[i].center(), i});
  }
  const auto pairs = static_cast<uint32_t>(charts.size());  // numbers from here on are pairs, not charts
  uint64_t next = 0;
  const auto place = [&](uint32_t chart, uint64_t block) {
    charts[chart].first_slot = static_cast<uint32_t>(next);
    charts[chart].slot_count = static_cast<uint32_t>(block);
    next += block;
  };
  // Half a node of the size before. It starts at a multiple of its own size behind an even number of nodes of
  // this size; these then begin with a whole node above them.
  uint32_t left_over = layout::no_index;
  for (size_t power = whole.size(); power-- > 0;) {
    const uint64_t node = uint64_t(1) << (2 * power);
    std::vector<ChartCenter>& nodes = whole[power];
    std::vector<ChartCenter>& half = halves[power];
    order_charts(half, 0, node / 2, order);
    for (uint32_t i = 0; i + 1 < half.size(); i += 2) {
      nodes.push_back({0.5f * half[i].center + 0.5f * half[i + 1].center, pairs + i});
    }
    order_charts(nodes, next, node, order);
    const size_t even = nodes.size() / 2 * 2;
    for (size_t i = 0; i <= nodes.size(); ++i) {
      if (i == even && left_over != layout::no_index) place(left_over, 2 * node);
      if (i == nodes.size()) break;
      if (const uint32_t chart = nodes[i].chart; chart < pairs) {
        place(chart, node);
      } else {
        place(half[chart - pairs].chart, node / 2);
        place(half[chart - pairs + 1].chart, node / 2);
      }
    }
    left_over = half.size() % 2 != 0 ? half.back().chart : layout::no_index;
  }
  return slots;
}

uint32_t tree_depth(uint64_t slots) {
  uint32_t depth = 1;
  while ((uint64_t(1) << (2 * depth)) < slots) ++depth;
  return depth;
}

glm::uvec2 leaf_entry(const layout::ChartRecord& chart, uint32_t slot) {
  constexpr glm::uvec2 empty{layout::empty_slot, 0};
  const QuadOrder::Quad quad = QuadOrder(chart).quad(slot);
  if (!quad.exists) return empty;
  // The last quad of an exact chart would have a corner that is no texel.
  if (chart.kind == layout::chart_exact && quad.x == 1 && quad.y == 1) return empty;
  return {chart.first_texel + quad.y * chart.width + quad.x, chart.width};
}

std::vector<glm::uvec2> make_leaf_map(const std::vector<layout::ChartRecord>& charts, uint64_t slots) {
  constexpr uint64_t charts_a_task = 1u << 10, slots_a_task = 1u << 14;
  std::vector<glm::uvec2> map(slots);
  const auto fill = [&](const layout::ChartRecord& chart, uint64_t begin, uint64_t end) {
    for (auto slot = static_cast<uint32_t>(begin); slot < end; ++slot) {
      map[size_t(chart.first_slot) + slot] = leaf_entry(chart, slot);
    }
  };
  parallel_for(charts.size(), charts_a_task, [&](uint64_t first, uint64_t last) {
    for (uint64_t i = first; i < last; ++i) {
      const layout::ChartRecord& chart = charts[i];
      if (chart.slot_count <= slots_a_task) {
        fill(chart, 0, chart.slot_count);
      } else {
        parallel_for(chart.slot_count, slots_a_task,
                     [&](uint64_t begin, uint64_t end) { fill(chart, begin, end); });
      }
    }
  });
  return map;
}

}  // namespace lodestone::geometry_image
