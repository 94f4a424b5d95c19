// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_packing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace lodestone::geometry_image {
namespace {

using Sizes = std::vector<glm::uvec2>;

// Every texel of the picture is of one chart at most, and none of another is nearer than the gutter.
void expect_sound(const Sizes& sizes, uint32_t gutter, const ChartPacking& packing) {
  ASSERT_EQ(packing.places.size(), sizes.size());
  std::vector<uint32_t> owner(size_t(packing.width) * packing.height, 0);
  const auto at = [&](uint32_t x, uint32_t y) -> uint32_t& { return owner[size_t(y) * packing.width + x]; };
  uint64_t texels = 0;
  for (uint32_t i = 0; i < sizes.size(); ++i) {
    const glm::uvec2 lo = packing.places[i], hi = lo + sizes[i];
    ASSERT_LE(hi.x, packing.width);
    ASSERT_LE(hi.y, packing.height);
    texels += uint64_t(sizes[i].x) * sizes[i].y;
    for (uint32_t y = lo.y; y < hi.y; ++y) {
      for (uint32_t x = lo.x; x < hi.x; ++x) {
        ASSERT_EQ(at(x, y), 0u);
        at(x, y) = i + 1;
      }
    }
  }
  for (uint32_t i = 0; i < sizes.size(); ++i) {
    const glm::uvec2 lo = packing.places[i] - glm::min(packing.places[i], glm::uvec2(gutter));
    const glm::uvec2 hi =
        glm::min(packing.places[i] + sizes[i] + gutter, glm::uvec2(packing.width, packing.height));
    for (uint32_t y = lo.y; y < hi.y; ++y) {
      for (uint32_t x = lo.x; x < hi.x; ++x) ASSERT_TRUE(at(x, y) == 0 || at(x, y) == i + 1);
    }
  }
  EXPECT_NEAR(packing.filled, double(texels) / (double(packing.width) * packing.height), 1e-12);
}

double longer_by_shorter(const ChartPacking& packing) {
  return double(std::max(packing.width, packing.height)) / std::min(packing.width, packing.height);
}

// Quads 2^k a side, so one texel more.
Sizes random_charts(uint32_t seed, uint32_t count, uint32_t most) {
  std::mt19937 random(seed);
  Sizes sizes;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t width = 1u << random() % (most + 1), height = 1u << random() % (most + 1);
    sizes.emplace_back(width + 1, height + 1);
  }
  return sizes;
}

TEST(ChartPacking, KeepsChartsApartAndInside) {
  for (uint32_t seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    Sizes sizes;
    const uint32_t count = 1 + random() % 60, most = 2 + random() % 40;
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t width = 1 + random() % most, height = 1 + random() % most;
      sizes.emplace_back(width, height);
    }
    for (const uint32_t gutter : {0u, 1u, 3u}) expect_sound(sizes, gutter, pack_charts(sizes, gutter));
  }
}

TEST(ChartPacking, FillsMoreThanThreeQuartersOfANearSquare) {
  for (const uint32_t count : {200u, 1000u, 5000u}) {
    for (uint32_t seed = 0; seed < 4; ++seed) {
      const Sizes sizes = random_charts(seed, count, 7);
      const ChartPacking packing = pack_charts(sizes);
      expect_sound(sizes, 1, packing);
      EXPECT_GT(packing.filled, 0.75) << count << " " << seed;
      EXPECT_LT(longer_by_shorter(packing), 1.1) << count << " " << seed;
    }
  }
}

TEST(ChartPacking, WastesNextToNothingButGuttersOnChartsOfOneSize) {
  const ChartPacking packing = pack_charts(Sizes(100000, {3, 3}));
  expect_sound(Sizes(100000, {3, 3}), 1, packing);
  EXPECT_GT(packing.filled, 0.99 * 9 / 16);
  EXPECT_LT(longer_by_shorter(packing), 1.02);
}

TEST(ChartPacking, LeavesAChartAloneAsItIs) {
  const ChartPacking packing = pack_charts({{4097, 65}});
  EXPECT_EQ(packing.width, 4097u);
  EXPECT_EQ(packing.height, 65u);
  EXPECT_EQ(packing.places, Sizes{glm::uvec2(0)});
  EXPECT_EQ(packing.filled, 1.0);
  EXPECT_TRUE(pack_charts({}).places.empty());
}

TEST(ChartPacking, PutsTheSmallBesideTheLong) {
  for (const bool high : {false, true}) {
    Sizes sizes(1000, {9, 9});
    sizes.emplace_back(high ? glm::uvec2(3, 4097) : glm::uvec2(4097, 3));
    const ChartPacking packing = pack_charts(sizes);
    expect_sound(sizes, 1, packing);
    EXPECT_EQ(std::max(packing.width, packing.height), 4097u);
    EXPECT_GT(packing.filled, 0.65);  // 81 of 100 texels are a small chart's, beside its gutter
  }
}

TEST(ChartPacking, GivesEqualPlacesForEqualSizes) {
  const Sizes sizes = random_charts(5, 700, 6);
  const ChartPacking once = pack_charts(sizes), again = pack_charts(sizes);
  EXPECT_EQ(once.places, again.places);
  EXPECT_EQ(once.width, again.width);
  // Charts of one size stand in their own order, so that neighbours on the surface often are in the picture.
  const ChartPacking alike = pack_charts(Sizes(50, {5, 5}));
  EXPECT_TRUE(std::is_sorted(
      alike.places.begin(), alike.places.end(),
      [](const glm::uvec2& a, const glm::uvec2& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }));
}

}  // namespace
}  // namespace lodestone::geometry_image
