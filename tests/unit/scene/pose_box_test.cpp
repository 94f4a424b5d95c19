// SPDX-License-Identifier: MIT
#include "lodestone/scene/pose_box.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "lodestone/scene/load.h"

namespace lodestone::scene {
namespace {

// The box holds the true bounds and no side is farther from them than `slack` times their size.
void expect_around(const Scene& scene, const Pose& pose, float slack) {
  const Bounds box = PoseBox(scene).of(scene, pose), truth = pose_bounds(scene, pose);
  const glm::vec3 size = truth.hi - truth.lo;
  const float largest = std::max({size.x, size.y, size.z});
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(box.lo[axis], truth.lo[axis]);
    EXPECT_GE(box.hi[axis], truth.hi[axis]);
    EXPECT_GE(box.lo[axis], truth.lo[axis] - slack * largest);
    EXPECT_LE(box.hi[axis], truth.hi[axis] + slack * largest);
  }
}

Scene bent_strip(float second_weight) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  mesh.parts = {{0, 2, none}};
  mesh.first_influence = {0, 2, 4, 6, 8};
  for (int vertex = 0; vertex < 4; ++vertex) {
    mesh.influences.push_back({0, 1 - second_weight});
    mesh.influences.push_back({1, second_weight});
  }
  Scene scene;
  scene.name = "strip";
  scene.meshes = {mesh};
  scene.nodes.resize(3);
  scene.nodes[0].mesh = 0;
  scene.nodes[0].skin = 0;
  scene.skins.push_back({"skin", {1, 2}, {glm::mat4(1), glm::mat4(1)}});
  return scene;
}

TEST(PoseBox, HoldsWhatPosesDraw) {
  for (const char* name : {"builtin:head", "builtin:spheres", "builtin:terrain"}) {
    const Scene scene = load(name);
    const uint32_t animation = scene.animations.empty() ? none : 0;
    for (const float time : {0.0f, 0.3f, 0.8f}) expect_around(scene, evaluate(scene, animation, time), 1.0f);
  }
}

TEST(PoseBox, IsTightWhereNothingBends) {
  Scene scene = bent_strip(0);
  scene.meshes[0].first_influence.clear();
  scene.meshes[0].influences.clear();
  scene.nodes[0].skin = none;
  Pose pose = evaluate(scene, none, 0);
  pose.node_world[0] = glm::translate(glm::mat4(1), glm::vec3(5, -3, 2));
  expect_around(scene, pose, 0x1p-9f);
}

TEST(PoseBox, HoldsSkinsWhoseWeightsAreMeansAndThoseWhoseAreNot) {
  for (const float weight : {0.0f, 0.5f, 1.0f, -0.5f, 1.5f}) {
    const Scene scene = bent_strip(weight);
    Pose pose = evaluate(scene, none, 0);
    pose.node_world[1] = glm::translate(glm::mat4(1), glm::vec3(0, 4, 0));
    pose.node_world[2] = glm::translate(glm::mat4(1), glm::vec3(7, 0, -1));
    expect_around(scene, pose, 30.0f);
  }
}

TEST(PoseBox, IsEmptyWithoutTriangles) {
  Scene scene = bent_strip(0);
  scene.meshes[0].triangles.clear();
  EXPECT_TRUE(PoseBox(scene).of(scene, evaluate(scene, none, 0)).empty);
}

}  // namespace
}  // namespace lodestone::scene
