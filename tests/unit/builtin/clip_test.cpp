// SPDX-License-Identifier: MIT
// The animations of the built-in scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "lodestone/scene/load.h"
#include "lodestone/scene/pose.h"

namespace lodestone {
namespace {

using scene::Pose;
using scene::Scene;

class LoopingClip : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, LoopingClip,
                         testing::Values("head", "room", "spheres", "teapots", "terrain"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(LoopingClip, EndsAsItBegins) {
  const Scene scene = scene::make_builtin(GetParam());
  ASSERT_EQ(scene.animations.size(), 1u);
  const Pose first = scene::evaluate(scene, 0, 0);
  const Pose last = scene::evaluate(scene, 0, scene.animations[0].duration());
  EXPECT_EQ(first.weights, last.weights);
  EXPECT_EQ(first.node_world, last.node_world);
}

class MorphingClip : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, MorphingClip, testing::Values("head", "spheres", "terrain"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(MorphingClip, MovesInBetween) {
  const Scene scene = scene::make_builtin(GetParam());
  const Pose first = scene::evaluate(scene, 0, 0);
  const Pose middle = scene::evaluate(scene, 0, 0.45f * scene.animations[0].duration());
  EXPECT_NE(first.weights, middle.weights);
}

TEST(HeadClip, LastsTwoSecondsAndIsCalledExpressions) {
  const Scene scene = scene::make_builtin("head");
  EXPECT_EQ(scene.animations.at(0).name, "Expressions");
  EXPECT_EQ(scene.animations.at(0).duration(), 2);
}

TEST(HeadClip, KeepsWeightsBetweenZeroAndOne) {
  const Scene scene = scene::make_builtin("head");
  for (int frame = 0; frame <= 120; ++frame)
    for (const std::vector<float>& weights : scene::evaluate(scene, 0, float(frame) / 60).weights)
      for (const float weight : weights) {
        ASSERT_GE(weight, 0);
        ASSERT_LE(weight, 1);
      }
}

// Parts that share a shape must be told the same at all times, else teeth leave their jaw.
TEST(HeadClip, MovesAllPartsTogether) {
  const Scene scene = scene::make_builtin("head");
  for (const float time : {0.2f, 0.5f, 0.9f, 1.5f}) {
    const Pose pose = scene::evaluate(scene, 0, time);
    std::map<std::string, float> told;
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
      if (scene.nodes[n].mesh == scene::none) continue;
      const scene::Mesh& mesh = scene.meshes[scene.nodes[n].mesh];
      for (size_t t = 0; t < mesh.targets.size(); ++t) {
        const auto known = told.emplace(mesh.targets[t].name, pose.weights[n][t]).first;
        EXPECT_EQ(known->second, pose.weights[n][t])
            << mesh.name << " " << mesh.targets[t].name << " " << time;
      }
    }
  }
}

TEST(HeadClip, BlinksWinksAndIsSurprised) {
  const Scene scene = scene::make_builtin("head");
  const auto strongest = [&](const std::string& shape) {
    float most = 0;
    for (int frame = 0; frame <= 48; ++frame) {
      const Pose pose = scene::evaluate(scene, 0, float(frame) / 24);
      for (size_t n = 0; n < scene.nodes.size(); ++n) {
        if (scene.nodes[n].mesh == scene::none) continue;
        const scene::Mesh& mesh = scene.meshes[scene.nodes[n].mesh];
        for (size_t t = 0; t < mesh.targets.size(); ++t)
          if (mesh.targets[t].name == shape) most = std::max(most, pose.weights[n][t]);
      }
    }
    return most;
  };
  for (const char* shape : {"blinkLeft", "blinkRight", "surprise"})
    EXPECT_GT(strongest(shape), 0.9f) << shape;
  for (const char* shape : {"jawOpen", "smile", "grin", "lookLeft", "browUp"})
    EXPECT_GT(strongest(shape), 0.3f) << shape;
}

}  // namespace
}  // namespace lodestone
