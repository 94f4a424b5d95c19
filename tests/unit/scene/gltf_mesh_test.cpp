// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_builder.h"

namespace lodestone::scene {
namespace {

const std::vector<float> five_points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0};

void add_primitive(GltfBuilder& gltf, int mode, const std::vector<uint16_t>& corners) {
  json primitive = {{"attributes", {{"POSITION", gltf.floats(five_points, "VEC3")}}}, {"mode", mode}};
  if (!corners.empty()) primitive["indices"] = gltf.indices(corners);
  gltf.append("meshes", {{"primitives", {primitive}}});
  gltf.append("nodes", {{"mesh", 0}});
  gltf.give_normals(0);
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
  gltf.give_normals(mesh);
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
  const json attributes = {{"POSITION", positions}, {"NORMAL", positions}};
  const json one = {{"attributes", attributes}, {"indices", gltf.indices({0, 1, 2})}};
  const json two = {{"attributes", attributes}, {"indices", gltf.indices({0, 2, 3})}};
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

// Two walls of a roof that share the ridge, its first two vertices.
struct Roof {
  GltfBuilder gltf;
  json primitive;
  Roof() {
    primitive["attributes"]["POSITION"] = gltf.floats({0, 0, 0, 1, 0, 0, 0, 1, -1, 0, -1, -1}, "VEC3");
    primitive["indices"] = gltf.indices({0, 1, 2, 1, 0, 3});
    gltf.append("nodes", {{"mesh", 0}});
  }
  Mesh load() {
    gltf.append("meshes", {{"primitives", {primitive}}});
    return gltf.load().meshes.at(0);
  }
};

const float half_root = std::sqrt(0.5f);

TEST(GltfMesh, WithoutNormalsHasFacets) {
  Roof roof;
  roof.primitive["attributes"]["TEXCOORD_0"] = roof.gltf.floats({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2");
  const Mesh mesh = roof.load();
  ASSERT_EQ(mesh.positions.size(), 6u) << "the ridge twice";
  for (int corner = 0; corner < 3; ++corner) {
    EXPECT_NEAR(glm::distance(mesh.normals[mesh.triangles[0][corner]], {0, half_root, half_root}), 0, 1e-6);
    EXPECT_NEAR(glm::distance(mesh.normals[mesh.triangles[1][corner]], {0, -half_root, half_root}), 0, 1e-6);
  }
  const glm::uvec3 second = mesh.triangles[1];
  EXPECT_EQ(mesh.positions[second.x], glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.positions[second.y], glm::vec3(0, 0, 0));
  EXPECT_EQ(mesh.texcoords[0].at(second.x), glm::vec2(1, 0)) << "a copy has all that its vertex has";
}

TEST(GltfMesh, FacetsBendWithTheirMorphTargets) {
  Roof roof;
  // Lays the second wall down into the plane z = 0, by its own vertex alone.
  roof.primitive["targets"] = {{{"POSITION", roof.gltf.floats({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}, "VEC3")},
                                {"NORMAL", roof.gltf.floats(std::vector<float>(12, 5), "VEC3")}}};
  const Mesh mesh = roof.load();
  const MorphTarget& target = mesh.targets.at(0);
  ASSERT_EQ(target.vertices.size(), 3u) << "all corners of the one facet";
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t vertex = target.vertices[i];
    EXPECT_EQ(target.positions[i], mesh.positions[vertex].y == -1 ? glm::vec3(0, 0, 1) : glm::vec3(0));
    EXPECT_NEAR(glm::distance(mesh.normals[vertex] + target.normals[i], {0, 0, 1}), 0, 1e-6);
  }
}

TEST(GltfMesh, CornersOfFacetsKeepTheirSkinAndTheirDeltas) {
  Roof roof;
  roof.primitive["attributes"]["JOINTS_0"] =
      roof.gltf.accessor<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4", u8);
  roof.primitive["attributes"]["WEIGHTS_0"] =
      roof.gltf.floats({1, 0, 0, 0, 1, 0, 0, 0, 0.25f, 0.75f, 0, 0, 1, 0, 0, 0}, "VEC4");
  // Moves the whole roof.
  roof.primitive["targets"] = {
      {{"POSITION", roof.gltf.floats({1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3}, "VEC3")}}};
  roof.gltf.append("nodes", {{"name", "joint"}});
  roof.gltf.append("nodes", {{"name", "joint"}});
  roof.gltf.append("skins", {{"joints", {1, 2}}});
  roof.gltf.root["nodes"][0]["skin"] = 0;
  const Mesh mesh = roof.load();
  ASSERT_EQ(mesh.targets.at(0).vertices.size(), 6u);
  for (size_t v = 0; v < 6; ++v) {
    EXPECT_EQ(mesh.targets[0].positions[v], glm::vec3(1, 2, 3));
    EXPECT_NEAR(glm::length(mesh.targets[0].normals[v]), 0, 1e-6) << "only moved";
    const uint32_t first = mesh.first_influence[v], count = mesh.first_influence[v + 1] - first;
    EXPECT_EQ(count, mesh.positions[v].y == 1 ? 2u : 1u);
    if (mesh.positions[v].x == 1) {
      EXPECT_EQ(mesh.influences[first].joint, 1u);
    }
  }
}

TEST(GltfMesh, FacetsAreNotMadeWithoutBound) {
  // A thousand deltas at one vertex, which a hundred thousand triangles have.
  Roof roof;
  roof.primitive["indices"] = roof.gltf.indices(std::vector<uint16_t>(300000, 0));
  const int delta = roof.gltf.floats({1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  for (int i = 0; i < 1000; ++i) roof.primitive["targets"].push_back({{"POSITION", delta}});
  roof.gltf.append("meshes", {{"primitives", {roof.primitive}}});
  const std::string message = expect_bad_input(roof.gltf.folder().write("s.glb", roof.gltf.glb()));
  EXPECT_NE(message.find("more than a file of this size can mean"), std::string::npos) << message;
}

TEST(GltfMesh, IgnoresAttributesOfItsOwn) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.primitive(mesh)["attributes"]["_TEMPERATURE"] = gltf.floats({1, 2, 3}, "SCALAR");
  EXPECT_EQ(gltf.load().meshes.at(0).triangles.size(), 1u);
}

}  // namespace
}  // namespace lodestone::scene
