// SPDX-License-Identifier: MIT
// Files that lie. Each is a good file with one thing wrong; all must be refused with exit code 3, quickly and
// without allocating what they claim.
#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "gltf_hostile.h"

namespace lodestone::scene {
namespace {

// What every case starts from: a skinned and morphing triangle with two joints, a clip of weights and
// translation, a texture, a camera. Names stand for the indices of its accessors, and with _view for those of
// their views.
class GoodFile {
 public:
  GltfBuilder gltf;
  std::map<std::string, int> accessors;

  GoodFile() {
    add_mesh();
    add_surface();
    add_nodes();
    add_animation();
  }

  // "/accessors/{position}/count" with the names replaced.
  std::string resolve(std::string text) const {
    const auto replace = [&text](const std::string& name, const std::string& with) {
      for (size_t at = text.find(name); at != text.npos; at = text.find(name))
        text.replace(at, name.size(), with);
    };
    for (const auto& [name, index] : accessors) {
      replace("{" + name + "}", std::to_string(index));
      replace("{" + name + "_view}", std::to_string(view(index)));
    }
    return text;
  }

  // Overwrites float `index` of an accessor.
  void poke(const std::string& name, size_t index, float value) {
    const json& v = gltf.root["bufferViews"].at(size_t(view(accessors.at(name))));
    std::memcpy(&gltf.binary.at(v["byteOffset"].get<size_t>() + index * sizeof value), &value, sizeof value);
  }

 private:
  int view(int accessor) const { return gltf.root.at("accessors").at(size_t(accessor)).at("bufferView"); }
  int named(const char* name, int accessor) { return accessors[name] = accessor; }

  void add_mesh() {
    json& primitive = gltf.primitive(gltf.triangle_mesh());
    json& attributes = primitive["attributes"];
    named("position", attributes["POSITION"]);
    primitive["indices"] = named("indices", gltf.indices({0, 1, 2}));
    attributes["JOINTS_0"] = named("joints", gltf.accessor<uint8_t>(std::vector<uint8_t>(12), "VEC4", u8));
    attributes["WEIGHTS_0"] = named("weights", gltf.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4"));
    primitive["targets"][0]["POSITION"] = named("delta", gltf.floats({0, 0, 1, 0, 0, 0, 0, 0, 1}, "VEC3"));
    primitive["material"] = 0;
    // Spares to point at: one vector, four indices, an index too high, indices of sparse elements and their
    // values.
    named("single", gltf.floats({0, 0, 1}, "VEC3"));
    named("four", gltf.indices({0, 1, 2, 0}));
    named("high", gltf.indices({0, 1, 3}));
    named("ascending", gltf.indices({1, 2}));
    named("repeated", gltf.indices({1, 1}));
    named("values", gltf.floats({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, "VEC3"));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    named("nans", gltf.floats({nan, 1, 1, 1, 1, 1}, "VEC3"));
    named("high_joint", gltf.accessor<uint8_t>({0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0}, "VEC4", u8));
  }

  void add_surface() {
    gltf.root.update(json::parse(R"({
      "materials": [{"emissiveTexture": {"index": 0}}],
      "textures": [{"source": 0, "sampler": 0}],
      "samplers": [{}],
      "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]})"));
    const int png = gltf.view_bytes(make_png(1, 1, 3, {1, 2, 3}));
    gltf.append("images", {{"mimeType", "image/png"}, {"bufferView", png}});
  }

  void add_nodes() {
    gltf.root.update(json::parse(R"({
      "nodes": [{"mesh": 0, "skin": 0}, {"children": [2]}, {}],
      "scenes": [{"nodes": [0, 1]}],
      "scene": 0,
      "skins": [{"joints": [1, 2]}]})"));
    gltf.root["skins"][0]["inverseBindMatrices"] =
        named("binds", gltf.floats(std::vector<float>(32, 1), "MAT4"));
  }

  void add_animation() {
    const json weights = {{"input", named("times", gltf.floats({0, 1}, "SCALAR"))},
                          {"output", named("shape", gltf.floats({0, 1}, "SCALAR"))}};
    const json moves = {{"input", accessors["times"]},
                        {"output", named("moves", gltf.floats({0, 0, 0, 1, 1, 1}, "VEC3"))}};
    json animation = json::parse(R"({"channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}},
                                                  {"sampler": 1, "target": {"node": 1, "path": "translation"}}]})");
    animation["samplers"] = {weights, moves};
    gltf.append("animations", animation);
  }
};

// A place in the JSON, and what is put there; nothing: the property is removed.
struct Edit {
  std::string pointer, value = {};
};

struct Lie {
  std::string name;
  std::vector<Edit> edits;
};

void PrintTo(const Lie& lie, std::ostream* out) {
  *out << lie.name;
}
std::string name_of(const testing::TestParamInfo<Lie>& tested) {
  return tested.param.name;
}

void apply(const Edit& edit, const GoodFile& file, json& root) {
  const json::json_pointer pointer(file.resolve(edit.pointer));
  if (edit.value.empty()) {
    root.at(pointer.parent_pointer()).erase(pointer.back());
  } else {
    root[pointer] = json::parse(file.resolve(edit.value));
  }
}

void expect_file_refused(const GoodFile& file) {
  const std::string message = expect_refused(file.gltf.folder().write("scene.glb", file.gltf.glb()));
  EXPECT_NE(message.find("scene.glb"), std::string::npos) << message;
}

class Malformed : public testing::TestWithParam<Lie> {};

TEST_P(Malformed, IsRefused) {
  GoodFile file;
  json root = file.gltf.root;
  for (const Edit& edit : GetParam().edits) apply(edit, file, root);
  ASSERT_NE(root, file.gltf.root) << "the lie changes nothing";
  file.gltf.root = root;
  expect_file_refused(file);
}

TEST(MalformedBase, IsNot) {
  EXPECT_NO_THROW(GoodFile().gltf.load());
}

const char* const position_count = "/accessors/{position}/count";
const char* const position_view = "/accessors/{position}/bufferView";

INSTANTIATE_TEST_SUITE_P(
    Accessors, Malformed,
    testing::ValuesIn(std::vector<Lie>{
        {"CountBeyondView", {{position_count, "4"}}},
        {"CountHuge", {{position_count, "1099511627776"}}},
        {"CountThatOverflows", {{position_count, "1537228672809129302"}}},
        {"CountBeyond64Bits", {{position_count, "18446744073709551619"}}},
        {"CountZero", {{position_count, "0"}}},
        {"CountNegative", {{position_count, "-1"}}},
        {"CountFloat", {{position_count, "3.5"}}},
        {"CountText", {{position_count, "\"3\""}}},
        {"CountMissing", {{position_count}}},
        {"ZerosHuge", {{position_view}, {position_count, "1099511627776"}}},
        {"ZerosLarge", {{position_view}, {position_count, "100000000"}}},
        {"OffsetBeyondView", {{"/accessors/{position}/byteOffset", "4"}}},
        {"OffsetHuge", {{"/accessors/{position}/byteOffset", "1099511627776"}}},
        {"OffsetNegative", {{"/accessors/{position}/byteOffset", "-4"}}},
        {"OffsetUnaligned",
         {{"/bufferViews/{position_view}/byteLength", "40"}, {"/accessors/{position}/byteOffset", "2"}}},
        {"ViewUnaligned", {{"/bufferViews/{position_view}/byteOffset", "1"}}},
        {"ViewMissing", {{position_view, "99"}}},
        {"ViewNegative", {{position_view, "-1"}}},
        {"ViewWrapped", {{position_view, "4294967296"}}},
        {"ViewBeyondBuffer", {{"/bufferViews/{position_view}/byteLength", "1099511627776"}}},
        {"ViewOffsetHuge", {{"/bufferViews/{position_view}/byteOffset", "1099511627776"}}},
        {"ViewOffsetThatOverflows",
         {{"/bufferViews/{position_view}/byteOffset", "18446744073709551600"},
          {"/bufferViews/{position_view}/byteLength", "52"}}},
        {"ViewBuffer", {{"/bufferViews/{position_view}/buffer", "7"}}},
        {"StrideSmall", {{"/bufferViews/{position_view}/byteStride", "8"}}},
        {"StrideLarge", {{"/bufferViews/{position_view}/byteStride", "252"}}},
        {"StrideHuge", {{"/bufferViews/{position_view}/byteStride", "2147483644"}}},
        {"StrideOdd", {{"/bufferViews/{position_view}/byteStride", "13"}}},
        {"ComponentSignedInt", {{"/accessors/{position}/componentType", "5124"}}},
        {"ComponentDouble", {{"/accessors/{position}/componentType", "5130"}}},
        {"ComponentUnknown", {{"/accessors/{position}/componentType", "1"}}},
        {"TypeUnknown", {{"/accessors/{position}/type", "\"VEC5\""}}},
        {"TypeOther", {{"/accessors/{position}/type", "\"VEC2\""}}},
        {"TypeMatrix", {{"/accessors/{position}/type", "\"MAT4\""}}},
        {"NotAnObject", {{"/accessors/{position}", "5"}}},
        {"NoArray", {{"/accessors", "5"}}}}),
    name_of);

// Makes the positions sparse: count, indices and values as given.
Edit sparse(const std::string& count, const std::string& indices, const std::string& values,
            const std::string& accessor = "position") {
  return {"/accessors/{" + accessor + "}/sparse",
          R"({"count": )" + count + R"(, "indices": )" + indices + R"(, "values": )" + values + "}"};
}

const std::string good_indices = R"({"bufferView": {ascending_view}, "componentType": 5123})";
const std::string good_values = R"({"bufferView": {values_view}})";

INSTANTIATE_TEST_SUITE_P(
    Sparse, Malformed,
    testing::ValuesIn(std::vector<Lie>{
        {"SparseIndexOutOfRange",
         {sparse("3", R"({"bufferView": {high_view}, "componentType": 5123})", good_values)}},
        {"SparseIndexTwice",
         {sparse("2", R"({"bufferView": {repeated_view}, "componentType": 5123})", good_values)}},
        {"SparseDescending",
         {sparse("3", R"({"bufferView": {four_view}, "byteOffset": 2, "componentType": 5123})",
                 good_values)}},
        {"SparseMoreThanElements",
         {sparse("4", R"({"bufferView": {four_view}, "componentType": 5123})", good_values)}},
        {"SparseCountHuge",
         {{position_view}, {position_count, "2000000000"}, sparse("2000000000", good_indices, good_values)}},
        {"SparseCountWrapped", {sparse("4294967298", good_indices, good_values)}},
        {"SparseCountZero", {sparse("0", good_indices, good_values)}},
        {"SparseFloatIndices",
         {sparse("2", R"({"bufferView": {values_view}, "componentType": 5126})", good_values)}},
        {"SparseSignedIndices",
         {sparse("2", R"({"bufferView": {ascending_view}, "componentType": 5122})", good_values)}},
        {"SparseViewMissing", {sparse("2", good_indices, R"({"bufferView": 99})")}},
        {"SparseOffset", {sparse("2", good_indices, R"({"bufferView": {values_view}, "byteOffset": 28})")}},
        {"SparseOffsetNegative",
         {sparse("2", R"({"bufferView": {ascending_view}, "byteOffset": -2, "componentType": 5123})",
                 good_values)}},
        {"SparseOffsetUnaligned",
         {sparse("1", R"({"bufferView": {ascending_view}, "byteOffset": 1, "componentType": 5123})",
                 good_values)}},
        {"SparseWithoutValues",
         {sparse("2", good_indices, good_values), {"/accessors/{position}/sparse/values"}}},
        {"SparseWithoutIndices",
         {sparse("2", good_indices, good_values), {"/accessors/{position}/sparse/indices"}}},
        {"SparseNotAnObject", {{"/accessors/{position}/sparse", "3"}}},
        {"SparseDeltaNaN",
         {sparse("2", good_indices, R"({"bufferView": {nans_view}})", "delta"),
          {"/accessors/{delta}/bufferView"}}},
        {"SparseDeltaOutOfRange",
         {sparse("3", R"({"bufferView": {high_view}, "componentType": 5123})", good_values, "delta"),
          {"/accessors/{delta}/bufferView"}}}}),
    name_of);

const char* const primitive_indices = "/meshes/0/primitives/0/indices";

INSTANTIATE_TEST_SUITE_P(
    Meshes, Malformed,
    testing::ValuesIn(std::vector<Lie>{
        {"IndexOutOfRange", {{primitive_indices, "{high}"}}},
        {"IndicesNotTriangles", {{primitive_indices, "{four}"}}},
        {"IndicesFloat", {{primitive_indices, "{times}"}}},
        {"IndicesVec3", {{"/accessors/{indices}/type", "\"VEC3\""}, {"/accessors/{indices}/count", "1"}}},
        {"IndicesMissing", {{primitive_indices, "99"}}},
        {"IndicesText", {{primitive_indices, "\"1\""}}},
        {"IndicesWithoutView",
         {{"/accessors/{indices}/bufferView"}, {"/accessors/{indices}/count", "1099511627776"}}},
        {"AttributeMissing", {{"/meshes/0/primitives/0/attributes/POSITION", "99"}}},
        {"AttributeNegative", {{"/meshes/0/primitives/0/attributes/POSITION", "-1"}}},
        {"AttributeText", {{"/meshes/0/primitives/0/attributes/POSITION", "\"0\""}}},
        {"AttributeObject", {{"/meshes/0/primitives/0/attributes/POSITION", "{}"}}},
        {"AttributeCount", {{"/meshes/0/primitives/0/attributes/NORMAL", "{single}"}}},
        {"AttributesMissing", {{"/meshes/0/primitives/0/attributes"}}},
        {"AttributesArray", {{"/meshes/0/primitives/0/attributes", "[1]"}}},
        {"ModeUnknown", {{"/meshes/0/primitives/0/mode", "7"}}},
        {"ModeText", {{"/meshes/0/primitives/0/mode", "\"4\""}}},
        {"MaterialMissing", {{"/meshes/0/primitives/0/material", "5"}}},
        {"TargetMissing", {{"/meshes/0/primitives/0/targets/0/POSITION", "99"}}},
        {"TargetCount", {{"/meshes/0/primitives/0/targets/0/POSITION", "{single}"}}},
        {"TargetZerosOfOtherCount",
         {{"/accessors/{delta}/bufferView"}, {"/accessors/{delta}/count", "1099511627776"}}},
        {"TargetNumber", {{"/meshes/0/primitives/0/targets", "[{}, 1]"}}},
        {"TargetArray", {{"/meshes/0/primitives/0/targets", "[{}, []]"}}},
        {"TargetText", {{"/meshes/0/primitives/0/targets/0/POSITION", "\"x\""}}},
        {"TargetsDiffer", {{"/meshes/0/primitives/1", R"({"attributes": {"POSITION": {position}}})"}}},
        {"WeightsCount", {{"/meshes/0/weights", "[0, 0]"}}},
        {"WeightsText", {{"/meshes/0/weights", "[\"a\"]"}}},
        {"WeightsInfinite", {{"/meshes/0/weights", "[1e300]"}}},
        {"JointsWithoutWeights", {{"/meshes/0/primitives/0/attributes/WEIGHTS_0"}}},
        {"WeightsWithoutJoints", {{"/meshes/0/primitives/0/attributes/JOINTS_0"}}},
        {"JointOutOfRange", {{"/meshes/0/primitives/0/attributes/JOINTS_0", "{high_joint}"}}},
        {"JointsFloat", {{"/meshes/0/primitives/0/attributes/JOINTS_0", "{weights}"}}},
        {"PrimitiveNumber", {{"/meshes/0/primitives/0", "3"}}},
        {"MeshNumber", {{"/meshes/0", "3"}}}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(Nodes, Malformed,
                         testing::ValuesIn(std::vector<Lie>{
                             {"Cycle", {{"/nodes/2/children", "[1]"}}},
                             {"SelfCycle", {{"/nodes/0/children", "[0]"}}},
                             {"TwoParents", {{"/nodes/0/children", "[2]"}}},
                             {"ChildTwice", {{"/nodes/1/children", "[2, 2]"}}},
                             {"ChildMissing", {{"/nodes/0/children", "[99]"}}},
                             {"ChildNegative", {{"/nodes/0/children", "[-1]"}}},
                             {"ChildText", {{"/nodes/0/children", "[\"2\"]"}}},
                             {"ChildrenNumber", {{"/nodes/0/children", "2"}}},
                             {"MeshMissing", {{"/nodes/0/mesh", "1"}}},
                             {"MeshText", {{"/nodes/0/mesh", "\"0\""}}},
                             {"SkinMissing", {{"/nodes/0/skin", "1"}}},
                             {"CameraMissing", {{"/nodes/1/camera", "1"}}},
                             {"LightMissing",
                              {{"/nodes/1/extensions", R"({"KHR_lights_punctual": {"light": 0}})"}}},
                             {"LightWrapped",
                              {{"/extensions", R"({"KHR_lights_punctual": {"lights": [{"type": "point"}]}})"},
                               {"/nodes/1/extensions", R"({"KHR_lights_punctual": {"light": 4294967296}})"}}},
                             {"SceneMissing", {{"/scene", "1"}}},
                             {"SceneWithoutScenes", {{"/scenes"}}},
                             {"SceneNode", {{"/scenes/0/nodes", "[99]"}}},
                             {"SceneNodeText", {{"/scenes/0/nodes", "[\"0\"]"}}},
                             {"MatrixShort", {{"/nodes/1/matrix", "[1, 2, 3]"}}},
                             {"TranslationLong", {{"/nodes/1/translation", "[1, 2, 3, 4]"}}},
                             {"TranslationHuge", {{"/nodes/1/translation", "[1e300, 0, 0]"}}},
                             {"TranslationText", {{"/nodes/1/translation", "[\"a\", 0, 0]"}}},
                             {"RotationZero", {{"/nodes/1/rotation", "[0, 0, 0, 0]"}}},
                             {"ScaleText", {{"/nodes/1/scale", "\"big\""}}},
                             {"NodeWeights", {{"/nodes/0/weights", "[1, 2, 3]"}}},
                             {"NodeNumber", {{"/nodes/1", "3"}}},
                             {"NodesObject", {{"/nodes", "{}"}}},
                             {"JointMissing", {{"/skins/0/joints", "[99]"}}},
                             {"JointsEmpty", {{"/skins/0/joints", "[]"}}},
                             {"JointsAbsent", {{"/skins/0/joints"}}},
                             {"SkeletonMissing", {{"/skins/0/skeleton", "99"}}},
                             {"InverseBindsFew", {{"/skins/0/joints", "[0, 1, 2]"}}},
                             {"InverseBindsMissing", {{"/skins/0/inverseBindMatrices", "99"}}},
                             {"InverseBindsOfOtherType", {{"/skins/0/inverseBindMatrices", "{weights}"}}}}),
                         name_of);

INSTANTIATE_TEST_SUITE_P(
    Animations, Malformed,
    testing::ValuesIn(std::vector<Lie>{
        {"ValuesFew", {{"/accessors/{moves}/count", "1"}}},
        {"ValuesOfOtherType", {{"/animations/0/samplers/1/output", "{shape}"}}},
        {"SplineWithTooFewValues", {{"/animations/0/samplers/1/interpolation", "\"CUBICSPLINE\""}}},
        {"InterpolationUnknown", {{"/animations/0/samplers/1/interpolation", "\"BEZIER\""}}},
        {"InterpolationNumber", {{"/animations/0/samplers/1/interpolation", "1"}}},
        {"InputMissing", {{"/animations/0/samplers/0/input", "99"}}},
        {"InputAbsent", {{"/animations/0/samplers/0/input"}}},
        {"OutputMissing", {{"/animations/0/samplers/0/output", "99"}}},
        {"OutputHuge", {{"/accessors/{shape}/bufferView"}, {"/accessors/{shape}/count", "1099511627776"}}},
        {"SamplerMissing", {{"/animations/0/channels/0/sampler", "9"}}},
        {"SamplerText", {{"/animations/0/channels/0/sampler", "\"0\""}}},
        {"SamplerNumber", {{"/animations/0/samplers/0", "5"}}},
        {"NodeMissing", {{"/animations/0/channels/0/target/node", "99"}}},
        {"NoTarget", {{"/animations/0/channels/0/target"}}},
        {"NoPath", {{"/animations/0/channels/0/target/path"}}},
        {"NodeWithMatrix", {{"/nodes/1/matrix", "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"}}},
        {"WeightsWithoutTargets", {{"/meshes/0/primitives/0/targets"}}}}),
    name_of);

const char* const material_extensions = "/materials/0/extensions";
const char* const lights = "/extensions/KHR_lights_punctual/lights";

INSTANTIATE_TEST_SUITE_P(
    Surfaces, Malformed,
    testing::ValuesIn(std::vector<Lie>{
        {"TextureMissing", {{"/materials/0/emissiveTexture/index", "5"}}},
        {"TextureText", {{"/materials/0/emissiveTexture/index", "\"0\""}}},
        {"TextureWithoutIndex", {{"/materials/0/emissiveTexture", "{\"texCoord\": 0}"}}},
        {"SourceMissing", {{"/textures/0/source", "5"}}},
        {"SamplerOfTextureMissing", {{"/textures/0/sampler", "5"}}},
        {"WrapUnknown", {{"/samplers/0/wrapS", "1"}}},
        {"FactorCount", {{"/materials/0/emissiveFactor", "[1, 2]"}}},
        {"BaseColorCount", {{"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1, 1]"}}},
        {"FactorHuge", {{"/materials/0/emissiveFactor", "[1e300, 0, 0]"}}},
        {"FactorsNoObject", {{"/materials/0/pbrMetallicRoughness", "[1]"}}},
        {"TextureNoObject", {{"/materials/0/emissiveTexture", "[0]"}}},
        {"LensNoObject", {{"/cameras/0/perspective", "[0.7]"}}},
        {"AlphaModeUnknown", {{"/materials/0/alphaMode", "\"SOMETIMES\""}}},
        {"TransformText",
         {{"/materials/0/emissiveTexture/extensions", R"({"KHR_texture_transform": {"offset": "left"}})"}}},
        {"TransformWrapped",
         {{"/materials/0/emissiveTexture/extensions",
           R"({"KHR_texture_transform": {"texCoord": 4294967296}})"}}},
        {"TransformShort",
         {{"/materials/0/emissiveTexture/extensions", R"({"KHR_texture_transform": {"scale": [1]}})"}}},
        {"EmissiveStrength",
         {{"/materials/0/extensions", R"({"KHR_materials_emissive_strength": {"emissiveStrength": [1]}})"}}},
        {"EmissiveStrengthInfinite",
         {{"/materials/0/extensions", R"({"KHR_materials_emissive_strength": {"emissiveStrength": 1e38}})"},
          {"/materials/0/emissiveFactor", "[100, 0, 0]"}}},
        {"LayerNoObject", {{material_extensions, R"({"KHR_materials_clearcoat": [1]})"}}},
        {"LayerNull", {{material_extensions, R"({"KHR_materials_clearcoat": null})"}}},
        {"TransmissionText",
         {{material_extensions, R"({"KHR_materials_transmission": {"transmissionFactor": "1"}})"}}},
        {"TransmissionNull",
         {{material_extensions, R"({"KHR_materials_transmission": {"transmissionFactor": null}})"}}},
        {"IorHuge", {{material_extensions, R"({"KHR_materials_ior": {"ior": 1e300}})"}}},
        {"IorBoolean", {{material_extensions, R"({"KHR_materials_ior": {"ior": true}})"}}},
        {"AttenuationShort",
         {{material_extensions, R"({"KHR_materials_volume": {"attenuationColor": [1, 1]}})"}}},
        {"AttenuationText",
         {{material_extensions, R"({"KHR_materials_volume": {"attenuationColor": [1, 1, "1"]}})"}}},
        {"AttenuationNumber",
         {{material_extensions, R"({"KHR_materials_volume": {"attenuationColor": 1}})"}}},
        {"CoatTextureNumber",
         {{material_extensions, R"({"KHR_materials_clearcoat": {"clearcoatTexture": 0}})"}}},
        {"CoatTextureWithoutIndex",
         {{material_extensions, R"({"KHR_materials_clearcoat": {"clearcoatTexture": {"texCoord": 0}}})"}}},
        {"CoatTextureWrapped",
         {{material_extensions,
           R"({"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 4294967296}}})"}}},
        {"CoatTextureMissing",
         {{material_extensions, R"({"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 5}}})"}}},
        {"CoatTextureIndexArray",
         {{material_extensions, R"({"KHR_materials_clearcoat": {"clearcoatTexture": {"index": [0]}}})"}}},
        {"CoatTextureSetWrapped",
         {{material_extensions,
           R"({"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0, "texCoord": 4294967296}}})"}}},
        {"CoatNormalScale",
         {{material_extensions,
           R"({"KHR_materials_clearcoat": {"clearcoatNormalTexture": {"index": 0, "scale": "1"}}})"}}},
        {"ImageView", {{"/images/0/bufferView", "99"}}},
        {"ImageNowhere", {{"/images/0/bufferView"}}},
        {"ImageTwice", {{"/images/0/uri", "\"a.png\""}}},
        {"ImageBroken", {{"/images/0/bufferView", "{position_view}"}}},
        {"ImageViewBeyondBuffer",
         {{"/images/0/bufferView", "{values_view}"},
          {"/bufferViews/{values_view}/byteLength", "1099511627776"}}},
        {"ImageViewOffset",
         {{"/images/0/bufferView", "{values_view}"},
          {"/bufferViews/{values_view}/byteOffset", "1099511627776"}}},
        {"ImageDataEmpty", {{"/images/0", R"({"uri": "data:image/png;base64,"})"}}},
        {"ImageDataOfOtherKind", {{"/images/0", R"({"uri": "data:image/tga;base64,AAAA"})"}}},
        {"FieldOfViewZero", {{"/cameras/0/perspective/yfov", "0"}}},
        {"FieldOfViewMissing", {{"/cameras/0/perspective/yfov"}}},
        {"FieldOfViewTooWide", {{"/cameras/0/perspective/yfov", "3.2"}}},
        {"NearPlaneZero", {{"/cameras/0/perspective/znear", "0"}}},
        {"ClippingPlanes", {{"/cameras/0/perspective/zfar", "0.01"}}},
        {"CameraType", {{"/cameras/0/type", "\"fisheye\""}}},
        {"CameraWithout", {{"/cameras/0/perspective"}}},
        {"LightType", {{lights, R"([{"type": "laser"}])"}}},
        {"LightNumber", {{lights, "[7]"}}},
        {"LightNegative", {{lights, R"([{"type": "point", "intensity": -1}])"}}},
        {"LightColor", {{lights, R"([{"type": "point", "color": [1, 2]}])"}}},
        {"SpotWithoutCone", {{lights, R"([{"type": "spot"}])"}}},
        {"SpotCone",
         {{lights, R"([{"type": "spot", "spot": {"innerConeAngle": 1, "outerConeAngle": 0.5}}])"}}}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Buffers, Malformed,
    testing::ValuesIn(std::vector<Lie>{
        {"LengthBeyondChunk", {{"/buffers", R"([{"byteLength": 1099511627776}])"}}},
        {"LengthZero", {{"/buffers", R"([{"byteLength": 0}])"}}},
        {"LengthMissing", {{"/buffers", "[{}]"}}},
        {"ChunkTwice", {{"/buffers", R"([{"byteLength": 8}, {"byteLength": 8}])"}}},
        {"FileMissing", {{"/buffers", R"([{"byteLength": 8, "uri": "no.bin"}])"}}},
        {"FileAbsolute", {{"/buffers", R"([{"byteLength": 8, "uri": "/etc/passwd"}])"}}},
        {"FileAbove", {{"/buffers", R"([{"byteLength": 8, "uri": "../x.bin"}])"}}},
        {"FileDevice", {{"/buffers", R"([{"byteLength": 8, "uri": "/dev/zero"}])"}}},
        {"DataShort",
         {{"/buffers", R"([{"byteLength": 8, "uri": "data:application/octet-stream;base64,AAAA"}])"}}},
        {"DataBroken",
         {{"/buffers", R"([{"byteLength": 8, "uri": "data:application/octet-stream;base64,!!"}])"}}},
        {"UriNumber", {{"/buffers", R"([{"byteLength": 8, "uri": 5}])"}}},
        {"BufferNumber", {{"/buffers", "[5]"}}},
        {"BuffersObject", {{"/buffers", R"({"byteLength": 8})"}}},
        {"NoAsset", {{"/asset"}}},
        {"NoVersion", {{"/asset", "{}"}}},
        {"VersionOne", {{"/asset/version", "\"1.0\""}}},
        {"RequiredExtension", {{"/extensionsRequired", "[\"X_y\"]"}}}}),
    name_of);

// Numbers in the buffer that must not be there.
TEST(MalformedNumbers, AreRefused) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  struct Poke {
    const char* accessor;
    size_t index;
    float value;
  };
  for (const Poke& poke : {Poke{"position", 4, nan}, Poke{"position", 8, -infinity}, Poke{"delta", 3, nan},
                           Poke{"weights", 0, nan}, Poke{"weights", 0, -1}, Poke{"binds", 5, nan},
                           Poke{"times", 0, nan}, Poke{"times", 1, infinity}, Poke{"times", 1, -1},
                           Poke{"times", 1, 0}, Poke{"shape", 1, nan}, Poke{"moves", 2, infinity}}) {
    SCOPED_TRACE(fmt::format("{}[{}] = {}", poke.accessor, poke.index, poke.value));
    GoodFile file;
    file.poke(poke.accessor, poke.index, poke.value);
    expect_file_refused(file);
  }
}

// Files in which every number is true, but which name the same bytes again and again.
TEST(MalformedAmplification, SharedVerticesAreNotCopiedWithoutBound) {
  GltfBuilder gltf;
  const int positions = gltf.floats(std::vector<float>(29997), "VEC3");
  json primitives = json::array();
  for (int i = 0; i < 3000; ++i) {
    primitives.push_back({{"attributes", {{"POSITION", positions}, {fmt::format("_{}", i), positions}}}});
  }
  gltf.append("meshes", {{"primitives", primitives}});
  const std::string message = expect_refused(gltf.folder().write("scene.glb", gltf.glb()));
  EXPECT_NE(message.find("more than a file of this size can mean"), std::string::npos) << message;
}

TEST(MalformedAmplification, PosesAreNotLargerThanAFileCanMean) {
  GoodFile file;
  json joints = json::array(), nodes = json::array();
  for (int i = 0; i < 20000; ++i) {
    joints.push_back(i);
    nodes.push_back({{"mesh", 0}, {"skin", 0}});
  }
  file.gltf.root["nodes"] = nodes;
  file.gltf.root["skins"] = {{{"joints", joints}}};
  for (const char* section : {"scene", "scenes", "animations"}) file.gltf.root.erase(section);
  expect_file_refused(file);
}

TEST(MalformedAmplification, WeightsOfPosesAreNotEither) {
  GltfBuilder gltf;
  const int mesh = gltf.triangle_mesh();
  for (int i = 0; i < 5000; ++i) {
    gltf.primitive(mesh)["targets"].push_back(json::object());
    gltf.append("nodes", {{"mesh", mesh}});
  }
  const std::string message = expect_refused(gltf.folder().write("scene.glb", gltf.glb()));
  EXPECT_NE(message.find("more than a file of this size can mean"), std::string::npos) << message;
}

TEST(MalformedAmplification, EmptyObjectsDoNotFillTheMemory) {
  // Two bytes of a file become two thousand of a material.
  std::string text = R"({"asset": {"version": "2.0"}, "materials": [{})";
  for (int i = 0; i < 1000000; ++i) text += ",{}";
  const TemporaryFolder folder;
  const std::string message = expect_bad_input(folder.write("scene.gltf", text + "]}"));
  EXPECT_NE(message.find("JSON that takes"), std::string::npos) << message;
}

TEST(MalformedAmplification, ExtensionsAreNotCopiedToEverySampler) {
  GoodFile file;
  json& animation = file.gltf.root["animations"][0];
  const json sampler = animation["samplers"][0];
  json values = json::array();
  for (int i = 0; i < 20000; ++i) {
    animation["samplers"].push_back(sampler);
    values.push_back(i);
  }
  animation["extensions"]["X"]["y"] = values;
  expect_file_refused(file);
}

TEST(MalformedAmplification, AFileIsNotReadOverAndOver) {
  GoodFile file;
  constexpr size_t bytes = size_t(1) << 23;
  file.gltf.folder().write("b.bin", std::string(bytes, 'x'));
  file.gltf.root["buffers"] = json::array();
  for (int i = 0; i < 300; ++i)
    file.gltf.root["buffers"].push_back({{"byteLength", bytes}, {"uri", "b.bin"}});
  reset_peak();
  const size_t held = current_allocation();
  expect_bad_input(file.gltf.folder().write("scene.glb", file.gltf.glb()));
  EXPECT_LT(peak_allocation() - held, size_t(320) << 20);
}

std::string nested(const std::string& open, const std::string& close, size_t depth) {
  std::string text;
  for (size_t i = 0; i < depth; ++i) text += open;
  for (size_t i = 0; i < depth; ++i) text += close;
  return text;
}

TEST(MalformedText, IsRefused) {
  const TemporaryFolder folder;
  const std::string head = R"({"asset": {"version": "2.0"}, )", deep_array = nested("[", "]", 1000000);
  for (const std::string& text :
       {std::string(), std::string(" "), std::string("{"), std::string("null"), std::string("[]"),
        std::string("5"), std::string("\xff\xfe{}"), head + "}", std::string("{}{}"), std::string(1000, '['),
        std::string(3000000, '['), head + R"("extras": )" + deep_array + "}",
        head + R"("nodes": [)" + deep_array + "]}", deep_array, nested(R"({"a":)", "}", 300000),
        head + R"("extras": 1e999})", head + R"("nodes": [{"translation": [NaN, 0, 0]}]})",
        std::string(1 << 20, '\0')}) {
    SCOPED_TRACE(text.substr(0, 60));
    expect_refused(folder.write("scene.gltf", text));
    expect_refused(folder.write("scene.glb", make_glb(text, "1234")));
  }
}

TEST(MalformedText, TooManyValuesAreRefused) {
  const TemporaryFolder folder;
  std::string text = R"({"asset": {"version": "2.0"}, "extras": [0)";
  for (size_t i = 0; i < (size_t(1) << 24) + 10; ++i) text += ",0";
  const std::string message = expect_bad_input(folder.write("scene.gltf", text + "]}"));
  EXPECT_NE(message.find("JSON that takes"), std::string::npos) << message;
}

TEST(MalformedContainer, IsRefused) {
  const std::string whole = GoodFile().gltf.glb();
  const TemporaryFolder folder;
  uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, &whole[12], sizeof json_bytes);
  const uint32_t size = uint32_t(whole.size());
  struct Word {
    const char* what;
    size_t at;
    uint32_t value;
  };
  for (const Word& word :
       {Word{"magic", 0, 0}, Word{"version", 4, 1}, Word{"length", 8, 0}, Word{"length", 8, size + 4},
        Word{"length", 8, 0xffffffff}, Word{"JSON length", 12, 0}, Word{"JSON length", 12, size},
        Word{"JSON length", 12, 0xffffffff}, Word{"JSON type", 16, 0x004e4942},
        Word{"binary length", 20 + json_bytes, size}, Word{"binary length", 20 + json_bytes, 0xffffffff},
        Word{"binary type", 24 + json_bytes, 0x4e4f534a},
        // tinygltf 2.7 forgets the chunk's header of 8 bytes here and would read past the end.
        Word{"binary length", 20 + json_bytes, size - json_bytes - 20}}) {
    SCOPED_TRACE(fmt::format("{} {}", word.what, word.value));
    std::string changed = whole;
    std::memcpy(&changed[word.at], &word.value, sizeof word.value);
    expect_refused(folder.write("scene.glb", changed));
  }
}

TEST(MalformedContainer, AFolderOrNoFileIsRefused) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "folder.glb");
  expect_refused(folder.path() / "folder.glb");
  expect_refused(folder.path() / "missing.glb");
}

}  // namespace
}  // namespace lodestone::scene
