// SPDX-License-Identifier: MIT
#include "lodestone/host/hazards.h"

#include <gtest/gtest.h>

#include <vector>

namespace lodestone::host {
namespace {

BufferUse read(uint32_t buffer) {
  return {buffer, true, false};
}
BufferUse write(uint32_t buffer) {
  return {buffer, false, true};
}

bool enter(HazardTracker& tracker, std::vector<BufferUse> uses) {
  return tracker.enter(uses);
}

TEST(HazardTracker, LetsReadersRunTogether) {
  HazardTracker tracker;
  EXPECT_FALSE(enter(tracker, {read(1), write(2)}));
  EXPECT_FALSE(enter(tracker, {read(1), write(3)}));
  EXPECT_FALSE(enter(tracker, {read(1)}));
}

TEST(HazardTracker, OrdersReadAfterWrite) {
  HazardTracker tracker;
  EXPECT_FALSE(enter(tracker, {write(1)}));
  EXPECT_TRUE(enter(tracker, {read(1)}));
  EXPECT_FALSE(enter(tracker, {read(1)}));
}

TEST(HazardTracker, OrdersWriteAfterRead) {
  HazardTracker tracker;
  EXPECT_FALSE(enter(tracker, {read(1)}));
  EXPECT_TRUE(enter(tracker, {write(1)}));
}

TEST(HazardTracker, OrdersWriteAfterWrite) {
  HazardTracker tracker;
  EXPECT_FALSE(enter(tracker, {write(1)}));
  EXPECT_TRUE(enter(tracker, {write(1)}));
  EXPECT_TRUE(enter(tracker, {write(1)}));
}

TEST(HazardTracker, ForgetsWhatABarrierHasOrdered) {
  HazardTracker tracker;
  EXPECT_FALSE(enter(tracker, {write(1), write(2)}));
  EXPECT_TRUE(enter(tracker, {read(1), write(3)}));
  EXPECT_FALSE(enter(tracker, {read(2)}));  // written before the same barrier
  EXPECT_TRUE(enter(tracker, {read(3)}));
  tracker.clear();
  EXPECT_FALSE(enter(tracker, {write(3)}));
}

TEST(HazardTracker, TakesABufferThatIsBoundTwice) {
  HazardTracker tracker;
  EXPECT_FALSE(enter(tracker, {read(1), write(1)}));
  EXPECT_TRUE(enter(tracker, {read(1)}));
}

}  // namespace
}  // namespace lodestone::host
