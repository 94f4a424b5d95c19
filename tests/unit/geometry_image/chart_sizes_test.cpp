// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "lodestone/base_complex/cells.h"
#include "surfaces.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::BaseComplex;
using base_complex::Cell;

BaseComplex complex_of(base_complex::HalfEdgeMesh mesh, uint32_t cells = 12) {
  base_complex::CellOptions options;
  options.cells = cells;
  base_complex::Cells grown = grow_cells(mesh, options);
  return build_complex(std::move(mesh), std::move(grown));
}

// Every side's charts, as wide and high as their cells.
std::vector<ChartProfile> profiles_of(const BaseComplex& complex) {
  std::vector<ChartProfile> profiles;
  for (const Cell& cell : complex.cells) {
    const glm::dvec2 extent = extent_of(complex, cell);
    // One flat quad: no error at any size.
    profiles.emplace_back(
        ChartPowers{},
        std::vector<glm::dvec3>{{0, 0, 0}, {extent.x, 0, 0}, {0, extent.y, 0}, {extent.x, extent.y, 0}},
        std::vector<FirmArc>{});
  }
  return profiles;
}

std::vector<ChartSize> sizes_of(const BaseComplex& complex, uint64_t budget, const Need& need = {}) {
  return choose_sizes(complex, profiles_of(complex), ArcErrors(complex), need, budget);
}

uint64_t texels_of(const std::vector<ChartSize>& sizes) {
  uint64_t sum = 0;
  for (const ChartSize& size : sizes) sum += size.texels();
  return sum;
}

void expect_sides_are_shared_out(const BaseComplex& complex, const std::vector<ChartSize>& sizes) {
  ASSERT_EQ(sizes.size(), complex.cells.size());
  for (size_t c = 0; c < sizes.size(); ++c) {
    const Cell& cell = complex.cells[c];
    ASSERT_EQ(sizes[c].segments.size(), cell.boundary.size());
    EXPECT_EQ(sizes[c].texels(), uint64_t(sizes[c].width + 1) * (sizes[c].height + 1));
    for (size_t s = 0; s < 4; ++s) {
      // Longer than 8 only as a power of 2, or as many as one of two opposite sides has arcs.
      const uint32_t quads = s % 2 == 0 ? sizes[c].width : sizes[c].height;
      const std::array<base_complex::Side, 4> sides = sides_of(complex, cell);
      const size_t arcs =
          std::max(sides[s].end - sides[s].first, sides[(s + 2) % 4].end - sides[(s + 2) % 4].first);
      EXPECT_TRUE(quads <= 8 || std::has_single_bit(quads) || quads == arcs) << quads;
      const size_t end = s < 3 ? cell.corners[s + 1] : cell.boundary.size();
      uint64_t sum = 0;
      for (size_t p = cell.corners[s]; p < end; ++p) {
        EXPECT_GE(sizes[c].segments[p], 1u);
        sum += sizes[c].segments[p];
      }
      EXPECT_EQ(sum, s % 2 == 0 ? sizes[c].width : sizes[c].height);
    }
  }
}

TEST(ChartSizes, KeepTheBudgetAndGiveEveryArcASegment) {
  for (const base_complex::test::Sample& sample : base_complex::test::all_samples()) {
    SCOPED_TRACE(sample.name);
    const BaseComplex complex = complex_of(sample.mesh);
    const uint64_t least = texels_of(sizes_of(complex, 0));
    expect_sides_are_shared_out(complex, sizes_of(complex, 0));
    for (const uint64_t factor : {1u, 2u, 5u, 40u}) {
      const std::vector<ChartSize> sizes = sizes_of(complex, factor * least);
      expect_sides_are_shared_out(complex, sizes);
      EXPECT_LE(texels_of(sizes), factor * least);
      // What is left would not have been enough to make any chart larger.
      for (const ChartSize& size : sizes) {
        const auto longer = [](uint32_t side) { return side < 8 ? side + 1 : std::bit_ceil(side + 1); };
        const uint64_t wider = uint64_t(longer(size.width) - size.width) * (size.height + 1),
                       taller = uint64_t(longer(size.height) - size.height) * (size.width + 1);
        EXPECT_GT(texels_of(sizes) + std::max(wider, taller), factor * least);
      }
    }
  }
}

TEST(ChartSizes, TakeNoMoreThanTheLeastWhereTheBudgetIsLess) {
  const BaseComplex complex = complex_of(base_complex::test::torus(32, 20).mesh());
  const uint64_t least = texels_of(sizes_of(complex, 0));
  EXPECT_EQ(texels_of(sizes_of(complex, least - 1)), least);
  for (const ChartSize& size : sizes_of(complex, 1)) {
    EXPECT_LE(size.width, 64u);
    EXPECT_LE(size.height, 64u);
  }
}

TEST(ChartSizes, HaveTheSegmentsOfAnArcFromTheCoarsestBesideIt) {
  for (const base_complex::test::Sample& sample : base_complex::test::all_samples()) {
    const BaseComplex complex = complex_of(sample.mesh);
    const std::vector<ChartSize> sizes = sizes_of(complex, 20000);
    std::vector<std::vector<uint32_t>> beside(complex.arcs.size());
    for (size_t c = 0; c < sizes.size(); ++c)
      for (size_t p = 0; p < complex.cells[c].boundary.size(); ++p)
        beside[complex.cells[c].boundary[p].arc].push_back(sizes[c].segments[p]);
    const std::vector<uint32_t> segments = arc_segments(complex, sizes);
    ASSERT_EQ(segments.size(), complex.arcs.size());
    for (size_t a = 0; a < segments.size(); ++a)
      EXPECT_EQ(segments[a], *std::min_element(beside[a].begin(), beside[a].end())) << sample.name;
  }
}

TEST(ChartSizes, SpreadEvenlyOverTheArea) {
  const BaseComplex complex = complex_of(base_complex::test::plane(40, 40).mesh(), 16);
  const std::vector<ChartProfile> profiles = profiles_of(complex);
  const std::vector<ChartSize> sizes = sizes_of(complex, 1 << 16);
  double widest = 0, narrowest = 1e9;
  for (size_t c = 0; c < sizes.size(); ++c) {
    widest = std::max(widest, profiles[c].spacing(sizes[c].width, sizes[c].height));
    narrowest = std::min(narrowest, profiles[c].spacing(sizes[c].width, sizes[c].height));
  }
  EXPECT_LT(widest, 4 * narrowest);
}

TEST(ChartSizes, GiveMoreToAChartOfGreaterWeight) {
  const BaseComplex complex = complex_of(base_complex::test::plane(40, 40).mesh(), 16);
  const std::vector<ChartSize> even = sizes_of(complex, 1 << 14);
  for (size_t heavy = 0; heavy < complex.cells.size(); heavy += 5) {
    Need need;
    need.chart_weights.assign(complex.cells.size(), 1);
    need.chart_weights[heavy] = 8;
    const std::vector<ChartSize> sizes = sizes_of(complex, 1 << 14, need);
    EXPECT_GE(sizes[heavy].texels(), 4 * even[heavy].texels());
    EXPECT_LE(texels_of(sizes), 1u << 14);
  }
}

// A disc of one chart: with long sides only because its border is bent.
TEST(ChartSizes, GiveAFirmArcSegmentsUntilItIsNear) {
  base_complex::test::Surface disc = base_complex::test::plane(24, 24);
  for (auto& p : disc.positions) {
    p -= glm::dvec3(12, 12, 0);
    const double length = glm::length(p);
    if (length > 0) p *= std::max(std::abs(p.x), std::abs(p.y)) / length;
  }
  base_complex::HalfEdgeMesh mesh = disc.mesh();
  base_complex::Cells one;
  one.of_face.assign(mesh.faces(), 0);
  one.count = 1;
  const BaseComplex complex = build_complex(std::move(mesh), std::move(one));
  const ArcErrors arc_errors(complex);
  const auto farthest = [&](const Need& need) {
    const std::vector<uint32_t> segments =
        arc_segments(complex, choose_sizes(complex, profiles_of(complex), arc_errors, need, 40 * 40));
    double most = 0;
    for (uint32_t arc = 0; arc < complex.arcs.size(); ++arc)
      most = std::max(most, arc_errors.error(arc, segments[arc]));
    return most;
  };
  // With 32 quads a side the border is 128 segments for 96 edges; fewer a side leave a sagitta.
  Need need;
  need.flattest = need.roughest = 1e-3;
  EXPECT_LT(farthest(need), 0.05);
  EXPECT_GT(arc_errors.error(0, 1), 1);
}

TEST(ChartSizes, GiveMoreWhereChartsWereFoundToBeFar) {
  const BaseComplex complex = complex_of(base_complex::test::plane(40, 40).mesh(), 16);
  Need need;
  need.flattest = need.roughest = 0.05;
  const std::vector<ChartSize> even = sizes_of(complex, 1 << 14, need);
  for (size_t far = 0; far < complex.cells.size(); far += 5) {
    need.found.assign(complex.cells.size(), 0);
    need.found[far] = 0.4;
    EXPECT_GE(sizes_of(complex, 1 << 14, need)[far].texels(), 4 * even[far].texels());
  }
}

TEST(ChartSizes, LeaveAFixedSizeAsItIs) {
  const BaseComplex complex = complex_of(base_complex::test::plane(40, 40).mesh(), 16);
  Need need;
  const std::vector<ChartSize> even = sizes_of(complex, 1 << 14, need);
  need.fixed.resize(complex.cells.size());
  need.fixed[3] = {even[3].width + 1, 2 * even[3].height};
  const std::vector<ChartSize> sizes = sizes_of(complex, 1 << 14, need);
  EXPECT_EQ(sizes[3].width, need.fixed[3].width);
  EXPECT_EQ(sizes[3].height, need.fixed[3].height);
  EXPECT_LE(texels_of(sizes), 1u << 14) << "the others get what is left";
  EXPECT_GT(texels_of(sizes), 12000u);
}

TEST(ChartSizes, EndWhereMortonCodesDo) {
  const BaseComplex complex = complex_of(base_complex::test::single_triangle().mesh(), 1);
  ASSERT_EQ(complex.cells.size(), 1u);
  const std::vector<ChartSize> sizes = sizes_of(complex, uint64_t(1) << 40);
  EXPECT_EQ(sizes[0].width, 1u << 14);
  EXPECT_EQ(sizes[0].height, 1u << 14);
}

TEST(ChartSizes, ExtentHasTheCellsAreaAndTheShapeOfItsSides) {
  base_complex::Cells one;
  one.of_face.assign(2 * 12 * 3, 0);
  one.count = 1;
  const BaseComplex complex = build_complex(base_complex::test::plane(12, 3).mesh(), one);
  const glm::dvec2 extent = extent_of(complex, complex.cells[0]);
  EXPECT_NEAR(extent.x * extent.y, 36, 1e-9);
  EXPECT_NEAR(std::max(extent.x, extent.y) / std::min(extent.x, extent.y), 4, 1e-9);
}

}  // namespace
}  // namespace lodestone::geometry_image
