// SPDX-License-Identifier: MIT
#include "lodestone/layout/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lodestone::layout {
namespace {

TEST(Motion, BetweenTwoPointsNeverLeavesTheirInterval) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-20, 20), unit(-1, 1);
  std::uniform_int_distribution<uint32_t> step(0, 1u << 24);
  uint32_t outside = 0;  // without the clamp
  for (int i = 0; i < 1000000; ++i) {
    const float a = unit(random) * std::exp2(exponent(random));
    const float b = i % 2 == 0 ? std::nextafter(a, i % 4 == 0 ? 1e9f : -1e9f)
                               : unit(random) * std::exp2(exponent(random));
    const float f = i % 3 == 0 ? 1.0f : static_cast<float>(step(random)) * 0x1p-24f;
    const float at = moved3({a, b, a}, {b, a, a}, f).x;
    ASSERT_GE(at, std::min(flush_tiny(a), flush_tiny(b)));
    ASSERT_LE(at, std::max(flush_tiny(a), flush_tiny(b)));
    const float rounded = a + (b - a) * f;
    outside += rounded < std::min(a, b) || rounded > std::max(a, b) ? 1 : 0;
  }
  EXPECT_GT(outside, 0u) << "the clamp has nothing to do";
  EXPECT_EQ(moved1(3, 7, 0), 3);
  EXPECT_EQ(moved1(3, 7, 1), 7);
  EXPECT_EQ(moved1(3, 7, 0.5f), 5);
}

TEST(Motion, EveryTimeLiesInASegment) {
  for (uint32_t segments = 1; segments <= most_segments; ++segments) {
    EXPECT_EQ(moment_of(0, segments).segment, 0u);
    EXPECT_EQ(moment_of(0, segments).fraction, 0);
    EXPECT_EQ(moment_of(1, segments).segment, segments - 1);
    EXPECT_EQ(moment_of(1, segments).fraction, 1);
    for (uint32_t i = 0; i < 1000; ++i) {
      const float time = static_cast<float>(i) / 1000;
      const Moment moment = moment_of(time, segments);
      ASSERT_LT(moment.segment, segments);
      ASSERT_GE(moment.fraction, 0);
      ASSERT_LE(moment.fraction, 1);
      ASSERT_NEAR((static_cast<float>(moment.segment) + moment.fraction) / static_cast<float>(segments), time,
                  1e-6f);
    }
  }
}

}  // namespace
}  // namespace lodestone::layout
