// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "lodestone/base/parallel.h"
#include "lodestone/image/compare.h"
#include "pictures.h"

namespace lodestone::image {
namespace {

const float inf = std::numeric_limits<float>::infinity();
const float nan = std::numeric_limits<float>::quiet_NaN();

const ChannelDifference& channel(const Comparison& comparison, const std::string& name) {
  for (const ChannelDifference& entry : comparison.channels) {
    if (entry.name == name) return entry;
  }
  throw std::out_of_range(name);
}

// A picture with depth and ids, as renders have them.
Image rendered(uint32_t width = 20, uint32_t height = 10) {
  Image image = noise(width, height, 7);
  image.add("depth.Z").values.assign(image.pixels(), 2);
  image.add_ids("id.mesh").ids.assign(image.pixels(), 3);
  return image;
}

uint32_t& id(Image& image, uint32_t x, uint32_t y) {
  return image.channels.back().ids.at(y * image.width + x);
}

// Nothing would fail these but what no bound on numbers keeps.
Thresholds generous() {
  Thresholds thresholds;
  thresholds.max = thresholds.mean = thresholds.rmse = 1e30;
  return thresholds;
}

TEST(Compare, EqualImagesPass) {
  const Comparison result = compare(rendered(), rendered(), {});
  EXPECT_TRUE(result.pass);
  EXPECT_TRUE(result.failures.empty());
  EXPECT_EQ(result.first_difference, "");
  EXPECT_EQ(result.max, 0);
  EXPECT_EQ(result.flip_mean, 0);
  EXPECT_EQ(result.flip_p99, 0);
  EXPECT_EQ(result.channels.size(), 5u);
}

TEST(Compare, WithoutThresholdsTheSmallestDifferenceFails) {
  Image other = rendered();
  float& value = sample(other, "G", 4, 6);
  value = std::nextafter(value, 2.0f);
  const Comparison result = compare(rendered(), other, {});
  EXPECT_FALSE(result.pass);
  EXPECT_EQ(result.failures.size(), 1u);
  EXPECT_EQ(result.first_difference.find("pixel (4, 6), channel G: "), 0u) << result.first_difference;
  EXPECT_EQ(channel(result, "G").different, 1u);
}

TEST(Compare, ZeroHasNoSign) {
  const Comparison result = compare(plain(2, 2, 0.0f, 0, 0), plain(2, 2, -0.0f, 0, 0), {});
  EXPECT_TRUE(result.pass);
}

TEST(Compare, MeasuresAreAsComputedByHand) {
  Image a = plain(2, 2, 0, 0, 0), b = a;
  sample(b, "R", 0, 0) = 0.5f;
  sample(b, "R", 1, 1) = -1;
  sample(b, "B", 0, 1) = 0.25f;
  const Comparison result = compare(a, b, {});
  EXPECT_EQ(channel(result, "R").max, 1);
  EXPECT_EQ(channel(result, "R").mean, 0.375);
  EXPECT_EQ(channel(result, "R").rmse, std::sqrt(1.25 / 4));
  EXPECT_EQ(channel(result, "B").mean, 0.0625);
  EXPECT_EQ(channel(result, "G").max, 0);
  EXPECT_EQ(result.max, 1);
  EXPECT_DOUBLE_EQ(result.mean, 1.75 / 12);
  EXPECT_DOUBLE_EQ(result.rmse, std::sqrt((0.25 + 1 + 0.0625) / 12));
  EXPECT_EQ(result.pixel_share, 0.75);
}

TEST(Compare, OtherSizeFailsWhateverTheThresholds) {
  for (const Image& other : {rendered(20, 11), rendered(19, 10), rendered(10, 20)}) {
    const Comparison result = compare(rendered(), other, generous());
    EXPECT_FALSE(result.pass);
    EXPECT_FALSE(result.same_size);
    EXPECT_EQ(result.first_difference.find("size: 20 x 10"), 0u) << result.first_difference;
    EXPECT_TRUE(result.channels.empty());
  }
}

TEST(Compare, MissingChannelFailsWhateverTheThresholds) {
  Image fewer = rendered();
  fewer.channels.erase(fewer.channels.begin() + 1);
  for (const bool swapped : {false, true}) {
    const Comparison result =
        swapped ? compare(fewer, rendered(), generous()) : compare(rendered(), fewer, generous());
    EXPECT_FALSE(result.pass);
    EXPECT_FALSE(result.same_channels);
    EXPECT_NE(result.first_difference.find("channel G"), std::string::npos) << result.first_difference;
  }
  Thresholds ignoring;
  ignoring.ignore = {"G"};
  EXPECT_TRUE(compare(rendered(), fewer, ignoring).pass);
}

TEST(Compare, NothingPassesWhereEveryChannelIsIgnored) {
  Thresholds ignoring;
  ignoring.ignore = {"R", "G", "B"};
  const Comparison result = compare(plain(2, 2, 0, 0, 0), plain(2, 2, 1, 1, 1), ignoring);
  EXPECT_FALSE(result.pass);
  EXPECT_EQ(result.failures.size(), 1u);
}

TEST(Compare, IdsAreNotFloatsOfTheSameName) {
  Image a = plain(2, 2, 0, 0, 0), b = a;
  a.add("id.mesh");
  b.add_ids("id.mesh");
  EXPECT_FALSE(compare(a, b, generous()).same_channels);
}

TEST(Compare, OrderOfChannelsDoesNotMatter) {
  Image other = rendered();
  std::swap(other.channels[0], other.channels[4]);
  EXPECT_TRUE(compare(rendered(), other, {}).pass);
}

TEST(Compare, EqualInfinitiesAndNansAreEqual) {
  Image a = rendered();
  sample(a, "depth.Z", 0, 0) = inf;
  sample(a, "depth.Z", 1, 0) = -inf;
  sample(a, "depth.Z", 2, 0) = nan;
  sample(a, "R", 3, 0) = nan;
  Image b = a;
  sample(b, "depth.Z", 2, 0) = -nan;
  const Comparison result = compare(a, b, {});
  EXPECT_TRUE(result.pass);
  EXPECT_EQ(channel(result, "depth.Z").non_finite, 0u);
  EXPECT_EQ(result.max, 0);
}

TEST(Compare, NonFiniteAgainstAnythingElseIsAlwaysADifference) {
  for (const auto& [left, right] :
       {std::pair{nan, 0.5f}, {0.5f, nan}, {nan, inf}, {inf, 0.0f}, {inf, -inf}}) {
    Image a = rendered(), b = rendered();
    sample(a, "depth.Z", 9, 9) = left;
    sample(b, "depth.Z", 9, 9) = right;
    Thresholds flip;
    flip.flip_mean = 1;
    for (const Thresholds& thresholds : {Thresholds(), generous(), flip}) {
      const Comparison result = compare(a, b, thresholds);
      EXPECT_FALSE(result.pass) << left << ' ' << right;
      EXPECT_EQ(channel(result, "depth.Z").non_finite, 1u);
      EXPECT_TRUE(std::isinf(result.max));
      EXPECT_TRUE(std::isinf(result.mean));
      EXPECT_TRUE(std::isinf(result.rmse));
      EXPECT_EQ(result.first_difference.find("pixel (9, 9), channel depth.Z"), 0u);
    }
  }
}

TEST(Compare, WholeChannelOfNansFails) {
  Image a = rendered();
  std::fill(a.channels[0].values.begin(), a.channels[0].values.end(), nan);
  Thresholds loose = generous();
  loose.flip_mean = loose.flip_p99 = 1;
  const Comparison result = compare(a, rendered(), loose);
  EXPECT_FALSE(result.pass);
  EXPECT_FALSE(result.flip_mean.has_value());
  EXPECT_EQ(channel(result, "R").non_finite, 200u);
}

TEST(Compare, ShareOfPixelsMayAllowNonFiniteSamplesAndIds) {
  Image other = rendered();
  sample(other, "depth.Z", 0, 0) = inf;
  id(other, 1, 0) = 4;
  Thresholds thresholds;
  thresholds.pixel_share = 0.01;  // 2 of 200
  Comparison result = compare(rendered(), other, thresholds);
  EXPECT_TRUE(result.pass);
  EXPECT_EQ(result.pixel_share, 0.01);
  thresholds.pixel_share = 0.009;
  result = compare(rendered(), other, thresholds);
  EXPECT_FALSE(result.pass);
  EXPECT_EQ(result.failures.size(), 1u);
}

TEST(Compare, IdsCompareExactlyAndStayOutOfTheMeasures) {
  Image other = rendered();
  id(other, 5, 5) = 0xffffffffu;
  const Comparison result = compare(rendered(), other, generous());
  EXPECT_FALSE(result.pass);
  EXPECT_EQ(result.max, 0);
  EXPECT_EQ(result.mean, 0);
  EXPECT_TRUE(channel(result, "id.mesh").ids);
  EXPECT_EQ(channel(result, "id.mesh").different, 1u);
  EXPECT_EQ(result.first_difference, "pixel (5, 5), channel id.mesh: 3 and 4294967295");
  Thresholds ignoring = generous();
  ignoring.ignore = {"id.mesh"};
  EXPECT_TRUE(compare(rendered(), other, ignoring).pass);
  ignoring.ignore = {"id"};  // the layer
  EXPECT_TRUE(compare(rendered(), other, ignoring).pass);
  ignoring.ignore = {"i", "id.", "mesh"};
  EXPECT_FALSE(compare(rendered(), other, ignoring).pass);
}

TEST(Compare, EachThresholdIsKeptAtItsValueAndBrokenBelow) {
  Image a = plain(10, 10, 0.5f, 0.5f, 0.5f), b = a;
  sample(b, "R", 2, 3) = 0.75f;
  const Comparison measured = compare(a, b, {});
  const std::pair<std::optional<double> Thresholds::*, double> bounds[] = {
      {&Thresholds::max, measured.max},
      {&Thresholds::mean, measured.mean},
      {&Thresholds::rmse, measured.rmse},
      {&Thresholds::flip_mean, *measured.flip_mean},
      {&Thresholds::flip_p99, *measured.flip_p99}};
  for (const auto& [member, value] : bounds) {
    ASSERT_GT(value, 0);
    Thresholds thresholds;
    thresholds.*member = value;
    EXPECT_TRUE(compare(a, b, thresholds).pass);
    thresholds.*member = value * 0.999;
    EXPECT_FALSE(compare(a, b, thresholds).pass);
    EXPECT_EQ(compare(a, b, thresholds).failures.size(), 1u);
  }
}

TEST(Compare, ThresholdOfZeroIsAThreshold) {
  Image other = rendered();
  sample(other, "R", 0, 0) += 0.5f;
  Thresholds thresholds;
  thresholds.max = 0;
  EXPECT_FALSE(compare(rendered(), other, thresholds).pass);
  EXPECT_TRUE(compare(rendered(), rendered(), thresholds).pass);
}

TEST(Compare, PixelsCountAgainstTheirOwnThreshold) {
  Image a = plain(10, 10, 0, 0, 0), b = a;
  for (uint32_t x = 0; x < 10; ++x) sample(b, "G", x, 0) = 0.1f * float(x);
  Thresholds thresholds;
  thresholds.pixel = 0.75;
  thresholds.pixel_share = 0.02;
  const Comparison result = compare(a, b, thresholds);
  EXPECT_EQ(result.pixel_share, 0.02);  // 0.8 and 0.9
  EXPECT_TRUE(result.pass);
  thresholds.pixel = 0.65;
  EXPECT_FALSE(compare(a, b, thresholds).pass);
  thresholds.pixel = 1;
  thresholds.pixel_share = 0;
  EXPECT_TRUE(compare(a, b, thresholds).pass);
}

TEST(Compare, FlipThresholdNeedsColours) {
  Image depth;
  depth.width = depth.height = 2;
  depth.add("depth.Z");
  Thresholds thresholds;
  thresholds.flip_mean = 1;
  EXPECT_FALSE(compare(depth, depth, thresholds).pass);
  thresholds.ignore = {"B"};
  EXPECT_FALSE(compare(plain(2, 2, 0, 0, 0), plain(2, 2, 0, 0, 0), thresholds).pass);
  EXPECT_TRUE(compare(depth, depth, {}).pass);
}

TEST(Compare, FirstDifferenceIsTheTopmostThenLeftmost) {
  Image other = rendered(300, 300);  // several ranges of pixels
  sample(other, "R", 200, 250) = 5;
  sample(other, "B", 199, 250) = 5;
  id(other, 7, 299) = 9;
  EXPECT_EQ(compare(rendered(300, 300), other, {}).first_difference.find("pixel (199, 250), channel B"), 0u);
}

TEST(Compare, NumberOfThreadsDoesNotMatter) {
  const Image a = noise(400, 400, 1), b = noise(400, 400, 2);
  set_thread_count(1);
  const std::string one = to_json(compare(a, b, {}), "a", "b");
  set_thread_count(2);
  const std::string two = to_json(compare(a, b, {}), "a", "b");
  set_thread_count(0);
  EXPECT_EQ(one, two);
}

TEST(ComparisonJson, HasAllMeasures) {
  Image other = rendered();
  sample(other, "R", 2, 3) += 0.5f;
  const auto json = nlohmann::json::parse(to_json(compare(rendered(), other, {}), "a.exr", "b.exr"));
  EXPECT_EQ(json["a"], "a.exr");
  EXPECT_EQ(json["b"], "b.exr");
  EXPECT_EQ(json["pass"], false);
  EXPECT_EQ(json["max"], 0.5);
  EXPECT_GT(json["flip_mean"], 0);
  EXPECT_EQ(json["failures"].size(), 1u);
  EXPECT_EQ(json["channels"].size(), 5u);
  EXPECT_EQ(json["channels"][0]["name"], "R");
  EXPECT_EQ(json["channels"][0]["type"], "float");
  EXPECT_EQ(json["channels"][4]["type"], "uint");
  EXPECT_TRUE(json["channels"][4]["max"].is_null());
}

TEST(ComparisonJson, KeysAreTheSameWhateverTheOutcome) {
  Image broken = rendered();
  sample(broken, "R", 0, 0) = nan;
  const auto keys = [](const Image& other) {
    std::vector<std::string> names;
    const auto json = nlohmann::json::parse(to_json(compare(rendered(), other, {}), "a", "b"));
    for (const auto& [name, value] : json.items()) names.push_back(name);
    return names;
  };
  EXPECT_EQ(keys(rendered()), keys(broken));
  EXPECT_EQ(keys(rendered()), keys(rendered(3, 3)));
}

TEST(ComparisonJson, WhatIsNotFiniteOrNotMeasuredIsNull) {
  Image broken = rendered();
  sample(broken, "R", 0, 0) = nan;
  const auto infinite = nlohmann::json::parse(to_json(compare(rendered(), broken, {}), "a", "b"));
  for (const char* key : {"max", "mean", "rmse", "flip_mean", "flip_p99"})
    EXPECT_TRUE(infinite[key].is_null()) << key;
  EXPECT_EQ(infinite["channels"][0]["non_finite"], 1);
  const auto resized = nlohmann::json::parse(to_json(compare(rendered(), rendered(3, 3), {}), "a", "b"));
  for (const char* key : {"max", "pixel_share", "flip_mean"}) EXPECT_TRUE(resized[key].is_null()) << key;
}

TEST(ComparisonJson, FileNamesNeedNotBeUtf8) {
  const std::string text = to_json(compare(rendered(), rendered(), {}), "\xff\xfe", "\"\n");
  EXPECT_EQ(nlohmann::json::parse(text)["b"], "\"\n");
}

}  // namespace
}  // namespace lodestone::image
