// SPDX-License-Identifier: MIT
#include "lodestone/scene/interpolate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lodestone::scene {
namespace {

glm::quat turn(float angle) {
  return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
}

TEST(Slerp, MovesAtConstantSpeed) {
  for (float angle : {0.001f, 0.05f, 1.0f, 3.0f}) {
    for (float t : {0.0f, 0.25f, 0.5f, 1.0f}) {
      const glm::quat q = slerp_shortest(turn(0), turn(angle), t);
      EXPECT_NEAR(2 * std::asin(q.z), t * angle, 2e-6f) << angle << " " << t;
      EXPECT_NEAR(glm::length(q), 1, 1e-6f);
    }
  }
}

TEST(Slerp, TakesTheShorterArc) {
  const glm::quat q = slerp_shortest(turn(0), -turn(1), 0.5f);
  EXPECT_NEAR(std::abs(glm::dot(q, turn(0.5f))), 1, 1e-6f);
}

TEST(Slerp, OfOppositeQuaternionsIsTheirRotation) {
  const glm::quat q = slerp_shortest(turn(1), -turn(1), 0.5f);
  EXPECT_NEAR(std::abs(glm::dot(q, turn(1))), 1, 1e-6f);
}

TEST(Slerp, HalfTurnsApartStaysFiniteAndUnit) {
  const glm::quat q = slerp_shortest({1, 0, 0, 0}, {0, 1, 0, 0}, 0.5f);
  EXPECT_NEAR(glm::length(q), 1, 1e-6f);
  EXPECT_NEAR(q.w, std::sqrt(0.5f), 1e-6f);
}

TEST(Normalize, ZeroAndInfiniteQuaternionsBecomeTheIdentity) {
  const glm::quat identity(1, 0, 0, 0);
  EXPECT_EQ(normalized_or_identity({0, 0, 0, 0}), identity);
  EXPECT_EQ(normalized_or_identity({std::numeric_limits<float>::infinity(), 0, 0, 0}), identity);
  EXPECT_EQ(normalized_or_identity({0, 0, 3e38f, 0}), glm::quat(0, 0, 1, 0)) << "squares do not overflow";
  EXPECT_EQ(normalized_or_identity({0, 0, 0, 1e-38f}), glm::quat(0, 0, 0, 1)) << "nor vanish";
}

TEST(SampleChannel, ZeroLengthRotationKeysAreTheIdentity) {
  Channel channel{
      0, Channel::Path::rotation, Channel::Interpolation::linear, {0, 1}, {0, 0, 0, 0, 0, 0, 0, 0}};
  EXPECT_EQ(sample_channel(channel, 0.5f, 4), (std::vector<float>{0, 0, 0, 1}));
}

TEST(SampleChannel, ARotationAtAKeyIsThatKeyToTheBit) {
  Channel channel;
  channel.path = Channel::Path::rotation;
  for (int k = 0; k < 50; ++k) {
    const glm::quat q = turn(0.11f * float(k));
    channel.times.push_back(float(k));
    channel.values.insert(channel.values.end(), {q.x, q.y, q.z, q.w});
  }
  for (int k = 0; k < 50; ++k) {
    const glm::quat unit = normalized_or_identity(turn(0.11f * float(k)));
    EXPECT_EQ(sample_channel(channel, float(k), 4), (std::vector<float>{unit.x, unit.y, unit.z, unit.w}))
        << k;
  }
}

TEST(SampleChannel, SplineOfRotationsIsNormalized) {
  Channel channel;
  channel.path = Channel::Path::rotation;
  channel.interpolation = Channel::Interpolation::cubic_spline;
  channel.times = {0, 1};
  const float h = std::sqrt(0.5f);
  channel.values = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, h, h, 0, 0, 0, 0};
  const std::vector<float> q = sample_channel(channel, 0.5f, 4);
  EXPECT_NEAR(q[2], std::sin(M_PI / 8), 1e-6);
  EXPECT_NEAR(q[3], std::cos(M_PI / 8), 1e-6);
}

TEST(SampleChannel, OfASingleKeyIsConstant) {
  for (const auto interpolation :
       {Channel::Interpolation::linear, Channel::Interpolation::step, Channel::Interpolation::cubic_spline}) {
    Channel channel;
    channel.interpolation = interpolation;
    channel.times = {1};
    channel.values = {1, 2, 3};
    if (interpolation == Channel::Interpolation::cubic_spline) channel.values = {9, 9, 9, 1, 2, 3, 9, 9, 9};
    for (float time : {0.0f, 1.0f, 2.0f})
      EXPECT_EQ(sample_channel(channel, time, 3), (std::vector<float>{1, 2, 3}));
  }
}

TEST(SampleChannel, KeysATinyTimeApartStayFinite) {
  Channel channel;
  const float tiny = std::numeric_limits<float>::denorm_min();
  channel.times = {0, tiny, 2 * tiny};
  channel.values = {0, 0, 0, 1, 1, 1, 2, 2, 2};
  EXPECT_EQ(sample_channel(channel, tiny, 3), (std::vector<float>{1, 1, 1}));
  const float huge = std::numeric_limits<float>::max();
  channel.times = {-huge, 0, huge};
  EXPECT_EQ(sample_channel(channel, huge / 2, 3), (std::vector<float>{1.5f, 1.5f, 1.5f}));
}

}  // namespace
}  // namespace lodestone::scene
