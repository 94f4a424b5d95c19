// SPDX-License-Identifier: MIT
// FLIP against values worked out by hand from the paper's formulas, and against what any such measure must
// hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "lodestone/base/parallel.h"
#include "lodestone/image/colour.h"
#include "lodestone/image/flip.h"
#include "lodestone/image/flip_filters.h"
#include "pictures.h"

namespace lodestone::image {
namespace {

double mean_error(const Image& a, const Image& b) {
  return summarise(flip_error(a, b)).mean;
}

Image encoded(Image image) {
  image.linear = false;
  return image;
}

// Of two plain pictures of one colour each, as section 4.1.3 has it: filters leave them alone and no feature
// is detected, so that only the colour distance remains.
double plain_error(double hyab) {
  // Green against blue in Hunt-adjusted CIELAB: L 87.735 and 32.297, a' -75.62 and 25.58, b' 72.97 and
  // -34.84.
  const double green_blue = (87.735 - 32.297) + std::hypot(75.62 + 25.58, 72.97 + 34.84);
  const double largest = std::pow(green_blue, 0.7), distance = std::pow(hyab, 0.7), knee = 0.4 * largest;
  return distance < knee ? distance * 0.95 / knee : 0.95 + 0.05 * (distance - knee) / (largest - knee);
}

TEST(Flip, EqualPicturesHaveNoError) {
  for (const float error : flip_error(noise(70, 50, 1), noise(70, 50, 1))) ASSERT_EQ(error, 0);
}

TEST(Flip, BlackAgainstWhiteIsAsComputedByHand) {
  // Lightness 0 and 100, no chroma: a distance of 100, error 0.96739.
  const std::vector<float> errors = flip_error(plain(40, 30, 0, 0, 0), plain(40, 30, 1, 1, 1));
  for (const float error : errors) ASSERT_NEAR(error, plain_error(100), 1e-4);
  EXPECT_NEAR(errors[0], 0.9674, 1e-3);
}

TEST(Flip, GreenAgainstBlueIsTheLargestError) {
  for (const float error : flip_error(plain(40, 30, 0, 1, 0), plain(40, 30, 0, 0, 1)))
    ASSERT_NEAR(error, 1, 1e-5);
}

TEST(Flip, GreyStepIsAsComputedByHand) {
  // Luminances 0.18 and 0.20: lightness 116 cbrt(Y) - 16 = 49.496 and 51.837, a distance of 2.341.
  const double error = mean_error(plain(32, 32, 0.18f, 0.18f, 0.18f), plain(32, 32, 0.20f, 0.20f, 0.20f));
  EXPECT_NEAR(error, plain_error(116 * (std::cbrt(0.20) - std::cbrt(0.18))), 1e-4);
}

// The expected means are what the authors' own C++ implementation (FLIP 1.6) measures on the same pictures.
TEST(Flip, AgreesWithTheAuthorsImplementation) {
  const Image random = noise(200, 130, 1);
  EXPECT_NEAR(mean_error(random, noise(200, 130, 2)), 0.388485, 2e-5);
  Image brighter = random;
  for (Channel& channel : brighter.channels)
    for (float& value : channel.values) value = std::min(1.0f, value * 1.02f);
  EXPECT_NEAR(mean_error(random, brighter), 0.048310, 2e-5);

  const Image base = plain(100, 100, 0.2f, 0.3f, 0.4f);
  Image edge = base, dot = base;
  for (Channel& channel : edge.channels) {
    for (size_t i = 0; i < edge.pixels(); ++i) {
      if (i % 100 >= 50) channel.values[i] = 0.8f;
    }
  }
  EXPECT_NEAR(mean_error(base, edge), 0.404269, 2e-5);
  for (Channel& channel : dot.channels) channel.values[5050] = 1;
  EXPECT_NEAR(mean_error(base, dot), 0.000498, 2e-6);
}

TEST(Flip, IsSymmetricToTheBit) {
  const Image a = noise(90, 70, 1), b = noise(90, 70, 2);
  EXPECT_EQ(flip_error(a, b), flip_error(b, a));
}

TEST(Flip, StaysWithinZeroAndOne) {
  for (const float error : flip_error(noise(90, 70, 3), noise(90, 70, 4))) {
    ASSERT_GE(error, 0);
    ASSERT_LE(error, 1);
  }
}

TEST(Flip, GrowsWithTheNoise) {
  const Image base = noise(96, 96, 1), other = noise(96, 96, 2);
  double before = 0;
  for (const float amount : {0.01f, 0.03f, 0.1f, 0.3f, 1.0f}) {
    Image noisy = base;
    for (size_t c = 0; c < 3; ++c) {
      for (size_t i = 0; i < noisy.pixels(); ++i)
        noisy.channels[c].values[i] += amount * (other.channels[c].values[i] - noisy.channels[c].values[i]);
    }
    const double error = mean_error(base, noisy);
    EXPECT_GT(error, before) << amount;
    before = error;
  }
}

TEST(Flip, LinearAndEncodedFormsOfOnePictureLookTheSame) {
  const Image linear = noise(40, 40, 5);
  Image display = encoded(linear);
  for (Channel& channel : display.channels) {
    for (float& value : channel.values) value = srgb_encode(value);
  }
  for (const float error : flip_error(linear, display)) ASSERT_LT(error, 2e-3);
  // The same numbers taken as light or as code values are other colours.
  EXPECT_GT(mean_error(linear, encoded(linear)), 0.1);
}

TEST(Flip, WhatADisplayCannotShowMakesNoDifference) {
  Image bright = plain(20, 20, 1, 0, 1);
  Image brighter = plain(20, 20, 50, -3, 1);
  sample(bright, "G", 3, 3) = std::nanf("");  // shown as 0
  for (const float error : flip_error(bright, brighter)) ASSERT_EQ(error, 0);
}

TEST(Flip, SingleDotIsSeenAroundItAndNowhereElse) {
  const Image base = plain(101, 101, 0.2f, 0.2f, 0.2f);
  Image dot = base;
  for (Channel& channel : dot.channels) channel.values[50 * 101 + 50] = 1;
  const std::vector<float> errors = flip_error(base, dot);
  const int reach = make_flip_filters(default_pixels_per_degree).radius;
  for (int y = 0; y < 101; ++y) {
    for (int x = 0; x < 101; ++x) {
      if (std::abs(x - 50) <= reach && std::abs(y - 50) <= reach) continue;
      ASSERT_EQ(errors[size_t(y) * 101 + size_t(x)], 0) << x << ' ' << y;
    }
  }
  EXPECT_EQ(std::max_element(errors.begin(), errors.end()) - errors.begin(), 50 * 101 + 50);
  EXPECT_GT(errors[50 * 101 + 50], 0.1);
  // Four-fold symmetric, across the border of two bands of rows too.
  for (int d = 1; d <= reach; ++d) {
    const float right = errors[size_t(50 * 101 + 50 + d)];
    EXPECT_NEAR(right, errors[size_t(50 * 101 + 50 - d)], 1e-5);
    EXPECT_NEAR(right, errors[size_t((50 + d) * 101 + 50)], 1e-5);
    EXPECT_NEAR(right, errors[size_t((50 - d) * 101 + 50)], 1e-5);
  }
}

TEST(Flip, DifferenceInStructureCountsMoreThanInShade) {
  // A thin line draws the eye; the same light spread evenly does not.
  const Image base = plain(99, 99, 0.2f, 0.2f, 0.2f);
  Image line = base, spread = base;
  for (Channel& channel : line.channels) {
    for (size_t y = 0; y < 99; ++y) channel.values[y * 99 + 49] = 0.6f;
  }
  for (Channel& channel : spread.channels)
    for (float& value : channel.values) value = 0.2f + 0.4f / 99;
  EXPECT_GT(summarise(flip_error(base, line)).p99, 3 * summarise(flip_error(base, spread)).p99);
}

TEST(Flip, FewerPixelsADegreeShowMore) {
  const Image base = plain(60, 60, 0.2f, 0.2f, 0.2f);
  Image dot = base;
  for (Channel& channel : dot.channels) channel.values[30 * 60 + 30] = 1;
  const size_t centre = 30 * 60 + 30;
  EXPECT_GT(flip_error(base, dot, 20)[centre], flip_error(base, dot, 67)[centre]);
}

TEST(Flip, SmallestPicturesWork) {
  EXPECT_NEAR(mean_error(plain(1, 1, 0, 0, 0), plain(1, 1, 1, 1, 1)), 0.9674, 1e-3);
  EXPECT_NEAR(mean_error(plain(1, 200, 0, 0, 0), plain(1, 200, 1, 1, 1)), 0.9674, 1e-3);
}

TEST(Flip, NumberOfThreadsDoesNotMatter) {
  const Image a = noise(50, 300, 1), b = noise(50, 300, 2);
  set_thread_count(1);
  const std::vector<float> one = flip_error(a, b);
  set_thread_count(2);
  const std::vector<float> two = flip_error(a, b);
  set_thread_count(0);
  EXPECT_EQ(one, two);
}

TEST(Flip, RefusesWhatItCannotCompare) {
  Image grey;
  grey.width = grey.height = 4;
  grey.add("Y");
  EXPECT_THROW(flip_error(plain(4, 4, 0, 0, 0), plain(4, 5, 0, 0, 0)), std::invalid_argument);
  EXPECT_THROW(flip_error(grey, grey), std::invalid_argument);
  EXPECT_THROW(flip_error(plain(4, 4, 0, 0, 0), plain(4, 4, 0, 0, 0), 0), std::invalid_argument);
}

TEST(FlipFilters, SensitivitiesSumToOneAndDerivativesBalance) {
  for (const double resolution : {10.0, default_pixels_per_degree, 200.0}) {
    const FlipFilters filters = make_flip_filters(resolution);
    for (const auto& terms : filters.sensitivity) {
      double total = 0;
      for (const SeparableTerm& term : terms) {
        double line = 0;
        for (const float weight : term.kernel.weights) line += weight;
        total += term.weight * line * line;
      }
      EXPECT_NEAR(total, 1, 1e-5) << resolution;
    }
    for (const Kernel* kernel : {&filters.edge, &filters.point}) {
      double positive = 0, negative = 0;
      for (const float weight : kernel->weights) (weight > 0 ? positive : negative) += weight;
      EXPECT_NEAR(positive, 1, 1e-5) << resolution;
      EXPECT_NEAR(negative, -1, 1e-5) << resolution;
    }
  }
}

TEST(FlipFilters, BlueYellowIsBlurredMoreThanRedGreenMoreThanLuminance) {
  const FlipFilters filters = make_flip_filters(default_pixels_per_degree);
  double centre[3];
  for (size_t c = 0; c < 3; ++c) {
    centre[c] = 0;
    for (const SeparableTerm& term : filters.sensitivity[c]) {
      const double middle = term.kernel.weights[size_t(term.kernel.radius())];
      centre[c] += term.weight * middle * middle;
    }
  }
  EXPECT_GT(centre[1], centre[2]);
  EXPECT_GT(centre[0], centre[1]);
}

TEST(FlipSummary, PercentileIsTheNearestRank) {
  std::vector<float> errors(200);
  for (size_t i = 0; i < errors.size(); ++i) errors[i] = float(i + 1);
  std::reverse(errors.begin(), errors.end());
  EXPECT_EQ(summarise(errors).p99, 198);  // 198 of 200 are at most that
  EXPECT_EQ(summarise(errors).mean, 100.5);
  EXPECT_EQ(summarise({0.25f}).p99, 0.25);
  EXPECT_EQ(summarise({}).p99, 0);
}

}  // namespace
}  // namespace lodestone::image
