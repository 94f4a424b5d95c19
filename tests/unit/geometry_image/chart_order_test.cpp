// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace lodestone::geometry_image {
namespace {

std::vector<ChartCenter> random_centers(uint32_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-3, 5);
  std::vector<ChartCenter> centers;
  for (uint32_t i = 0; i < count; ++i) {
    centers.push_back({{coordinate(random), coordinate(random), coordinate(random)}, i});
  }
  return centers;
}

std::vector<uint32_t> order(std::vector<ChartCenter> centers, uint64_t first_slot, ChartOrder kind,
                            uint64_t block = 1) {
  order_charts(centers, first_slot, block, kind);
  std::vector<uint32_t> charts;
  for (const ChartCenter& center : centers) charts.push_back(center.chart);
  return charts;
}

TEST(AlignedSplit, CutsAtTheBorderOfTheLargestSubtreesNearestToTheMiddle) {
  for (const uint64_t block : {1u, 2u, 16u, 32u}) {
    for (uint64_t first = 0; first < 70; ++first) {
      for (uint64_t count = 2; count < 150; ++count) {
        uint64_t subtree = 1;  // in blocks: the largest that is a power of 4 slots with a multiple inside
        for (uint64_t power = 1; power < 4096; power *= 2) {
          const bool is_node = std::countr_zero(power * block) % 2 == 0;
          if (is_node && (first / power + 1) * power < first + count) subtree = power;
        }
        const uint64_t split = aligned_split(first * block, block, count);
        ASSERT_GT(split, 0u);
        ASSERT_LT(split, count);
        ASSERT_EQ((first + split) % subtree, 0u) << first << " " << count;
        const auto off_middle = [&](uint64_t at) { return std::abs(int64_t(2 * at) - int64_t(count)); };
        for (uint64_t at = 1; at < count; ++at) {
          if ((first + at) % subtree != 0) continue;
          // To within half a block: the middle of an odd run is between two.
          ASSERT_LE(off_middle(split), off_middle(at) + 1) << first << " " << count;
        }
      }
    }
  }
}

TEST(AlignedSplit, PartsBlocksOfHalfANodeBetweenNodes) {
  EXPECT_EQ(aligned_split(0, 2, 3), 2u);
  EXPECT_EQ(aligned_split(2, 2, 3), 1u);
  EXPECT_EQ(aligned_split(0, 32, 7), 4u);  // 8 of them are a node of 256 slots, 2 one of 64
  EXPECT_EQ(aligned_split(0, 2, 2), 1u);
  EXPECT_EQ(aligned_split(0, 1, 3), 1u) << "whole blocks are all alike within a node";
}

TEST(ChartOrder, IsAPermutationWhateverTheInputsOrder) {
  std::mt19937 random(3);
  for (const ChartOrder kind : {ChartOrder::median, ChartOrder::hilbert}) {
    for (const uint32_t count : {0u, 1u, 2u, 5u, 64u, 1000u, 40000u}) {
      std::vector<ChartCenter> centers = random_centers(count, count);
      // Equal places, too.
      for (uint32_t i = 0; i + 7 < count; i += 5) centers[i + 6].center = centers[i].center;
      const std::vector<uint32_t> expected = order(centers, 3, kind);
      EXPECT_EQ(std::set<uint32_t>(expected.begin(), expected.end()).size(), count);
      for (int i = 0; i < 3; ++i) {
        std::shuffle(centers.begin(), centers.end(), random);
        EXPECT_EQ(order(centers, 3, kind), expected);
      }
    }
  }
}

TEST(ChartOrder, PutsSeparateClustersIntoSeparateSubtrees) {
  // Four clusters along y, 16 charts each, given in turns.
  std::vector<ChartCenter> centers = random_centers(64, 9);
  for (ChartCenter& center : centers) center.center.y += 100.0f * float(center.chart % 4);
  for (const ChartOrder kind : {ChartOrder::median, ChartOrder::hilbert}) {
    const std::vector<uint32_t> charts = order(centers, 0, kind);
    for (uint32_t i = 0; i < 64; ++i) EXPECT_EQ(charts[i] % 4, charts[i / 16 * 16] % 4);
  }
}

TEST(ChartOrder, PutsNeighboursIntoOneNodeWhereBlocksAreHalfOfOne) {
  for (const uint32_t pairs : {1u, 2u, 3u, 7u, 50u}) {
    std::vector<ChartCenter> centers;
    for (uint32_t i = 0; i < 2 * pairs; ++i) {
      const float jitter = i < pairs ? 0.0f : 0.01f;
      centers.push_back({{std::sin(float(i % pairs)) * 100 + jitter, float(i % pairs) * 10, 0}, i});
    }
    const std::vector<uint32_t> charts = order(centers, 0, ChartOrder::median, 8);
    for (uint32_t i = 0; i < 2 * pairs; i += 2) EXPECT_EQ(charts[i] % pairs, charts[i + 1] % pairs) << pairs;
  }
}

TEST(ChartOrder, SplitsWhereTheTreeDoesAndNotWhereTheRunStarts) {
  // The run starts at place 2: two blocks fill the first subtree of four up, four are the next one.
  std::vector<ChartCenter> centers;
  for (uint32_t i = 0; i < 6; ++i) centers.push_back({{i < 2 ? -50.0f - float(i) : float(i), 0, 0}, i});
  const std::vector<uint32_t> charts = order(centers, 2, ChartOrder::median);
  EXPECT_EQ(std::set<uint32_t>(charts.begin(), charts.begin() + 2), (std::set<uint32_t>{0, 1}));
}

TEST(ChartOrder, TakesChartsAtOnePlace) {
  std::vector<ChartCenter> centers(20);
  for (uint32_t i = 0; i < 20; ++i) centers[i] = {{1, 2, 3}, i};
  for (const ChartOrder kind : {ChartOrder::median, ChartOrder::hilbert}) {
    const std::vector<uint32_t> charts = order(centers, 0, kind);
    EXPECT_EQ(std::set<uint32_t>(charts.begin(), charts.end()).size(), 20u);
  }
}

TEST(HilbertIndex, WalksThroughEveryCellInStepsOfOne) {
  for (const uint32_t bits : {1u, 2u, 3u, 4u}) {
    const uint32_t side = 1u << bits;
    std::vector<glm::uvec3> cells(size_t(side) * side * side, glm::uvec3(side));
    for (uint32_t z = 0; z < side; ++z) {
      for (uint32_t y = 0; y < side; ++y) {
        for (uint32_t x = 0; x < side; ++x) {
          const uint64_t index = hilbert_index({x, y, z}, bits);
          ASSERT_LT(index, cells.size());
          ASSERT_EQ(cells[index].x, side) << "taken twice";
          cells[index] = {x, y, z};
        }
      }
    }
    for (size_t i = 1; i < cells.size(); ++i) {
      const glm::ivec3 step = glm::abs(glm::ivec3(cells[i]) - glm::ivec3(cells[i - 1]));
      EXPECT_EQ(step.x + step.y + step.z, 1) << bits << " bits, step " << i;
    }
  }
}

TEST(HilbertIndex, TakesTwentyOneBits) {
  EXPECT_LT(hilbert_index(glm::uvec3((1u << 21) - 1), 21), uint64_t(1) << 63);
  EXPECT_EQ(hilbert_index(glm::uvec3(0), 21), 0u);
}

}  // namespace
}  // namespace lodestone::geometry_image
