// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "runs.h"

namespace lodestone::report {
namespace {

TEST(SumByName, AddsDispatchesOfOneNameInOrderOfFirstAppearance) {
  const auto sums =
      sum_by_name({testing::device_dispatch("blend", 0, 1.5), testing::device_dispatch("trace", 2, 4),
                   testing::device_dispatch("blend", 6, 2.5)});
  ASSERT_EQ(sums.size(), 2u);
  EXPECT_EQ(sums[0].name, "blend");
  EXPECT_EQ(sums[0].calls, 2u);
  EXPECT_EQ(sums[0].device_ms, 4.0);
  EXPECT_EQ(sums[0].wall_ms, 6.0);
  EXPECT_EQ(sums[0].invocations, 128u);
  EXPECT_EQ(sums[1].name, "trace");
  EXPECT_EQ(sums[1].calls, 1u);
}

TEST(SumByName, LeavesOutDispatchesWithoutDeviceTime) {
  const auto sums =
      sum_by_name({testing::dispatch("trace", 0, 27), testing::device_dispatch("trace", 30, 0.8)});
  ASSERT_EQ(sums.size(), 1u);
  EXPECT_EQ(sums[0].device_ms, 0.8);
  EXPECT_EQ(sum_by_name({testing::dispatch("trace", 0, 27)})[0].device_ms, std::nullopt);
}

TEST(SumByName, AddsCountersAndHasNoneWhereNothingWasCounted) {
  const auto counted =
      sum_by_name({testing::counted_dispatch("trace", 100), testing::counted_dispatch("trace", 11)});
  ASSERT_TRUE(counted[0].counters);
  EXPECT_EQ(counted[0].counters->rays, 111u);
  EXPECT_EQ(counted[0].counters->node_visits, 1110u);
  EXPECT_EQ(counted[0].counters->bytes_read, 16000000u);
  EXPECT_FALSE(sum_by_name({testing::dispatch("trace", 0, 1)})[0].counters);
}

TEST(Counters, ActiveLanesIsTheShareOfSubgroupSteps) {
  EXPECT_EQ(testing::counted_dispatch("trace", 1).counters->active_lanes(), 0.75);
  EXPECT_EQ(Counters().active_lanes(), std::nullopt);
}

}  // namespace
}  // namespace lodestone::report
