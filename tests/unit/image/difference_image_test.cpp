// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lodestone/image/colour_map.h"
#include "lodestone/image/compare.h"
#include "pictures.h"

namespace lodestone::image {
namespace {

uint64_t count(const Image& image, const Rgb& colour) {
  uint64_t pixels = 0;
  for (size_t i = 0; i < image.pixels(); ++i) {
    if (image.channels[0].values[i] == colour[0] && image.channels[1].values[i] == colour[1] &&
        image.channels[2].values[i] == colour[2])
      ++pixels;
  }
  return pixels;
}

Image encoded(Image image) {
  image.linear = false;
  return image;
}

TEST(DifferenceImage, OfEqualImagesIsBlackTwice) {
  const Image difference = difference_image(noise(30, 20, 1), noise(30, 20, 1));
  EXPECT_GE(difference.width, 60u);
  EXPECT_EQ(count(difference, {0, 0, 0}), 600u);
  EXPECT_EQ(count(difference, heat(0)), 600u);
}

TEST(DifferenceImage, ShowsTheDifferenceMagnified) {
  Image a = encoded(plain(30, 20, 0.5f, 0.5f, 0.5f)), b = a;
  sample(b, "R", 3, 4) = 0.75f;  // 0.25 apart: four times as much just fits
  sample(b, "G", 5, 4) = 0.625f;
  const Image difference = difference_image(a, b);
  EXPECT_EQ(count(difference, {1, 0, 0}), 1u);
  EXPECT_EQ(count(difference, {0, 0.5f, 0}), 1u);
  EXPECT_EQ(count(difference, {0, 0, 0}), 598u);
  EXPECT_FALSE(difference.linear);
}

TEST(DifferenceImage, MarksNonFiniteDifferences) {
  Image a = plain(30, 20, 0.5f, 0.5f, 0.5f), b = a;
  sample(b, "R", 3, 4) = std::nanf("");
  sample(b, "G", 5, 4) = std::numeric_limits<float>::infinity();
  EXPECT_EQ(count(difference_image(a, b), {1, 0, 1}), 2u);
}

TEST(DifferenceImage, WithoutColoursShowsTheLargestDifference) {
  Image a;
  a.width = 30;
  a.height = 20;
  a.add("depth.Z").values.assign(600, 7);
  a.add_ids("id.mesh");
  Image b = a;
  sample(b, "depth.Z", 1, 1) = 7.5f;
  b.channels[1].ids[0] = 1;
  const Image difference = difference_image(a, b);
  EXPECT_EQ(count(difference, {1, 1, 1}), 1u);
  EXPECT_EQ(count(difference, {0.5f, 0.5f, 0.5f}), 1u);
  EXPECT_EQ(count(difference, heat(1)), 1u);
  EXPECT_EQ(count(difference, heat(0.5f)), 1u);
}

TEST(DifferenceImage, RefusesOtherSizes) {
  EXPECT_THROW(difference_image(plain(2, 2, 0, 0, 0), plain(2, 3, 0, 0, 0)), std::invalid_argument);
}

TEST(ForDisplay, EncodesLinearLightAndLeavesTheRest) {
  Image linear = plain(2, 1, 0.5f, 4, -1);
  sample(linear, "R", 1, 0) = std::nanf("");
  const Image shown = for_display(linear);
  EXPECT_FALSE(shown.linear);
  EXPECT_NEAR(shown.find("R")->values[0], 0.735357f, 1e-6);  // 1.055 x 0.5^(1 / 2.4) - 0.055
  EXPECT_EQ(shown.find("R")->values[1], 0);
  EXPECT_NEAR(shown.find("G")->values[0], 1, 1e-6);
  EXPECT_EQ(shown.find("B")->values[0], 0);
  EXPECT_EQ(for_display(encoded(linear)).find("R")->values[0], 0.5f);
}

TEST(ForDisplay, StretchesAChannelWithoutColours) {
  Image depth;
  depth.width = 4;
  depth.height = 1;
  depth.add("depth.Z").values = {2, 4, 3, std::numeric_limits<float>::infinity()};
  const std::vector<float> expected = {0, 1, 0.5f, 1};
  for (const char* name : {"R", "G", "B"}) EXPECT_EQ(for_display(depth).find(name)->values, expected);
  Image ids;
  ids.width = 2;
  ids.height = 1;
  ids.add_ids("id.mesh").ids = {7, 7};
  EXPECT_EQ(for_display(ids).find("G")->values, std::vector<float>(2));
}

TEST(ColourMap, LightnessRisesAllTheWay) {
  float before = -1;
  for (int i = 0; i <= 256; ++i) {
    const Rgb colour = heat(float(i) / 256);
    // Luma: encoded values are close to lightness.
    const float luma = 0.2126f * colour[0] + 0.7152f * colour[1] + 0.0722f * colour[2];
    EXPECT_GT(luma, before) << i;
    EXPECT_GE(*std::min_element(colour.begin(), colour.end()), 0);
    EXPECT_LE(*std::max_element(colour.begin(), colour.end()), 1);
    before = luma;
  }
  EXPECT_EQ(heat(-1), heat(0));
  EXPECT_EQ(heat(2), heat(1));
}

}  // namespace
}  // namespace lodestone::image
