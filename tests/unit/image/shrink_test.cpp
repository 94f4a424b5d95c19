// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "lodestone/image/image.h"
#include "pictures.h"

namespace lodestone::image {
namespace {

TEST(Shrunk, LeavesWhatIsSmallEnough) {
  const Image picture = noise(64, 20, 1);
  const Image same = shrunk(picture, 64);
  EXPECT_EQ(same.width, 64u);
  EXPECT_EQ(same.height, 20u);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(same.channels[i].values, picture.channels[i].values);
}

TEST(Shrunk, IsTheMeanOfEveryBlock) {
  Image picture = noise(64, 32, 2);
  Image small = shrunk(picture, 16);
  ASSERT_EQ(small.width, 16u);
  ASSERT_EQ(small.height, 8u);
  for (const char* name : {"R", "G", "B"}) {
    for (uint32_t y = 0; y < 8; ++y) {
      for (uint32_t x = 0; x < 16; ++x) {
        float sum = 0;
        for (uint32_t i = 0; i < 16; ++i) sum += sample(picture, name, 4 * x + i % 4, 4 * y + i / 4);
        EXPECT_NEAR(sample(small, name, x, y), sum / 16, 1e-5f) << name << " " << x << " " << y;
      }
    }
  }
}

TEST(Shrunk, KeepsProportionsAndColourWhereSidesDoNotDivide) {
  const Image small = shrunk(plain(1030, 517, 0.25f, 0.5f, 0.75f), 512);
  EXPECT_EQ(small.width, 344u);
  EXPECT_EQ(small.height, 173u);
  const float colour[] = {0.25f, 0.5f, 0.75f};
  for (size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(small.channels[i].values.size(), 344u * 173u);
    for (float value : small.channels[i].values) ASSERT_NEAR(value, colour[i], 1e-5f);
  }
}

}  // namespace
}  // namespace lodestone::image
