// SPDX-License-Identifier: MIT
#include "lodestone/test_support/rounds.h"

#include <gtest/gtest.h>

namespace lodestone::test {
namespace {

TEST(Rounds, RatiosAreTakenRoundByRoundBeforeTheMedian) {
  Rounds rounds;
  rounds.add(2, 1);  // a quiet machine, then a busy one: both slower, the ratio the same
  rounds.add(20, 10);
  rounds.add(9, 3);
  EXPECT_EQ(rounds.ratio, (std::vector<double>{2, 2, 3}));
  EXPECT_EQ(spread(rounds.ratio), "2.00 (2.00 to 3.00)");
}

}  // namespace
}  // namespace lodestone::test
