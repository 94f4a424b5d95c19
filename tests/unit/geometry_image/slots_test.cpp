// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/slots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <set>

#include "expect_error.h"
#include "lodestone/geometry_image/quad_order.h"

namespace lodestone::geometry_image {
namespace {

using test::expect_error;

layout::ChartRecord grid_chart(uint32_t quads_x, uint32_t quads_y) {
  return {0, quads_x + 1, quads_y + 1, layout::chart_grid, 0, 0, 0, 0};
}

TEST(QuadOrder, GivesEveryQuadASlotOfItsOwn) {
  for (const uint32_t width : {1u, 2u, 3u, 5u, 8u, 17u, 64u, 100u}) {
    for (const uint32_t height : {1u, 2u, 4u, 7u, 33u, 64u}) {
      const layout::ChartRecord chart = grid_chart(width, height);
      const QuadOrder order(chart);
      const uint64_t slots = QuadOrder::block_slots(chart);
      std::vector<bool> taken(slots, false);
      for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
          const uint32_t slot = order.slot(x, y);
          ASSERT_LT(slot, slots);
          ASSERT_FALSE(taken[slot]);
          taken[slot] = true;
          const QuadOrder::Quad quad = order.quad(slot);
          ASSERT_TRUE(quad.exists);
          ASSERT_EQ(glm::uvec2(quad.x, quad.y), glm::uvec2(x, y));
        }
      }
      for (uint32_t slot = 0; slot < slots; ++slot) ASSERT_EQ(order.quad(slot).exists, taken[slot]);
    }
  }
}

TEST(QuadOrder, IsMortonOrderOnASquare) {
  const QuadOrder order(grid_chart(4, 4));
  const uint32_t expected[4][4] = {{0, 1, 4, 5}, {2, 3, 6, 7}, {8, 9, 12, 13}, {10, 11, 14, 15}};  // [y][x]
  for (uint32_t y = 0; y < 4; ++y) {
    for (uint32_t x = 0; x < 4; ++x) EXPECT_EQ(order.slot(x, y), expected[y][x]);
  }
}

TEST(QuadOrder, PutsTheSquaresOfALongChartInARow) {
  EXPECT_EQ(QuadOrder(grid_chart(8, 2)).slot(5, 1), 4 * 2 + 2 + 1u);
  EXPECT_EQ(QuadOrder(grid_chart(2, 8)).slot(1, 5), 4 * 2 + 2 + 1u);
  EXPECT_EQ(QuadOrder(grid_chart(16, 1)).slot(11, 0), 11u);
}

// Whatever the shape, 4^j slots that start at a multiple of 4^j are a rectangle, and a square within the
// squares that the block is a row of.
TEST(QuadOrder, MakesEveryNodeARectangle) {
  for (uint32_t a = 0; a < 7; ++a) {
    for (uint32_t b = 0; b < 7; ++b) {
      const QuadOrder order(grid_chart(1u << a, 1u << b));
      const uint32_t slots = 1u << (a + b), square = 1u << (2 * std::min(a, b));
      for (uint32_t node = 1; node <= slots; node *= 4) {
        for (uint32_t first = 0; first < slots; first += node) {
          glm::uvec2 lo(~0u), hi(0);
          for (uint32_t slot = first; slot < first + node; ++slot) {
            const QuadOrder::Quad quad = order.quad(slot);
            lo = glm::min(lo, glm::uvec2(quad.x, quad.y));
            hi = glm::max(hi, glm::uvec2(quad.x, quad.y) + 1u);
          }
          ASSERT_EQ((hi.x - lo.x) * (hi.y - lo.y), node);
          ASSERT_TRUE(node > square || hi.x - lo.x == hi.y - lo.y);
        }
      }
    }
  }
}

TEST(QuadOrder, WastesNothingOnSidesOfAPowerOf2) {
  for (uint32_t a = 0; a < 12; ++a) {
    for (uint32_t b = 0; b < 12; ++b) {
      EXPECT_EQ(QuadOrder::block_slots(grid_chart(1u << a, 1u << b)), uint64_t(1) << (a + b));
    }
  }
}

TEST(QuadOrder, NeedsLessThanFourSlotsAQuad) {
  for (uint32_t width = 1; width < 70; ++width) {
    for (uint32_t height = 1; height < 70; ++height) {
      EXPECT_LT(QuadOrder::block_slots(grid_chart(width, height)), uint64_t(4) * width * height);
    }
  }
}

TEST(QuadOrder, WastesLittleOnThinCharts) {
  for (const auto& [width, height] : {std::pair(1000u, 3u), std::pair(3u, 1000u), std::pair(5000u, 1u)}) {
    EXPECT_LT(double(QuadOrder::block_slots(grid_chart(width, height))), 1.7 * width * height);
  }
  EXPECT_EQ(QuadOrder::block_slots(grid_chart(1000, 3)), 4096u);  // 1.4 slots a quad
  EXPECT_EQ(QuadOrder::block_slots(grid_chart(4095, 4095)), uint64_t(1) << 24);
  EXPECT_EQ(QuadOrder::block_slots(grid_chart(1, 1)), 1u);
}

layout::ChartRecord mapped_chart(uint32_t width, uint32_t height) {
  layout::ChartRecord chart = grid_chart(width, height);
  chart.kind = layout::chart_mapped;
  return chart;
}

// Every slot is one chart's, blocks stand at multiples of their size, and each holds its chart's quads once.
void expect_whole(const std::vector<layout::ChartRecord>& charts, uint64_t slots) {
  std::vector<bool> taken(slots, false);
  for (const layout::ChartRecord& chart : charts) {
    EXPECT_GE(chart.slot_count, QuadOrder::block_slots(chart));
    EXPECT_TRUE(std::has_single_bit(chart.slot_count));
    EXPECT_EQ(chart.first_slot % chart.slot_count, 0u);
    ASSERT_LE(chart.first_slot + chart.slot_count, slots);
    uint32_t quads = 0;
    for (uint32_t s = 0; s < chart.slot_count; ++s) {
      EXPECT_FALSE(taken[chart.first_slot + s]);
      taken[chart.first_slot + s] = true;
      quads += leaf_entry(chart, s).x == layout::empty_slot ? 0 : 1;
    }
    EXPECT_EQ(quads, (chart.width - 1) * (chart.height - 1));
  }
  EXPECT_EQ(std::count(taken.begin(), taken.end(), false), 0);
}

TEST(Slots, OfMappedChartsAreAllTakenAndHardlyMoreThanTheyNeed) {
  std::mt19937 random(1);
  for (uint32_t round = 0; round < 60; ++round) {
    std::vector<layout::ChartRecord> charts;
    std::vector<ChartBox> boxes;
    uint64_t needed = 0;
    const uint32_t largest = 1 + round % 40;
    for (uint32_t i = 0; i < 9 + 7 * round; ++i) {
      charts.push_back(mapped_chart(1 + random() % largest, 1 + random() % largest));
      needed += QuadOrder::block_slots(charts.back());
      // Many at one place, too.
      const glm::vec3 at(random() % 5, random() % (1 + round), random() % 3);
      boxes.push_back({at, at + glm::vec3(random() % 2)});
    }
    const uint64_t slots = assign_slots(charts, boxes, ChartOrder::median, "test");
    SCOPED_TRACE(round);
    expect_whole(charts, slots);
    EXPECT_LE(double(slots), 1.25 * double(needed));
    EXPECT_EQ(tree_depth(slots), tree_depth(needed));
  }
}

TEST(Slots, OfMappedChartsAreNearInTheTreeWhereTheyAreInSpace) {
  // A row of places, with a large, a middling and three small charts each, given in no order.
  std::vector<layout::ChartRecord> charts;
  std::vector<ChartBox> boxes;
  std::vector<uint32_t> places;
  for (uint32_t i = 0; i < 16 * 5; ++i) {
    const uint32_t place = (7 * i) % 16, kind = i / 16;
    charts.push_back(kind == 0 ? mapped_chart(8, 8) : kind == 1 ? mapped_chart(8, 4) : mapped_chart(3, 3));
    const glm::vec3 at(10.0f * float(place), 0.1f * float(kind), 0);
    boxes.push_back({at, at + 1.0f});
    places.push_back(place);
  }
  const uint64_t slots = assign_slots(charts, boxes, ChartOrder::median, "test");
  expect_whole(charts, slots);
  // Sorted by size each place would be all over the tree.
  double span = 0;
  for (uint32_t place = 0; place < 16; ++place) {
    uint64_t first = slots, last = 0;
    for (size_t i = 0; i < charts.size(); ++i) {
      if (places[i] != place) continue;
      first = std::min<uint64_t>(first, charts[i].first_slot);
      last = std::max<uint64_t>(last, charts[i].first_slot);
    }
    span += double(last - first) / double(slots) / 16;
  }
  EXPECT_LT(span, 0.2);
}

TEST(Slots, OfMappedChartsBesideAVeryLargeOneAreAsThoseOfOthers) {
  std::vector<layout::ChartRecord> charts = {mapped_chart(2, 2), mapped_chart(64, 64), mapped_chart(4, 4)};
  const uint64_t slots = assign_slots(charts, std::vector<ChartBox>(3), ChartOrder::median, "test");
  expect_whole(charts, slots);
  EXPECT_EQ(slots, 64u * 64 + 16 + 4);
}

TEST(Slots, PutLargeBlocksFirstAndLeaveNoGap) {
  for (uint32_t count = 1; count < 60; ++count) {
    std::vector<layout::ChartRecord> charts;
    for (uint32_t i = 0; i < count; ++i) charts.push_back(grid_chart(1 + (i * 7) % 13, 1 + (i * 5) % 9));
    const std::vector<ChartBox> boxes(charts.size());
    const uint64_t slots = assign_slots(charts, boxes, ChartOrder::median, "test");
    std::vector<bool> taken(slots, false);
    for (const layout::ChartRecord& chart : charts) {
      EXPECT_EQ(chart.slot_count, QuadOrder::block_slots(chart));
      EXPECT_EQ(chart.first_slot % chart.slot_count, 0u);
      ASSERT_LE(chart.first_slot + chart.slot_count, slots);
      for (uint32_t s = 0; s < chart.slot_count; ++s) {
        EXPECT_FALSE(taken[chart.first_slot + s]);
        taken[chart.first_slot + s] = true;
      }
      // But for one that is half a node and left over.
      for (const layout::ChartRecord& other : charts) {
        EXPECT_TRUE(other.slot_count <= 4 * chart.slot_count || other.first_slot < chart.first_slot);
      }
    }
    EXPECT_EQ(std::count(taken.begin(), taken.end(), false), 0);
  }
}

TEST(Slots, LetNeighboursShareANodeWhereTheyAreHalfOfOne) {
  // Three pairs far from each other and from the squares, one of which is beside each pair.
  std::vector<layout::ChartRecord> charts;
  std::vector<ChartBox> boxes;
  for (uint32_t i = 0; i < 9; ++i) {
    charts.push_back(i < 6 ? grid_chart(i % 2 == 0 ? 8 : 4, i % 2 == 0 ? 4 : 8) : grid_chart(8, 8));
    const glm::vec3 at(100.0f * float(i % 3), float(i), 0);
    boxes.push_back({at, at});
  }
  EXPECT_EQ(assign_slots(charts, boxes, ChartOrder::median, "test"), 6 * 32 + 3 * 64u);
  for (uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(charts[i].first_slot / 64, charts[i + 3].first_slot / 64);
    EXPECT_NE(charts[i].first_slot, charts[i + 3].first_slot);
  }
  // Nodes stand in one order, whether they are one chart or two.
  EXPECT_EQ(charts[0].first_slot / 128, charts[6].first_slot / 128);
}

TEST(Slots, PutTheHalfNodeThatIsLeftOverBehindAnEvenNumberOfThoseASizeBelow) {
  for (uint32_t below = 0; below < 6; ++below) {
    // One of 16 slots, three of 8, `below` of 4, one of 1.
    std::vector<layout::ChartRecord> charts = {grid_chart(4, 4), grid_chart(4, 2), grid_chart(2, 4),
                                               grid_chart(2, 4), grid_chart(1, 1)};
    charts.insert(charts.end(), below, grid_chart(2, 2));
    const std::vector<ChartBox> boxes(charts.size());
    EXPECT_EQ(assign_slots(charts, boxes, ChartOrder::median, "test"), 16 + 3 * 8 + 4 * below + 1u);
    EXPECT_EQ(charts[3].first_slot, 32 + below / 2 * 8u);
    EXPECT_EQ(charts[4].first_slot, 40 + 4 * below);
  }
}

TEST(Slots, EndWhereTheDeepestTreeEnds) {
  std::vector<layout::ChartRecord> charts = {grid_chart(1u << 14, 1u << 14)};
  EXPECT_EQ(assign_slots(charts, {}, ChartOrder::median, "test"), uint64_t(1) << 28);
  EXPECT_EQ(tree_depth(uint64_t(1) << 28), layout::max_depth);
  charts.push_back(grid_chart(1, 1));
  expect_error(
      [&] {
        assign_slots(charts, {{glm::vec3(0), glm::vec3(0)}, {glm::vec3(1), glm::vec3(1)}}, ChartOrder::median,
                     "test");
      },
      ExitCode::bad_input, "test", "268435457 leaf slots for 2 charts, and 268435456 is the most");
  charts = {grid_chart((1u << 14) + 1, 4)};
  EXPECT_EQ(assign_slots(charts, {}, ChartOrder::median, "test"), uint64_t(1) << 17);
}

TEST(TreeDepth, IsTheLowestThatSuffices) {
  EXPECT_EQ(tree_depth(1), 1u);
  EXPECT_EQ(tree_depth(4), 1u);
  EXPECT_EQ(tree_depth(5), 2u);
  EXPECT_EQ(tree_depth(16), 2u);
  EXPECT_EQ(tree_depth(17), 3u);
}

}  // namespace
}  // namespace lodestone::geometry_image
