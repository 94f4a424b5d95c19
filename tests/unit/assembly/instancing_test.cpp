// SPDX-License-Identifier: MIT
#include "lodestone/scene/instancing.h"

#include <gtest/gtest.h>

#include "lodestone/scene/assembly.h"
#include "sample_scenes.h"

namespace lodestone::scene {
namespace {

using test::scene_of;
using test::strip;

// Of two meshes; the nodes 0 and 1 place one each.
Scene two_strips() {
  return scene_of({strip(4), strip(5)});
}

uint32_t place(Scene& scene, uint32_t mesh, uint32_t parent = none) {
  scene.nodes.emplace_back();
  scene.nodes.back().mesh = mesh;
  scene.nodes.back().parent = parent;
  return static_cast<uint32_t>(scene.nodes.size() - 1);
}

void move(Scene& scene, uint32_t node) {
  Channel channel;
  channel.node = node;
  channel.times = {0, 1};
  channel.values = {0, 0, 0, 1, 2, 3};
  if (scene.animations.empty()) scene.animations.emplace_back();
  scene.animations[0].channels.push_back(channel);
}

TEST(Instancing, LeavesTheSceneOneObjectWhereItIsOff) {
  Scene scene = two_strips();
  place(scene, 0);
  const Division division = divide(scene, Instancing::off);
  ASSERT_EQ(division.objects.size(), 1u);
  EXPECT_FALSE(division.objects[0].rigid);
  EXPECT_EQ(division.objects[0].nodes, (std::vector<uint32_t>{0, 1, 2}));
  ASSERT_EQ(division.instances.size(), 1u);
  EXPECT_EQ(division.instances[0].node, none);
}

TEST(Instancing, KeepsOnceWhatSeveralNodesPlace) {
  Scene scene = two_strips();
  place(scene, 0);
  place(scene, 0);
  const Division division = divide(scene, Instancing::on);
  ASSERT_EQ(division.objects.size(), 2u);
  EXPECT_TRUE(division.objects[0].rigid);
  EXPECT_EQ(division.objects[0].nodes, std::vector<uint32_t>{0});
  EXPECT_FALSE(division.objects[1].rigid);
  EXPECT_EQ(division.objects[1].nodes, std::vector<uint32_t>{1});
  ASSERT_EQ(division.instances.size(), 4u);
  const uint32_t nodes[] = {0, 2, 3, none}, objects[] = {0, 0, 0, 1};
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(division.instances[i].node, nodes[i]);
    EXPECT_EQ(division.instances[i].object, objects[i]);
  }
}

TEST(Instancing, TakesWhatAnAnimationMovesAsAWholeAlsoWithAParent) {
  Scene scene = two_strips();
  EXPECT_EQ(divide(scene, Instancing::on).objects.size(), 1u);
  move(scene, 1);
  EXPECT_EQ(divide(scene, Instancing::on).objects.size(), 2u);
  Scene below = two_strips();
  place(below, 1, 0);
  below.nodes[1].mesh = none;
  move(below, 0);
  const Division division = divide(below, Instancing::on);
  EXPECT_EQ(division.objects.size(), 2u);
  EXPECT_TRUE(division.objects[0].rigid && division.objects[1].rigid);
}

TEST(Instancing, LeavesInTheWorldWhatDeformsOrIsFlat) {
  Scene scene = two_strips();
  place(scene, 0);
  MorphTarget target;
  target.vertices = {1};
  target.positions = {glm::vec3(1)};
  scene.meshes[0].targets = {target};
  scene.meshes[0].weights = {0};
  EXPECT_EQ(divide(scene, Instancing::on).objects.size(), 1u);
  Scene flat = two_strips();
  flat.nodes[place(flat, 0)].scale = {1, 0, 1};
  EXPECT_EQ(divide(flat, Instancing::on).objects.size(), 1u);
  flat.nodes[place(flat, 0)].scale = {2, 1, 1};
  const Division division = divide(flat, Instancing::on);
  ASSERT_EQ(division.objects.size(), 2u);
  EXPECT_EQ(division.objects[1].nodes, (std::vector<uint32_t>{1, 2}));
}

TEST(Instancing, LeavesInTheWorldWhatHasNoNumbersToTraceInItsOwnSpace) {
  Scene scene = two_strips();
  place(scene, 0);
  EXPECT_EQ(divide(scene, Instancing::on).objects.size(), 2u);
  for (glm::vec3& p : scene.meshes[0].positions) p *= 1e13f;
  EXPECT_EQ(divide(scene, Instancing::on).objects.size(), 1u);
  for (glm::vec3& p : scene.meshes[0].positions) p *= 1e-25f;
  EXPECT_EQ(divide(scene, Instancing::on).objects.size(), 1u);
}

TEST(Instancing, IsAutomaticWhereItHalvesTheTriangles) {
  Scene scene = two_strips();  // 2 and 3 triangles
  EXPECT_EQ(divide(scene, Instancing::automatic).objects.size(), 1u);
  place(scene, 0);
  EXPECT_EQ(divide(scene, Instancing::automatic).objects.size(), 1u) << "5 of 7 remain";
  place(scene, 1);
  EXPECT_EQ(divide(scene, Instancing::automatic).objects.size(), 2u) << "5 of 10 remain";
}

TEST(Instancing, AssemblesObjectsOneBehindTheOther) {
  Scene scene = two_strips();
  place(scene, 1);
  const Assembly assembly = assemble(scene, Instancing::on);
  ASSERT_EQ(assembly.objects.size(), 2u);
  EXPECT_TRUE(assembly.objects[0].rigid);
  EXPECT_EQ(assembly.objects[0].vertices, 5u);
  EXPECT_EQ(assembly.objects[1].first_vertex, 5u);
  EXPECT_EQ(assembly.objects[1].first_triangle, 3u);
  EXPECT_EQ(assembly.triangles.size(), 5u);
  const Assembly alone = assemble_object(scene, assembly, 1);
  ASSERT_EQ(alone.objects.size(), 1u);
  EXPECT_FALSE(alone.objects[0].rigid);
  EXPECT_EQ(alone.triangles.size(), 2u);
  EXPECT_EQ(alone.positions.size(), 4u);
}

// Rigid objects stay where their mesh has them, and their instances know where that is.
TEST(Instancing, PutsRigidObjectsInTheirOwnSpace) {
  Scene scene = two_strips();
  scene.nodes[1].translation = {5, 6, 7};
  scene.nodes[place(scene, 1)].scale = glm::vec3(2);
  const Assembly assembly = assemble(scene, Instancing::on);
  const Pose rest = evaluate(scene, none, 0);
  EXPECT_EQ(rest_positions(scene, assembly)[3], scene.meshes[1].positions[3]);
  EXPECT_EQ(placed_positions(scene, assembly, rest)[3], scene.meshes[1].positions[3] + glm::vec3(5, 6, 7));
  const std::vector<glm::mat4> matrices = frame_instances(assembly, rest);
  ASSERT_EQ(matrices.size(), 3u);
  EXPECT_EQ(matrices[0][3], glm::vec4(5, 6, 7, 1));
  EXPECT_EQ(matrices[1][0], glm::vec4(2, 0, 0, 0));
  EXPECT_EQ(matrices[2], glm::mat4(1));
}

}  // namespace
}  // namespace lodestone::scene
