// SPDX-License-Identifier: MIT
#include "lodestone/scene/pose.h"

#include <gtest/gtest.h>

#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/base/parallel.h"

namespace lodestone::scene {
namespace {

// The triangle (0,0,0) (1,0,0) (0,1,0) with the targets "up" (all vertices by +z) and "wide" (vertex 1 by
// +x).
Mesh morphing_triangle() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.triangles = {{0, 1, 2}};
  mesh.parts = {{0, 1, none}};
  mesh.targets = {{"up", {0, 1, 2}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {}, {}},
                  {"wide", {1}, {{3, 0, 0}}, {}, {}}};
  mesh.weights = {0, 0};
  return mesh;
}

Scene one_node() {
  Scene scene;
  scene.name = "test";
  scene.meshes = {morphing_triangle()};
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  return scene;
}

Channel moving_x(uint32_t node, float to) {
  return {node, Channel::Path::translation, Channel::Interpolation::linear, {0, 1}, {0, 0, 0, to, 0, 0}};
}

void expect_usage_error(const std::function<void()>& function, const std::string& mentions) {
  try {
    function();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find(mentions), std::string::npos) << error.what();
  }
}

TEST(FindAnimation, ByNameThenByCaseThenByNumber) {
  Scene scene;
  scene.animations = {{"walk", {}}, {"Run", {}}, {"run", {}}, {"1", {}}};
  EXPECT_EQ(find_animation(scene, "run"), 2u);
  EXPECT_EQ(find_animation(scene, "Run"), 1u);
  EXPECT_EQ(find_animation(scene, "WALK"), 0u);
  EXPECT_EQ(find_animation(scene, "1"), 3u) << "a name before a number";
  EXPECT_EQ(find_animation(scene, "2"), 2u);
  EXPECT_EQ(find_animation(scene, ""), 0u);
  EXPECT_EQ(find_animation({}, ""), none);
}

TEST(FindAnimation, UnknownNamesListTheClips) {
  Scene scene;
  scene.animations = {{"walk", {}}, {"run", {}}};
  expect_usage_error([&] { find_animation(scene, "swim"); }, "walk, run");
  expect_usage_error([&] { find_animation(scene, "2"); }, "walk, run");
  expect_usage_error([] { find_animation({}, "swim"); }, "no animation");
}

TEST(Evaluate, ChildrenMoveWithTheirParents) {
  Scene scene = one_node();
  scene.nodes.resize(3);
  scene.nodes[1].parent = 0;
  scene.nodes[1].scale = {2, 2, 2};
  scene.nodes[2].parent = 1;
  scene.nodes[2].translation = {0, 1, 0};
  scene.animations = {{"", {moving_x(0, 10)}}};
  validate(scene);
  EXPECT_EQ(evaluate(scene, 0, 0.5f).node_world.at(2)[3], glm::vec4(5, 2, 0, 1));
  EXPECT_EQ(evaluate(scene, none, 0.5f).node_world.at(2)[3], glm::vec4(0, 2, 0, 1));
}

TEST(Evaluate, OverflowIsAnError) {
  Scene scene;
  scene.nodes.resize(2);
  scene.nodes[0].scale = glm::vec3(1e30f);
  scene.nodes[1] = scene.nodes[0];
  scene.nodes[1].parent = 0;
  EXPECT_THROW(evaluate(scene, none, 0), Error);
}

TEST(OverrideWeights, ByNameOnEveryMeshThatHasIt) {
  Scene scene = one_node();
  scene.nodes.push_back(scene.nodes[0]);
  scene.nodes.emplace_back();
  Pose pose = evaluate(scene, none, 0);
  override_weights(scene, {{"wide", 0.5f}, {"0", 0.25f}}, pose);
  EXPECT_EQ(pose.weights.at(0), (std::vector<float>{0.25f, 0.5f}));
  EXPECT_EQ(pose.weights.at(1), (std::vector<float>{0.25f, 0.5f}));
  EXPECT_TRUE(pose.weights.at(2).empty());
}

TEST(OverrideWeights, ATargetNamedLikeANumberComesFirst) {
  Scene scene = one_node();
  scene.meshes[0].targets[0].name = "1";
  Pose pose = evaluate(scene, none, 0);
  override_weights(scene, {{"1", 0.5f}}, pose);
  EXPECT_EQ(pose.weights.at(0), (std::vector<float>{0.5f, 0}));
}

TEST(OverrideWeights, UnknownNamesListTheTargets) {
  const Scene scene = one_node();
  Pose pose = evaluate(scene, none, 0);
  expect_usage_error([&] { override_weights(scene, {{"down", 1}}, pose); }, "up, wide");
  expect_usage_error([&] { override_weights(scene, {{"2", 1}}, pose); }, "up, wide");
  expect_usage_error(
      [&] {
        override_weights(scene, {{"up", std::numeric_limits<float>::quiet_NaN()}}, pose);
      },
      "up");
}

Scene skinned() {
  Scene scene = one_node();
  Mesh& mesh = scene.meshes[0];
  mesh.first_influence = {0, 1, 3, 4};
  mesh.influences = {{0, 1}, {0, 0.5f}, {1, 0.5f}, {1, 1}};
  scene.nodes.resize(3);
  scene.nodes[0].skin = 0;
  scene.nodes[0].translation = {100, 100, 100};  // a skinned mesh does not follow its own node
  scene.skins = {{"", {1, 2}, {glm::mat4(1), glm::mat4(1)}}};
  scene.skins[0].inverse_binds[1][3] = {0, -1, 0, 1};
  scene.animations = {{"", {moving_x(2, 8)}}};
  return scene;
}

TEST(Palette, IsTheWorldOfTheJointTimesItsInverseBind) {
  const Scene scene = skinned();
  validate(scene);
  const std::vector<glm::mat4> matrices = palette(scene, evaluate(scene, 0, 1), 0);
  ASSERT_EQ(matrices.size(), 2u);
  EXPECT_EQ(matrices[0], glm::mat4(1));
  EXPECT_EQ(matrices[1][3], glm::vec4(8, -1, 0, 1));
  const Scene rigid = one_node();
  EXPECT_EQ(palette(rigid, evaluate(rigid, none, 0), 0).size(), 1u);
}

TEST(PoseBounds, MorphsBeforeItSkins) {
  Scene scene = skinned();
  Pose pose = evaluate(scene, 0, 1);
  Bounds b = pose_bounds(scene, pose);
  // Vertex 0 stays, vertex 1 goes half way (8, -1), vertex 2 all the way.
  EXPECT_EQ(b.lo, glm::vec3(0, -0.5f, 0));
  EXPECT_EQ(b.hi, glm::vec3(8, 0, 0));
  override_weights(scene, {{"wide", 2}}, pose);
  b = pose_bounds(scene, pose);
  EXPECT_EQ(b.hi, glm::vec3(1 + 6 + 4, 0, 0));
}

TEST(PoseBounds, LeavesOutVerticesWithoutTriangles) {
  Scene scene = one_node();
  scene.meshes[0].positions.push_back({100, 0, 0});
  const Bounds b = pose_bounds(scene, evaluate(scene, none, 0));
  EXPECT_EQ(b.hi, glm::vec3(1, 1, 0));
}

TEST(PoseBounds, OfASceneWithoutMeshesAreEmpty) {
  Scene scene;
  scene.nodes.resize(1);
  EXPECT_TRUE(pose_bounds(scene, evaluate(scene, none, 0)).empty);
}

// A strip long enough to be split, with its ends in the first and in the last block, and its top in the
// middle.
TEST(PoseBounds, AreTheSameForAnyNumberOfThreads) {
  constexpr uint32_t triangles = 20000;
  Scene scene = one_node();
  Mesh& mesh = scene.meshes[0];
  mesh = {};
  for (uint32_t v = 0; v < triangles + 2; ++v)
    mesh.positions.emplace_back(float(v), v == triangles / 2 ? 7 : float(v % 3), 0);
  for (uint32_t t = 0; t < triangles; ++t) mesh.triangles.emplace_back(t, t + 1, t + 2);
  mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
  mesh.parts = {{0, triangles, none}};
  for (const uint32_t threads : {1u, 2u, 3u, 0u}) {
    set_thread_count(threads);
    const Bounds b = pose_bounds(scene, evaluate(scene, none, 0));
    EXPECT_EQ(b.lo, glm::vec3(0)) << threads;
    EXPECT_EQ(b.hi, glm::vec3(float(triangles + 1), 7, 0)) << threads;
  }
  set_thread_count(0);
}

TEST(PoseBounds, OverflowIsAnError) {
  Scene scene = one_node();
  scene.meshes[0].positions[1] = {3e38f, 0, 0};
  scene.nodes[0].scale = glm::vec3(10);
  EXPECT_THROW(pose_bounds(scene, evaluate(scene, none, 0)), Error);
}

}  // namespace
}  // namespace lodestone::scene
