// SPDX-License-Identifier: MIT
// Component types, strides and sparse accessors, seen through the attributes of a mesh.
#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace lodestone::scene {
namespace {

// The triangle mesh with one more attribute, loaded.
Mesh with_attribute(GltfBuilder& gltf, const char* name, int accessor) {
  gltf.primitive(gltf.triangle_mesh())["attributes"][name] = accessor;
  return gltf.load().meshes.at(0);
}

TEST(GltfAccessor, NormalizesUnsignedBytesAndShorts) {
  GltfBuilder bytes;
  const Mesh b = with_attribute(bytes, "TEXCOORD_0",
                                bytes.accessor<uint8_t>({0, 255, 0, 0, 51, 102, 0, 0, 255, 0, 0, 0}, "VEC2",
                                                        u8, {{"normalized", true}, {"count", 3}}));
  EXPECT_EQ(b.texcoords[0].at(0), glm::vec2(0, 1));
  GltfBuilder shorts;
  const Mesh s = with_attribute(
      shorts, "TEXCOORD_0",
      shorts.accessor<uint16_t>({0, 65535, 13107, 26214, 65535, 0}, "VEC2", u16, {{"normalized", true}}));
  EXPECT_EQ(s.texcoords[0].at(0), glm::vec2(0, 1));
  EXPECT_FLOAT_EQ(s.texcoords[0].at(1).x, 0.2f);
  EXPECT_FLOAT_EQ(s.texcoords[0].at(1).y, 0.4f);
}

TEST(GltfAccessor, NormalizedSignedIntegersAreClampedAtMinusOne) {
  GltfBuilder gltf;
  const int normals = gltf.accessor<int8_t>(
      {127, 0, 0, 0, -128, 0, 0, 0, 0, -127, 0, 0}, "VEC3", i8,
      {{"normalized", true},
       {"count", 3},
       {"bufferView", gltf.view<int8_t>({127, 0, 0, 0, -128, 0, 0, 0, 0, -127, 0, 0}, {{"byteStride", 4}})}});
  const Mesh mesh = with_attribute(gltf, "NORMAL", normals);
  EXPECT_EQ(mesh.normals.at(0), glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.normals.at(1), glm::vec3(-1, 0, 0)) << "-128 is -1, as -127 is";
  EXPECT_EQ(mesh.normals.at(2), glm::vec3(0, -1, 0));
}

TEST(GltfAccessor, TakesUnnormalizedIntegersAsTheyAre) {
  GltfBuilder gltf;
  gltf.root["extensionsUsed"] = {"KHR_mesh_quantization"};
  gltf.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int view = gltf.view<int16_t>({0, 0, 0, 0, 100, 0, 0, 0, 0, -200, 7, 0}, {{"byteStride", 8}});
  const int positions = gltf.append(
      "accessors", {{"bufferView", view}, {"componentType", i16}, {"count", 3}, {"type", "VEC3"}});
  const int mesh = gltf.triangle_mesh();
  gltf.primitive(mesh)["attributes"]["POSITION"] = positions;
  const std::vector<glm::vec3> expected = {{0, 0, 0}, {100, 0, 0}, {0, -200, 7}};
  EXPECT_EQ(gltf.load().meshes.at(0).positions, expected);
}

TEST(GltfAccessor, ReadsInterleavedViews) {
  GltfBuilder gltf;
  // position, normal, position, normal, ...
  const int view =
      gltf.view<float>({0, 0, 0, 0, 0, -1, 1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, -1}, {{"byteStride", 24}});
  const auto accessor = [&](int offset) {
    return gltf.append("accessors", {{"bufferView", view},
                                     {"byteOffset", offset},
                                     {"componentType", f32},
                                     {"count", 3},
                                     {"type", "VEC3"}});
  };
  const int mesh = gltf.triangle_mesh();
  gltf.primitive(mesh)["attributes"] = {{"POSITION", accessor(0)}, {"NORMAL", accessor(12)}};
  const Mesh loaded = gltf.load().meshes.at(0);
  EXPECT_EQ(loaded.positions.at(2), glm::vec3(0, 1, 0));
  EXPECT_EQ(loaded.normals.at(2), glm::vec3(0, 0, -1));
}

json sparse_of(GltfBuilder& gltf, const std::vector<uint16_t>& indices, const std::vector<float>& values) {
  return {{"count", indices.size()},
          {"indices", {{"bufferView", gltf.view(indices)}, {"componentType", u16}}},
          {"values", {{"bufferView", gltf.view(values)}}}};
}

TEST(GltfAccessor, SparseElementsReplaceThoseOfTheView) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.root["accessors"][0]["sparse"] = sparse_of(gltf, {1, 2}, {5, 0, 0, 0, 6, 0});
  const std::vector<glm::vec3> expected = {{0, 0, 0}, {5, 0, 0}, {0, 6, 0}};
  EXPECT_EQ(gltf.load().meshes.at(size_t(mesh)).positions, expected);
}

TEST(GltfAccessor, SparseWithoutAViewStartsFromZeros) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  gltf.root["accessors"][0].erase("bufferView");
  gltf.root["accessors"][0]["sparse"] = sparse_of(gltf, {2}, {0, 6, 0});
  const std::vector<glm::vec3> expected = {{0, 0, 0}, {0, 0, 0}, {0, 6, 0}};
  EXPECT_EQ(gltf.load().meshes.at(size_t(mesh)).positions, expected);
}

TEST(GltfAccessor, WithNeitherViewNorSparseIsAllZeros) {
  GltfBuilder gltf;
  gltf.triangle_mesh();
  gltf.root["accessors"][0].erase("bufferView");
  EXPECT_EQ(gltf.load().meshes.at(0).positions, std::vector<glm::vec3>(3, glm::vec3(0)));
}

TEST(GltfAccessor, IndicesMayHaveNoViewEither) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  // 0 2 1, by its two elements that are not zero.
  gltf.primitive(mesh)["indices"] = gltf.append(
      "accessors", {{"componentType", u16},
                    {"count", 3},
                    {"type", "SCALAR"},
                    {"sparse",
                     {{"count", 2},
                      {"indices", {{"bufferView", gltf.view<uint8_t>({1, 2})}, {"componentType", u8}}},
                      {"values", {{"bufferView", gltf.view<uint16_t>({2, 1})}}}}}});
  EXPECT_EQ(gltf.load().meshes.at(0).triangles.at(0), glm::uvec3(0, 2, 1));
  EXPECT_EQ(load_checked(gltf.folder().write("s.gltf", gltf.gltf_embedded())).meshes.at(0).triangles.at(0),
            glm::uvec3(0, 2, 1));
}

TEST(GltfAccessor, SparseIndicesComeInEveryWidth) {
  const auto position_with = [](auto index, int component) {
    GltfBuilder gltf;
    gltf.triangle_mesh();
    const std::vector<decltype(index)> indices = {2};
    gltf.root["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", gltf.view(indices)}, {"componentType", component}}},
        {"values", {{"bufferView", gltf.view<float>({7, 8, 9})}}}};
    return gltf.load().meshes.at(0).positions.at(2);
  };
  EXPECT_EQ(position_with(uint8_t(), u8), glm::vec3(7, 8, 9));
  EXPECT_EQ(position_with(uint16_t(), u16), glm::vec3(7, 8, 9));
  EXPECT_EQ(position_with(uint32_t(), u32), glm::vec3(7, 8, 9));
}

}  // namespace
}  // namespace lodestone::scene
