// SPDX-License-Identifier: MIT
#include "lodestone/test_support/log_plot.h"

#include <gtest/gtest.h>

#include <regex>
#include <stdexcept>

namespace lodestone::test {
namespace {

// The places of the round marks, as the picture draws them.
std::vector<glm::dvec2> circles(const std::string& svg) {
  const std::regex circle("<circle class=\"mark\" cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  std::vector<glm::dvec2> places;
  for (std::sregex_iterator i(svg.begin(), svg.end(), circle), end; i != end; ++i)
    places.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]));
  return places;
}

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(LogPlot, EqualFactorsAreEqualDistances) {
  const auto marks = circles(log_plot({{"error", {{"a", {{16, 10}, {32, 1}, {64, 0.1}}}}}}, "side", 1));
  ASSERT_EQ(marks.size(), 4u);  // the first is the legend's
  const glm::dvec2 first = marks[2] - marks[1], second = marks[3] - marks[2];
  EXPECT_GT(first.x, 0);
  EXPECT_GT(first.y, 0);                 // down
  EXPECT_NEAR(first.x, second.x, 0.11);  // places are written to a tenth of a unit
  EXPECT_NEAR(first.y, second.y, 0.11);
}

TEST(LogPlot, PanelsShareTheirAxisAndALegend) {
  const Curve a{"a", {{16, 1}, {64, 0.1}}}, b{"b", {{16, 2}}}, guide{"guide", {{16, 1}, {64, 0.01}}, true};
  const std::string svg = log_plot({{"one", {a, b, guide}}, {"two", {a}}}, "side", 2);
  EXPECT_EQ(count(svg, ">a</text>"), 1u);
  EXPECT_EQ(count(svg, ">guide</text>"), 1u);
  EXPECT_EQ(count(svg, ">side</text>"), 2u);
  EXPECT_EQ(count(svg, "stroke-dasharray"), 2u);  // in the legend and in its panel
  EXPECT_EQ(count(svg, ">32</text>"), 2u);
  EXPECT_EQ(circles(svg).size(), 1u + 2 + 2);  // only `a` has round marks
}

TEST(LogPlot, WhatHasNoLogarithmIsLeftOut) {
  EXPECT_EQ(circles(log_plot({{"t", {{"a", {{16, 1}, {32, 0}, {0, 1}}}}}}, "side", 1)).size(), 2u);
  EXPECT_THROW(log_plot({{"t", {{"a", {{16, 0}}}}}}, "side", 1), std::invalid_argument);
  EXPECT_THROW(log_plot({}, "side", 1), std::invalid_argument);
}

TEST(LogPlot, NamesCannotBreakThePicture) {
  const std::string svg = log_plot({{"<t>", {{"a&b", {{16, 1}}}}}}, "\"side\"", 1);
  EXPECT_NE(svg.find("&lt;t&gt;"), std::string::npos);
  EXPECT_NE(svg.find("a&amp;b"), std::string::npos);
  EXPECT_EQ(svg.find("<t>"), std::string::npos);
}

}  // namespace
}  // namespace lodestone::test
