// SPDX-License-Identifier: MIT
#include "lodestone/image/colour_scale.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lodestone/image/colour_map.h"

namespace lodestone::image {
namespace {

Image grey(uint32_t width, uint32_t height) {
  Image picture;
  picture.width = width;
  picture.height = height;
  picture.linear = false;
  for (const char* name : {"R", "G", "B"}) {
    std::vector<float>& values = picture.add(name).values;
    std::fill(values.begin(), values.end(), 0.5f);
  }
  return picture;
}

const std::vector<Mark> marks = {{0, "0.5"}, {0.5f, "a long label that does not fit"}, {1, "3"}};

TEST(ColourScale, StandsBelowThePicture) {
  const Image picture = grey(300, 20);
  const Image whole = with_colour_scale(picture, "Title", marks);
  EXPECT_EQ(whole.width, 300u);
  EXPECT_GT(whole.height, 20u + 30);
  EXPECT_FALSE(whole.linear);
  for (const Channel& channel : picture.channels) {
    EXPECT_TRUE(
        std::equal(channel.values.begin(), channel.values.end(), whole.find(channel.name)->values.begin()));
  }
}

TEST(ColourScale, ShowsAllColoursInOrder) {
  const Image whole = with_colour_scale(grey(200, 1), "", {});
  // The row in the middle of the bar: of letters and gaps there are as many above as below.
  const std::vector<float>& red = whole.find("R")->values;
  const size_t row = size_t(1 + (whole.height - 1) / 2) * whole.width;
  EXPECT_NEAR(red[row + 4], heat(0)[0], 0.02f);
  EXPECT_NEAR(red[row + 100], heat(0.5f)[0], 0.02f);
  EXPECT_NEAR(red[row + 195], heat(1)[0], 0.02f);
}

TEST(ColourScale, FitsPicturesOfAnyWidth) {
  for (const uint32_t width : {1u, 2u, 8u, 9u, 10u, 40u, 5000u})
    EXPECT_EQ(with_colour_scale(grey(width, 2), "Title", marks).width, width);
}

}  // namespace
}  // namespace lodestone::image
