// SPDX-License-Identifier: MIT
// Tables and plots for documents.
#include <gtest/gtest.h>

#include <stdexcept>

#include "lodestone/test_support/markdown_table.h"
#include "lodestone/test_support/ratio_plot.h"

namespace lodestone::test {
namespace {

TEST(MarkdownTable, AlignsNumbersToTheRight) {
  EXPECT_EQ(markdown_table({"what", "ms"}, {{"trace", "1.5"}, {"bounds", ""}}),
            "| what | ms |\n| --- | ---: |\n| trace | 1.5 |\n| bounds |  |\n");
  EXPECT_THROW(markdown_table({"what", "ms"}, {{"trace"}}), std::invalid_argument);
}

// Where the bars begin and how long they are, in the order of the picture.
std::vector<std::pair<double, double>> bars_of(const std::string& svg) {
  std::vector<std::pair<double, double>> bars;
  const std::string mark = "class=\"bar\" d=\"M";
  for (size_t at = svg.find(mark); at != std::string::npos; at = svg.find(mark, at + 1)) {
    const size_t length = svg.find('h', at);
    bars.emplace_back(std::stod(svg.substr(at + mark.size())), std::stod(svg.substr(length + 1)));
  }
  return bars;
}

TEST(RatioPlot, DrawsBarsFromOneByTheirLogarithm) {
  const std::string svg = ratio_plot(
      {{"first", {{"twice", 2}, {"half", 0.5}}}, {"second", {{"a < b & c", 4}, {"same", 1}}}}, "times");
  const auto bars = bars_of(svg);
  ASSERT_EQ(bars.size(), 4u);
  const double one = bars[0].first, step = bars[0].second;
  EXPECT_GT(step, 10);
  EXPECT_NEAR(bars[1].first, one - step, 0.11);
  EXPECT_NEAR(bars[1].second, step, 0.11);
  EXPECT_NEAR(bars[2].first, one, 0.11);
  EXPECT_NEAR(bars[2].second, 2 * step, 0.11);
  EXPECT_EQ(bars[3].second, 0);
  EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
}

TEST(RatioPlot, RefusesWhatHasNoPlace) {
  EXPECT_THROW(ratio_plot({{"empty", {}}}, ""), std::invalid_argument);
  EXPECT_THROW(ratio_plot({{"zero", {{"a", 0}}}}, ""), std::invalid_argument);
}

}  // namespace
}  // namespace lodestone::test
