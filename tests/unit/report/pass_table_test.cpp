// SPDX-License-Identifier: MIT
#include "lodestone/report/pass_table.h"

#include <gtest/gtest.h>

#include <sstream>

#include "runs.h"

namespace lodestone::report {
namespace {

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::vector<std::string> lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> result;
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

TEST(PassTable, GivesTimeShareTrafficAndEveryCountPerRay) {
  const auto rows = lines(pass_table(
      sum_by_name({testing::counted_dispatch("trace", 1000), testing::device_dispatch("shade", 0, 6)})));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NE(rows[0].find("device ms"), std::string::npos);
  EXPECT_EQ(words(rows[1]), (std::vector<std::string>{"trace", "1", "2.000", "25.0", "%", "64", "8.00",
                                                      "1.00", "1000", "10.00", "20.00", "3.00", "0.75"}));
  EXPECT_EQ(words(rows[2]), (std::vector<std::string>{"shade", "1", "6.000", "75.0", "%", "64", "-", "-", "-",
                                                      "-", "-", "-", "-"}));
}

TEST(PassTable, UsesTheClockOfTheHostWhereThereIsNoOther) {
  const auto rows = lines(pass_table(sum_by_name({testing::dispatch("trace", 0, 3)})));
  EXPECT_NE(rows[0].find("wall ms"), std::string::npos);
  EXPECT_EQ(words(rows[1])[2], "3.000");
}

TEST(PassTable, SaysNothingOfAPassThatOnlyCompiled) {
  const auto rows = lines(
      pass_table(sum_by_name({testing::device_dispatch("trace", 0, 3), testing::dispatch("shade", 3, 27)})));
  EXPECT_EQ(words(rows[2])[2], "-");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_NE(rows[3].find("not timed"), std::string::npos);
}

}  // namespace
}  // namespace lodestone::report
