// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace lodestone::scene {
namespace {

const std::vector<float> five_points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0};

void add_primitive(GltfBuilder& gltf, int mode, const std::vector<uint16_t>& corners) {
  json primitive = {{"attributes", {{"POSITION", gltf.floats(five_points, "VEC3")}}}, {"mode", mode}};
  if (!corners.empty()) primitive["indices"] = gltf.indices(corners);
  gltf.append("meshes", {{"primitives", {primitive}}});
  gltf.append("nodes", {{"mesh", 0}});
}

TEST(GltfMesh, StripTurnsEverySecondTriangle) {
  GltfBuilder gltf;
  add_primitive(gltf, 5, {0, 1, 2, 3, 4});
  const std::vector<glm::uvec3> expected = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}};
  EXPECT_EQ(gltf.load().meshes.at(0).triangles, expected);
}

TEST(GltfMesh, FanTurnsAroundItsFirstVertex) {
  GltfBuilder gltf;
  add_primitive(gltf, 6, {0, 1, 2, 3, 4});
  const std::vector<glm::uvec3> expected = {{1, 2, 0}, {2, 3, 0}, {3, 4, 0}};
  EXPECT_EQ(gltf.load().meshes.at(0).triangles, expected);
}

TEST(GltfMesh, WithoutIndicesTakesVerticesInOrder) {
  GltfBuilder gltf;
  add_primitive(gltf, 5, {});
  EXPECT_EQ(gltf.load().meshes.at(0).triangles.at(2), glm::uvec3(2, 3, 4));
  GltfBuilder list;
  list.triangle_mesh();
  EXPECT_EQ(list.load().meshes.at(0).triangles, std::vector<glm::uvec3>{glm::uvec3(0, 1, 2)});
}

TEST(GltfMesh, KeepsDegenerateTrianglesInPlace) {
  GltfBuilder gltf;
  add_primitive(gltf, 4, {0, 0, 0, 0, 1, 2});
  const std::vector<glm::uvec3> expected = {{0, 0, 0}, {0, 1, 2}};
  EXPECT_EQ(gltf.load().meshes.at(0).triangles, expected);
}

TEST(GltfMesh, ReadsIndicesOfEveryWidth) {
  const auto triangles_of = [](auto corner_type, int component) {
    GltfBuilder gltf;
    const int mesh = gltf.triangle_mesh();
    const std::vector<decltype(corner_type)> corners = {2, 1, 0};
    gltf.primitive(mesh)["indices"] = gltf.accessor(corners, "SCALAR", component);
    return gltf.load().meshes.at(0).triangles;
  };
  const std::vector<glm::uvec3> expected = {{2, 1, 0}};
  EXPECT_EQ(triangles_of(uint8_t(), u8), expected);
  EXPECT_EQ(triangles_of(uint16_t(), u16), expected);
  EXPECT_EQ(triangles_of(uint32_t(), u32), expected);
}

TEST(GltfMesh, SkipsPointsAndLinesButKeepsTheOthers) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  for (int mode : {0, 1, 2, 3}) {
    json primitive = gltf.primitive(mesh);
    primitive["mode"] = mode;
    json& primitives = gltf.root["meshes"][0]["primitives"];
    primitives.insert(primitives.begin(), primitive);
  }
  const Scene scene = gltf.load();
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 1u);
  EXPECT_EQ(scene.meshes[0].parts.size(), 1u);
}

TEST(GltfMesh, OfPointsAloneIsNotDrawn) {
  GltfBuilder gltf;
  gltf.primitive(gltf.triangle_mesh())["mode"] = 0;
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.meshes.size(), 1u) << "meshes keep their numbers";
  EXPECT_EQ(scene.nodes.at(0).mesh, none);
}

TEST(GltfMesh, ConcatenatesPrimitivesAsParts) {
  GltfBuilder gltf;
  gltf.append("materials", {{"name", "first"}});
  gltf.append("materials", {{"name", "second"}});
  const int mesh = gltf.triangle_mesh();
  json second = {{"attributes", {{"POSITION", gltf.floats(five_points, "VEC3")}}},
                 {"indices", gltf.indices({0, 1, 2, 0, 2, 3})},
                 {"material", 1}};
  gltf.root["meshes"][size_t(mesh)]["primitives"].push_back(second);
  const Mesh loaded = gltf.load().meshes.at(0);
  EXPECT_EQ(loaded.positions.size(), 8u);
  const std::vector<glm::uvec3> expected = {{0, 1, 2}, {3, 4, 5}, {3, 5, 6}};
  EXPECT_EQ(loaded.triangles, expected);
  ASSERT_EQ(loaded.parts.size(), 2u);
  EXPECT_EQ(loaded.parts[0].material, none);
  EXPECT_EQ(loaded.parts[1].first_triangle, 1u);
  EXPECT_EQ(loaded.parts[1].triangle_count, 2u);
  EXPECT_EQ(loaded.parts[1].material, 1u);
}

TEST(GltfMesh, PrimitivesWithTheSameAttributesShareVertices) {
  GltfBuilder gltf;
  const int positions = gltf.floats(five_points, "VEC3");
  const json one = {{"attributes", {{"POSITION", positions}}}, {"indices", gltf.indices({0, 1, 2})}};
  const json two = {{"attributes", {{"POSITION", positions}}}, {"indices", gltf.indices({0, 2, 3})}};
  gltf.append("meshes", {{"primitives", {one, two}}});
  gltf.append("nodes", {{"mesh", 0}});
  const Mesh mesh = gltf.load().meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(mesh.parts.size(), 2u);
  EXPECT_EQ(mesh.triangles.at(1), glm::uvec3(0, 2, 3));
}

TEST(GltfMesh, FillsAttributesThatOnlySomePrimitivesHave) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  json second = gltf.primitive(mesh);
  second["attributes"]["COLOR_0"] = gltf.floats({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  second["attributes"]["TEXCOORD_0"] = gltf.floats({0.5f, 0.25f, 0, 0, 1, 1}, "VEC2");
  second["attributes"]["NORMAL"] = gltf.floats({0, 0, -2, 0, 0, -2, 0, 0, 0}, "VEC3");
  gltf.root["meshes"][0]["primitives"].push_back(second);
  const Mesh loaded = gltf.load().meshes.at(0);
  ASSERT_EQ(loaded.colors.size(), 6u);
  EXPECT_EQ(loaded.colors[0], glm::vec4(1)) << "white where there is none";
  EXPECT_EQ(loaded.colors[4], glm::vec4(0, 1, 0, 1)) << "RGB gets alpha 1";
  EXPECT_EQ(loaded.texcoords[0].at(3), glm::vec2(0.5f, 0.25f));
  EXPECT_TRUE(loaded.texcoords[1].empty());
  EXPECT_EQ(loaded.normals[0], glm::vec3(0, 0, 1)) << "computed";
  EXPECT_EQ(loaded.normals[3], glm::vec3(0, 0, -1)) << "as given, but of unit length";
  EXPECT_EQ(loaded.normals[5], glm::vec3(0, 0, 1)) << "a zero normal is computed";
}

TEST(GltfMesh, DropsTangentsWhereANormalMappedPrimitiveHasNone) {
  const auto tangents_with = [](bool normal_map) {
    GltfBuilder gltf;
    const int mesh = gltf.triangle_mesh();
    json second = gltf.primitive(mesh);
    second["attributes"]["TANGENT"] = gltf.floats({2, 0, 0, -1, 2, 0, 0, 1, 0, 0, 0, 1}, "VEC4");
    gltf.root["meshes"][0]["primitives"].push_back(second);
    if (normal_map) {
      gltf.append("images", {{"bufferView", gltf.view_bytes(make_png(1, 1, 3, {128, 128, 255}))},
                             {"mimeType", "image/png"}});
      gltf.append("textures", {{"source", 0}});
      gltf.append("materials", {{"normalTexture", {{"index", 0}}}});
      gltf.primitive(mesh)["material"] = 0;
    }
    return gltf.load().meshes.at(0).tangents;
  };
  EXPECT_TRUE(tangents_with(true).empty());
  const std::vector<glm::vec4> kept = tangents_with(false);
  ASSERT_EQ(kept.size(), 6u);
  EXPECT_EQ(kept[3], glm::vec4(1, 0, 0, -1));
  EXPECT_EQ(kept[4], glm::vec4(1, 0, 0, 1));
  for (size_t v : {0u, 1u, 2u, 5u}) {
    EXPECT_NEAR(glm::length(glm::vec3(kept[v])), 1, 1e-6) << v;
    EXPECT_NEAR(glm::dot(glm::vec3(kept[v]), glm::vec3(0, 0, 1)), 0, 1e-6) << "perpendicular to the normal";
  }
}

TEST(GltfMesh, MissingNormalsAreSmoothAcrossPrimitives) {
  GltfBuilder gltf;
  // Two walls of a roof that meet along the x axis, as two primitives.
  const json left = {{"attributes", {{"POSITION", gltf.floats({0, 0, 0, 1, 0, 0, 0, 1, -1}, "VEC3")}}}};
  const json right = {{"attributes", {{"POSITION", gltf.floats({1, 0, 0, 0, 0, 0, 0, -1, -1}, "VEC3")}}}};
  gltf.append("meshes", {{"primitives", {left, right}}});
  gltf.append("nodes", {{"mesh", 0}});
  const Mesh mesh = gltf.load().meshes.at(0);
  EXPECT_NEAR(glm::distance(mesh.normals.at(0), glm::vec3(0, 0, 1)), 0, 1e-6) << "of the ridge";
  EXPECT_NEAR(glm::distance(mesh.normals.at(4), glm::vec3(0, 0, 1)), 0, 1e-6);
  const float h = std::sqrt(0.5f);
  EXPECT_NEAR(glm::distance(mesh.normals.at(2), glm::vec3(0, h, h)), 0, 1e-6) << "of one wall";
}

TEST(GltfMesh, IgnoresAttributesOfItsOwn) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.primitive(mesh)["attributes"]["_TEMPERATURE"] = gltf.floats({1, 2, 3}, "SCALAR");
  EXPECT_EQ(gltf.load().meshes.at(0).triangles.size(), 1u);
}

}  // namespace
}  // namespace lodestone::scene
