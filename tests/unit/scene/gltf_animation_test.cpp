// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_builder.h"
#include "lodestone/scene/pose.h"

namespace lodestone::scene {
namespace {

// Moves node 0 along one channel.
Scene animated(GltfBuilder& gltf, const char* path, const char* interpolation, int times, int values) {
  json sampler = {{"input", times}, {"output", values}};
  if (interpolation != nullptr) sampler["interpolation"] = interpolation;
  gltf.append("animations", {{"name", "clip"},
                             {"samplers", {sampler}},
                             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
  return gltf.load();
}

float x_at(const Scene& scene, float time) {
  return evaluate(scene, 0, time).node_world.at(0)[3].x;
}

TEST(GltfAnimation, LinearIsTheDefaultAndClampsAtItsEnds) {
  GltfBuilder gltf;
  gltf.append("nodes", json::object());
  const Scene scene = animated(gltf, "translation", nullptr, gltf.floats({1, 2, 4}, "SCALAR"),
                               gltf.floats({0, 0, 0, 10, 0, 0, 20, 0, 0}, "VEC3"));
  EXPECT_EQ(scene.animations.at(0).duration(), 4);
  EXPECT_EQ(x_at(scene, 0), 0);
  EXPECT_EQ(x_at(scene, 1), 0);
  EXPECT_EQ(x_at(scene, 1.25f), 2.5f);
  EXPECT_EQ(x_at(scene, 2), 10);
  EXPECT_EQ(x_at(scene, 3), 15);
  EXPECT_EQ(x_at(scene, 9), 20);
}

TEST(GltfAnimation, StepHoldsUntilTheNextKey) {
  GltfBuilder gltf;
  gltf.append("nodes", json::object());
  const Scene scene = animated(gltf, "translation", "STEP", gltf.floats({0, 1}, "SCALAR"),
                               gltf.floats({3, 0, 0, 7, 0, 0}, "VEC3"));
  EXPECT_EQ(x_at(scene, 0.999f), 3);
  EXPECT_EQ(x_at(scene, 1), 7);
}

TEST(GltfAnimation, CubicSplineIsAHermiteCurveWithTangentsPerSecond) {
  GltfBuilder gltf;
  gltf.append("nodes", json::object());
  // In-tangent, value, out-tangent of keys at 0 s and 2 s; the span of 2 s doubles the tangents.
  const Scene scene = animated(gltf, "translation", "CUBICSPLINE", gltf.floats({0, 2}, "SCALAR"),
                               gltf.floats({99, 0, 0, 1, 0, 0, 3, 0, 0, 5, 0, 0, 2, 0, 0, 99, 0, 0}, "VEC3"));
  const auto hermite = [](float u) {
    const float u2 = u * u, u3 = u2 * u;
    return (2 * u3 - 3 * u2 + 1) * 1 + 2 * (u3 - 2 * u2 + u) * 3 + (-2 * u3 + 3 * u2) * 2 + 2 * (u3 - u2) * 5;
  };
  EXPECT_EQ(x_at(scene, -1), 1);
  EXPECT_EQ(x_at(scene, 0), 1);
  EXPECT_NEAR(x_at(scene, 0.5f), hermite(0.25f), 1e-5f);
  EXPECT_NEAR(x_at(scene, 1), hermite(0.5f), 1e-5f);
  EXPECT_EQ(x_at(scene, 2), 2);
  EXPECT_EQ(x_at(scene, 3), 2);
}

TEST(GltfAnimation, RotationsTakeTheShorterArc) {
  GltfBuilder gltf;
  gltf.append("nodes", json::object());
  // From the identity to a quarter turn around z, given as the far quaternion.
  const float h = std::sqrt(0.5f);
  const Scene scene = animated(gltf, "rotation", "LINEAR", gltf.floats({0, 1}, "SCALAR"),
                               gltf.floats({0, 0, 0, 1, 0, 0, -h, -h}, "VEC4"));
  for (float t : {0.0f, 0.25f, 0.5f, 1.0f}) {
    const glm::vec4 p = evaluate(scene, 0, t).node_world.at(0) * glm::vec4(1, 0, 0, 0);
    EXPECT_NEAR(p.x, std::cos(t * M_PI / 2), 1e-6) << t;
    EXPECT_NEAR(p.y, std::sin(t * M_PI / 2), 1e-6) << t;
  }
}

TEST(GltfAnimation, ReadsNormalizedShortRotations) {
  GltfBuilder gltf;
  gltf.append("nodes", json::object());
  const Scene scene = animated(gltf, "rotation", "STEP", gltf.floats({0}, "SCALAR"),
                               gltf.accessor<int16_t>({0, 0, 32767, 0}, "VEC4", i16, {{"normalized", true}}));
  const glm::vec4 p = evaluate(scene, 0, 0).node_world.at(0) * glm::vec4(1, 0, 0, 0);
  EXPECT_NEAR(p.x, -1, 1e-6);
}

TEST(GltfAnimation, MovesMorphWeights) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  const json target = {{"POSITION", gltf.floats(std::vector<float>(9, 1), "VEC3")}};
  gltf.primitive(mesh)["targets"] = {target, target};
  const Scene scene =
      animated(gltf, "weights", "LINEAR", gltf.floats({0, 1}, "SCALAR"),
               gltf.accessor<uint8_t>({0, 255, 255, 0}, "SCALAR", u8, {{"normalized", true}}));
  EXPECT_EQ(evaluate(scene, 0, 0).weights.at(0), (std::vector<float>{0, 1}));
  EXPECT_EQ(evaluate(scene, 0, 0.25f).weights.at(0), (std::vector<float>{0.25f, 0.75f}));
  EXPECT_EQ(evaluate(scene, none, 0.25f).weights.at(0), (std::vector<float>{0, 0}));
}

TEST(GltfAnimation, SplinesOfWeightsAreGroupedByKey) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  const json target = {{"POSITION", gltf.floats(std::vector<float>(9, 1), "VEC3")}};
  gltf.primitive(mesh)["targets"] = {target, target};
  const Scene scene = animated(gltf, "weights", "CUBICSPLINE", gltf.floats({0, 1}, "SCALAR"),
                               gltf.floats({0, 0, 0.5f, 0.25f, 0, 0, 0, 0, 1, 0.75f, 0, 0}, "SCALAR"));
  EXPECT_EQ(evaluate(scene, 0, 0).weights.at(0), (std::vector<float>{0.5f, 0.25f}));
  EXPECT_EQ(evaluate(scene, 0, 0.5f).weights.at(0), (std::vector<float>{0.75f, 0.5f}));
  EXPECT_EQ(evaluate(scene, 0, 1).weights.at(0), (std::vector<float>{1, 0.75f}));
}

TEST(GltfAnimation, ChannelsOfUnknownPathsAndWithoutNodesAreIgnored) {
  GltfBuilder gltf;
  gltf.append("nodes", json::object());
  const json sampler = {{"input", gltf.floats({0}, "SCALAR")}, {"output", gltf.floats({1, 2, 3}, "VEC3")}};
  gltf.append("animations", {{"samplers", {sampler}},
                             {"channels",
                              {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "pointer"}}}},
                               {{"sampler", 0}, {"target", {{"path", "translation"}}}},
                               {{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.animations.at(0).channels.size(), 1u);
  EXPECT_EQ(scene.animations[0].channels[0].path, Channel::Path::scale);
  EXPECT_EQ(scene.animations[0].name, "animation0") << "a clip without a name gets one";
}

}  // namespace
}  // namespace lodestone::scene
