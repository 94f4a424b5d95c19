// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/weld.h"

#include <gtest/gtest.h>

#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

using test::mesh_of;
using test::scene_of;

// Six vertices, two at each of three places.
scene::Mesh pairs() {
  return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {5, 4, 3}});
}

std::vector<uint32_t> welded(const scene::Scene& scene) {
  return weld(scene::assemble(scene));
}

TEST(Weld, JoinsVerticesAtOnePlace) {
  scene::Mesh mesh = pairs();
  mesh.positions[4].y = -0.0f;
  mesh.normals[4] = {1, 0, 0};  // attributes do not matter
  mesh.positions[5].x = 1e-7f;
  EXPECT_EQ(welded(scene_of({mesh})), (std::vector<uint32_t>{0, 1, 2, 0, 1, 5}));
}

TEST(Weld, KeepsApartWhatAMorphTargetMovesApart) {
  scene::Mesh mesh = pairs();
  // 0 and 3 move alike, 1 and 4 by different deltas, 2 and 5 by different targets.
  mesh.targets.push_back(
      {"a", {0, 1, 2, 3, 4}, {{1, 1, 1}, {1, 0, 0}, {1, 1, 1}, {1, 1, 1}, {2, 0, 0}}, {}, {}});
  mesh.targets.push_back({"b", {5}, {{1, 1, 1}}, {}, {}});
  mesh.weights = {0, 0};
  EXPECT_EQ(welded(scene_of({mesh})), (std::vector<uint32_t>{0, 1, 2, 0, 4, 5}));
}

TEST(Weld, TakesAZeroDeltaForNone) {
  scene::Mesh mesh = pairs();
  mesh.targets.push_back({"a", {0, 2, 3, 5}, {{0, 0, 0}, {0, 2, 0}, {0, -0.0f, 0}, {0, 2, 0}}, {}, {}});
  mesh.targets.push_back({"b", {2}, {{0, 0, 0}}, {}, {}});
  mesh.weights = {0, 0};
  EXPECT_EQ(welded(scene_of({mesh})), (std::vector<uint32_t>{0, 1, 2, 0, 1, 2}));
}

TEST(Weld, KeepsApartWhatJointsMoveApart) {
  scene::Mesh mesh = pairs();
  mesh.first_influence = {0, 1, 2, 4, 5, 6, 8};
  mesh.influences = {{0, 1}, {0, 1}, {0, 0.25f}, {1, 0.75f}, {0, 1}, {1, 1}, {0, 0.75f}, {1, 0.25f}};
  scene::Scene scene = scene_of({mesh});
  scene.nodes.resize(3);
  scene.skins.push_back({"skin", {1, 2}, {glm::mat4(1), glm::mat4(1)}});
  scene.nodes[0].skin = 0;
  EXPECT_EQ(welded(scene), (std::vector<uint32_t>{0, 1, 2, 0, 4, 5}));
}

TEST(Weld, KeepsPlacementsApart) {
  EXPECT_EQ(welded(scene_of({pairs(), pairs()})),
            (std::vector<uint32_t>{0, 1, 2, 0, 1, 2, 6, 7, 8, 6, 7, 8}));
}

TEST(Weld, ComparesTheDeformationOfVerticesAtDifferentPlaces) {
  scene::Mesh mesh = pairs();
  mesh.targets.push_back({"a", {0, 1, 2}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 2}}, {}, {}});
  mesh.weights = {0};
  const scene::Assembly assembly = scene::assemble(scene_of({mesh}));
  EXPECT_TRUE(same_deformation(assembly, 0, 1));
  EXPECT_FALSE(same_deformation(assembly, 1, 2));
  EXPECT_FALSE(same_deformation(assembly, 2, 3));
  EXPECT_TRUE(same_deformation(assembly, 3, 4));
}

}  // namespace
}  // namespace lodestone::geometry_image
