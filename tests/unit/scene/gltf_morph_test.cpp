// SPDX-License-Identifier: MIT
// Morph targets and skin influences.
#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace lodestone::scene {
namespace {

TEST(GltfMorph, KeepsOnlyVerticesThatMove) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.give_normals(mesh);
  gltf.primitive(mesh)["targets"] = {{{"POSITION", gltf.floats({0, 0, 0, 0, 0, 0, 0, 0, 2}, "VEC3")}}};
  const Mesh loaded = gltf.load().meshes.at(0);
  ASSERT_EQ(loaded.targets.size(), 1u);
  EXPECT_EQ(loaded.targets[0].vertices, std::vector<uint32_t>{2});
  EXPECT_EQ(loaded.targets[0].positions, std::vector<glm::vec3>{glm::vec3(0, 0, 2)});
  EXPECT_TRUE(loaded.targets[0].normals.empty());
  EXPECT_TRUE(loaded.targets[0].tangents.empty());
  EXPECT_EQ(loaded.weights, std::vector<float>{0});
}

TEST(GltfMorph, MergesDeltasOfPositionsNormalsAndTangents) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.give_normals(mesh);
  gltf.primitive(mesh)["targets"] = {{{"POSITION", gltf.floats({0, 0, 0, 0, 0, 0, 1, 0, 0}, "VEC3")},
                                      {"NORMAL", gltf.floats({0, 2, 0, 0, 0, 0, 0, 0, 0}, "VEC3")},
                                      {"TANGENT", gltf.floats({0, 0, 0, 0, 0, 0, 0, 0, 3}, "VEC3")}}};
  const MorphTarget target = gltf.load().meshes.at(0).targets.at(0);
  EXPECT_EQ(target.vertices, (std::vector<uint32_t>{0, 2}));
  EXPECT_EQ(target.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(target.normals, (std::vector<glm::vec3>{{0, 2, 0}, {0, 0, 0}}));
  EXPECT_EQ(target.tangents, (std::vector<glm::vec3>{{0, 0, 0}, {0, 0, 3}}));
}

TEST(GltfMorph, NormalsOfOneOfTwoPrimitivesArePaddedWithZeros) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.give_normals(mesh);
  const int moved = gltf.floats({1, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  json second = gltf.primitive(mesh);
  second["attributes"]["POSITION"] = gltf.floats({0, 0, 5, 1, 0, 5, 0, 1, 5}, "VEC3");
  gltf.primitive(mesh)["targets"] = {{{"POSITION", moved}}};
  second["targets"] = {{{"POSITION", moved}, {"NORMAL", moved}}};
  json third = second;
  third["attributes"]["POSITION"] = gltf.floats({0, 0, 7, 1, 0, 7, 0, 1, 7}, "VEC3");
  third["targets"] = {{{"POSITION", moved}}};
  gltf.root["meshes"][0]["primitives"].push_back(second);
  gltf.root["meshes"][0]["primitives"].push_back(third);
  const MorphTarget target = gltf.load().meshes.at(0).targets.at(0);
  EXPECT_EQ(target.vertices, (std::vector<uint32_t>{0, 3, 6})) << "numbered through the mesh";
  EXPECT_EQ(target.normals, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}));
}

TEST(GltfMorph, ReadsSparseDeltasWithoutAViewAndDropsTheirZeros) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.give_normals(mesh);
  const int deltas = gltf.append(
      "accessors", {{"componentType", f32},
                    {"count", 3},
                    {"type", "VEC3"},
                    {"sparse",
                     {{"count", 2},
                      {"indices", {{"bufferView", gltf.view<uint16_t>({0, 2})}, {"componentType", u16}}},
                      {"values", {{"bufferView", gltf.view<float>({0, 0, 0, 0, 0, 4})}}}}}});
  gltf.primitive(mesh)["targets"] = {{{"POSITION", deltas}}};
  const MorphTarget target = gltf.load().meshes.at(0).targets.at(0);
  EXPECT_EQ(target.vertices, std::vector<uint32_t>{2});
  EXPECT_EQ(target.positions.at(0), glm::vec3(0, 0, 4));
}

TEST(GltfMorph, ATargetWithNeitherViewNorSparseMovesNothing) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  const int zeros = gltf.append("accessors", {{"componentType", f32}, {"count", 3}, {"type", "VEC3"}});
  gltf.primitive(mesh)["targets"] = {{{"POSITION", zeros}}};
  EXPECT_TRUE(gltf.load().meshes.at(0).targets.at(0).vertices.empty());
}

TEST(GltfMorph, HasNoCeilingOnTheNumberOfTargets) {
  constexpr size_t count = 1000;
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  const int deltas = gltf.accessor<int8_t>({0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", i8, {{"count", 3}});
  json weights = json::array();
  for (size_t i = 0; i < count; ++i) {
    gltf.primitive(mesh)["targets"].push_back({{"POSITION", deltas}});
    weights.push_back(float(i));
  }
  gltf.root["meshes"][0]["weights"] = weights;
  const Mesh loaded = gltf.load().meshes.at(0);
  ASSERT_EQ(loaded.targets.size(), count);
  EXPECT_EQ(loaded.targets.back().positions.at(0), glm::vec3(0, 0, 1));
  EXPECT_EQ(loaded.weights.back(), 999);
}

TEST(GltfMorph, NamesComeFromExtrasOrFromTheNumber) {
  const auto name_with = [](const json& names) {
    GltfBuilder gltf;
    const int mesh = gltf.triangle_mesh();
    const json zeros = {{"POSITION", gltf.floats(std::vector<float>(9), "VEC3")}};
    gltf.primitive(mesh)["targets"] = {zeros, zeros};
    if (!names.is_null()) gltf.root["meshes"][0]["extras"] = {{"targetNames", names}};
    return gltf.load().meshes.at(0).targets.at(1).name;
  };
  EXPECT_EQ(name_with({"smile", "frown"}), "frown");
  EXPECT_EQ(name_with({"smile", ""}), "target1");
  EXPECT_EQ(name_with({"smile"}), "target1") << "names that do not match are not used";
  EXPECT_EQ(name_with({nullptr, "frown"}), "target1");
  EXPECT_EQ(name_with(7), "target1");
  EXPECT_EQ(name_with(nullptr), "target1");
}

TEST(GltfMorph, NamesMayStandAtThePrimitive) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.primitive(mesh)["targets"] = {{{"POSITION", gltf.floats(std::vector<float>(9), "VEC3")}}};
  gltf.primitive(mesh)["extras"] = {{"targetNames", {"smile"}}};
  EXPECT_EQ(gltf.load().meshes.at(0).targets.at(0).name, "smile") << "as VRM has them";
}

// A skinned triangle: its node is 0, the joints follow.
struct Skinned {
  GltfBuilder gltf;
  int mesh;
  explicit Skinned(int joints) : mesh(gltf.triangle_mesh()) {
    json list = json::array();
    for (int j = 0; j < joints; ++j) list.push_back(gltf.append("nodes", {{"name", "joint"}}));
    gltf.append("skins", {{"joints", list}});
    gltf.root["nodes"][0]["skin"] = 0;
  }
  json& attributes() { return gltf.primitive(mesh)["attributes"]; }
};

std::vector<float> weights_of(const Mesh& mesh, uint32_t vertex) {
  std::vector<float> weights;
  for (uint32_t i = mesh.first_influence[vertex]; i < mesh.first_influence[vertex + 1]; ++i) {
    weights.push_back(mesh.influences[i].weight);
  }
  return weights;
}

TEST(GltfSkin, ReadsTwoSetsOfJointsAndWeights) {
  Skinned s(8);
  s.attributes()["JOINTS_0"] = s.gltf.accessor<uint8_t>({0, 1, 2, 3, 4, 0, 0, 0, 5, 0, 0, 0}, "VEC4", u8);
  s.attributes()["JOINTS_1"] = s.gltf.accessor<uint16_t>({4, 5, 6, 7, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", u16);
  s.attributes()["WEIGHTS_0"] = s.gltf.floats({1, 1, 1, 1, 3, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  s.attributes()["WEIGHTS_1"] = s.gltf.floats({1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  const Mesh mesh = s.gltf.load().meshes.at(0);
  EXPECT_EQ(weights_of(mesh, 0), std::vector<float>(8, 0.125f));
  EXPECT_EQ(weights_of(mesh, 1), (std::vector<float>{0.75f, 0.25f})) << "normalised, zeros dropped";
  EXPECT_EQ(weights_of(mesh, 2), std::vector<float>{1});
  EXPECT_EQ(mesh.influences[mesh.first_influence[1]].joint, 4u);
  EXPECT_EQ(mesh.influences[mesh.first_influence[1] + 1].joint, 1u);
}

TEST(GltfSkin, ReadsNormalizedIntegerWeights) {
  Skinned s(2);
  s.attributes()["JOINTS_0"] = s.gltf.accessor<uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4", u8);
  s.attributes()["WEIGHTS_0"] = s.gltf.accessor<uint8_t>({51, 204, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0}, "VEC4",
                                                         u8, {{"normalized", true}});
  const Mesh mesh = s.gltf.load().meshes.at(0);
  EXPECT_FLOAT_EQ(weights_of(mesh, 0).at(0), 0.2f);
  EXPECT_FLOAT_EQ(weights_of(mesh, 0).at(1), 0.8f);
}

TEST(GltfSkin, WithoutInverseBindMatricesBindsAtTheOrigin) {
  Skinned s(2);
  s.attributes()["JOINTS_0"] = s.gltf.accessor<uint8_t>(std::vector<uint8_t>(12), "VEC4", u8);
  s.attributes()["WEIGHTS_0"] = s.gltf.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const Scene scene = s.gltf.load();
  ASSERT_EQ(scene.skins.at(0).inverse_binds.size(), 2u);
  EXPECT_EQ(scene.skins[0].inverse_binds[1], glm::mat4(1));
}

TEST(GltfSkin, ReadsInverseBindMatricesByColumns) {
  Skinned s(1);
  s.attributes()["JOINTS_0"] = s.gltf.accessor<uint8_t>(std::vector<uint8_t>(12), "VEC4", u8);
  s.attributes()["WEIGHTS_0"] = s.gltf.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  s.gltf.root["skins"][0]["inverseBindMatrices"] =
      s.gltf.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}, "MAT4");
  EXPECT_EQ(s.gltf.load().skins.at(0).inverse_binds.at(0)[3], glm::vec4(5, 6, 7, 1));
}

TEST(GltfSkin, AVertexWithoutWeightsFollowsTheFirstJoint) {
  Skinned s(2);
  s.attributes()["JOINTS_0"] = s.gltf.accessor<uint8_t>({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, "VEC4", u8);
  s.attributes()["WEIGHTS_0"] = s.gltf.floats({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const Mesh mesh = s.gltf.load().meshes.at(0);
  EXPECT_EQ(weights_of(mesh, 0), std::vector<float>{1});
  EXPECT_EQ(mesh.influences.at(0).joint, 0u);
}

TEST(GltfSkin, AMeshDrawnWithAndWithoutASkinBecomesTwo) {
  Skinned s(1);
  s.attributes()["JOINTS_0"] = s.gltf.accessor<uint8_t>(std::vector<uint8_t>(12), "VEC4", u8);
  s.attributes()["WEIGHTS_0"] = s.gltf.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  s.gltf.append("nodes", {{"mesh", 0}});
  s.gltf.append("nodes", {{"mesh", 0}});
  const Scene scene = s.gltf.load();
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.nodes.at(0).mesh, 0u);
  EXPECT_EQ(scene.nodes.at(2).mesh, 1u);
  EXPECT_EQ(scene.nodes.at(3).mesh, 1u);
  EXPECT_FALSE(scene.meshes[0].influences.empty());
  EXPECT_TRUE(scene.meshes[1].influences.empty());
}

TEST(GltfSkin, OnAMeshWithoutJointsIsIgnored) {
  Skinned s(1);
  EXPECT_EQ(s.gltf.load().nodes.at(0).skin, none);
}

}  // namespace
}  // namespace lodestone::scene
