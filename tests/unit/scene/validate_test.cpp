// SPDX-License-Identifier: MIT
// A valid scene passes; with any one promise of scene.h broken it does not.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/scene/scene.h"

namespace lodestone::scene {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// One of everything: a skinned, morphing grid of two triangles, animated.
Scene valid_scene() {
  Scene s;
  s.name = "test.scene";
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  m.normals.assign(4, {0, 0, 1});
  m.tangents.assign(4, {1, 0, 0, 1});
  m.texcoords[0].assign(4, {0, 0});
  m.texcoords[1].assign(4, {0, 0});
  m.colors.assign(4, glm::vec4(1));
  m.triangles = {{0, 1, 2}, {3, 2, 1}};
  m.parts = {{0, 1, 0}, {1, 1, none}};
  m.targets = {{"t", {0, 2}, {{0, 0, 1}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}}};
  m.weights = {0.5f};
  m.first_influence = {0, 1, 2, 3, 5};
  m.influences = {{0, 1}, {0, 1}, {0, 1}, {0, 0.25f}, {1, 0.75f}};
  m.grids = {{2, 2, 0, {0, 1, 2, 3}}};
  s.meshes = {m};
  s.nodes.resize(3);
  s.nodes[0].mesh = 0;
  s.nodes[0].skin = 0;
  s.nodes[0].weights = {1};
  s.nodes[1].parent = 0;
  s.nodes[1].camera = 0;
  s.nodes[2].parent = 1;
  s.nodes[2].light = 0;
  s.nodes[2].matrix = glm::mat4(1);
  s.skins = {{"", {1, 2}, {glm::mat4(1), glm::mat4(1)}}};
  s.cameras.resize(1);
  s.lights.resize(1);
  s.images = {{"", 1, 1, {1, 2, 3, 4}}};
  s.materials.resize(1);
  s.materials[0].base_color_texture.image = 0;
  using P = Channel::Path;
  using I = Channel::Interpolation;
  s.animations = {{"clip",
                   {{1, P::translation, I::linear, {0, 1}, {0, 0, 0, 1, 1, 1}},
                    {1, P::rotation, I::cubic_spline, {0}, std::vector<float>(12, 1)},
                    {0, P::weights, I::step, {0, 2}, {0, 1}}}}};
  s.sky = Sky{};
  s.environment = Environment{"map", 2, 1, {{1, 1, 1}, {2, 2, 2}}};
  return s;
}

struct Breakage {
  const char* name;
  std::function<void(Scene&)> apply;
};

void PrintTo(const Breakage& breakage, std::ostream* out) {
  *out << breakage.name;
}

class Validate : public testing::TestWithParam<Breakage> {};

TEST_P(Validate, Rejects) {
  Scene scene = valid_scene();
  GetParam().apply(scene);
  try {
    validate(scene);
    ADD_FAILURE() << "passed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    EXPECT_TRUE(std::string(error.what()).starts_with("test.scene: ")) << error.what();
  }
}

TEST(ValidateScene, AcceptsAValidAndAnEmptyScene) {
  EXPECT_NO_THROW(validate(valid_scene()));
  EXPECT_NO_THROW(validate({}));
}

// The name of a breakage and the statements that make it.
#define BREAK(name, ...)                \
  Breakage {                            \
    name, [](Scene& s) { __VA_ARGS__; } \
  }

std::string name_of(const testing::TestParamInfo<Breakage>& tested) {
  return tested.param.name;
}

INSTANTIATE_TEST_SUITE_P(Mesh, Validate,
                         testing::Values(BREAK("NormalCount", s.meshes[0].normals.pop_back()),
                                         BREAK("TangentCount", s.meshes[0].tangents.pop_back()),
                                         BREAK("TexcoordCount", s.meshes[0].texcoords[1].pop_back()),
                                         BREAK("ColorCount", s.meshes[0].colors.pop_back()),
                                         BREAK("PositionNaN", s.meshes[0].positions[3].z = nan),
                                         BREAK("NormalInfinite", s.meshes[0].normals[0].x = infinity),
                                         BREAK("TangentNaN", s.meshes[0].tangents[0].w = nan),
                                         BREAK("TexcoordNaN", s.meshes[0].texcoords[0][1].y = nan),
                                         BREAK("ColorNaN", s.meshes[0].colors[1].a = nan),
                                         BREAK("TriangleIndex", s.meshes[0].triangles[1].x = 4),
                                         BREAK("PartGap", s.meshes[0].parts[1].first_triangle = 0),
                                         BREAK("PartShort", s.meshes[0].parts.pop_back()),
                                         BREAK("PartEmpty", s.meshes[0].parts.push_back({2, 0, none})),
                                         BREAK("PartMaterial", s.meshes[0].parts[1].material = 1),
                                         BREAK("WeightCount", s.meshes[0].weights.clear()),
                                         BREAK("WeightNaN", s.meshes[0].weights[0] = nan),
                                         BREAK("GridSmall", s.meshes[0].grids[0].width = 1),
                                         BREAK("GridVertices", s.meshes[0].grids[0].vertices.pop_back()),
                                         BREAK("GridOtherTriangles", s.meshes[0].triangles[1] = {2, 1, 3}),
                                         BREAK("GridFirstTriangle", s.meshes[0].grids[0].first_triangle = 1),
                                         BREAK("GridIncomplete", s.meshes[0].triangles.push_back({0, 1, 2});
                                               s.meshes[0].parts[1].triangle_count = 2)),
                         name_of);

INSTANTIATE_TEST_SUITE_P(
    TargetsAndSkins, Validate,
    testing::Values(BREAK("TargetVertex", s.meshes[0].targets[0].vertices[1] = 4),
                    BREAK("TargetOrder", s.meshes[0].targets[0].vertices[1] = 0),
                    BREAK("TargetPositions", s.meshes[0].targets[0].positions.pop_back()),
                    BREAK("TargetNormals", s.meshes[0].targets[0].normals.pop_back()),
                    BREAK("TargetTangents", s.meshes[0].targets[0].tangents.pop_back()),
                    BREAK("TargetNaN", s.meshes[0].targets[0].positions[0].x = nan),
                    BREAK("InfluenceCount", s.meshes[0].first_influence.pop_back()),
                    BREAK("InfluenceEnd", s.meshes[0].influences.pop_back()),
                    BREAK("InfluenceOrder", s.meshes[0].first_influence[1] = 3),
                    BREAK("InfluenceRange", s.meshes[0].first_influence[2] = 0xfffffff0),
                    BREAK("InfluenceSum", s.meshes[0].influences[4].weight = 0.5f),
                    BREAK("InfluenceNaN", s.meshes[0].influences[0].weight = nan),
                    BREAK("InfluenceJoint", s.meshes[0].influences[0].joint = 2),
                    BREAK("SkinJoint", s.skins[0].joints[0] = 3), BREAK("SkinEmpty", s.skins.push_back({})),
                    BREAK("SkinBinds", s.skins[0].inverse_binds.pop_back()),
                    BREAK("SkinBindNaN", s.skins[0].inverse_binds[1][3].x = nan)),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    NodesAndAnimations, Validate,
    testing::Values(BREAK("ParentAfter", s.nodes[1].parent = 2), BREAK("ParentSelf", s.nodes[1].parent = 1),
                    BREAK("ParentRange", s.nodes[1].parent = 77), BREAK("MeshRange", s.nodes[1].mesh = 1),
                    BREAK("SkinRange", s.nodes[0].skin = 1), BREAK("CameraRange", s.nodes[1].camera = 1),
                    BREAK("LightRange", s.nodes[2].light = 1), BREAK("SkinMissing", s.nodes[0].skin = none),
                    BREAK("SkinWithoutMesh", s.nodes[1].skin = 0),
                    BREAK("NodeWeights", s.nodes[0].weights = {1, 2}),
                    BREAK("TranslationNaN", s.nodes[0].translation.x = nan),
                    BREAK("RotationNaN", s.nodes[0].rotation.w = nan),
                    BREAK("ScaleNaN", s.nodes[0].scale.x = nan),
                    BREAK("MatrixNaN", (*s.nodes[2].matrix)[0].x = nan),
                    BREAK("ChannelNode", s.animations[0].channels[0].node = 3),
                    BREAK("ChannelMatrix", s.animations[0].channels[0].node = 2),
                    BREAK("ChannelEmpty", s.animations[0].channels[0].times.clear();
                          s.animations[0].channels[0].values.clear()),
                    BREAK("ChannelOrder", s.animations[0].channels[0].times[1] = 0),
                    BREAK("ChannelTimeNaN", s.animations[0].channels[0].times[1] = nan),
                    BREAK("ChannelValues", s.animations[0].channels[0].values.pop_back()),
                    BREAK("ChannelSplineValues", s.animations[0].channels[1].values.resize(4)),
                    BREAK("ChannelValueNaN", s.animations[0].channels[2].values[0] = nan),
                    BREAK("ChannelWeights", s.animations[0].channels[2].node = 1)),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Rest, Validate,
    testing::Values(
        BREAK("CameraNaN", s.cameras[0].znear = nan), BREAK("CameraFieldOfView", s.cameras[0].yfov = 0),
        BREAK("CameraExtent", s.cameras[0].perspective = false; s.cameras[0].xmag = 0),
        BREAK("CameraFar", s.cameras[0].zfar = -1), BREAK("LightNaN", s.lights[0].color.x = nan),
        BREAK("LightIntensity", s.lights[0].intensity = -1), BREAK("LightColour", s.lights[0].color.x = -1),
        BREAK("LightTooBright", s.lights[0].intensity = 3e38f; s.lights[0].color.x = 10),
        BREAK("EmissionNegative", s.materials[0].emissive.x = -1),
        BREAK("EmissionTooBright", s.materials[0].emissive.x = 1e31f),
        BREAK("MaterialNaN", s.materials[0].emissive.x = infinity),
        BREAK("IorBelowOne", s.materials[0].ior = 0.5f), BREAK("IorNaN", s.materials[0].ior = nan),
        BREAK("SpecularNegative", s.materials[0].specular = -0.5f),
        BREAK("SpecularColour", s.materials[0].specular_color.y = infinity),
        BREAK("TransmissionAboveOne", s.materials[0].transmission = 1.5f),
        BREAK("ThicknessNegative", s.materials[0].thickness = -1),
        BREAK("AttenuationDistance", s.materials[0].attenuation_distance = infinity),
        BREAK("AttenuationColour", s.materials[0].attenuation_color.z = 2),
        BREAK("ClearcoatNaN", s.materials[0].clearcoat = nan),
        BREAK("ClearcoatRoughness", s.materials[0].clearcoat_roughness = 2),
        BREAK("ClearcoatScale", s.materials[0].clearcoat_normal_scale = nan),
        BREAK("ClearcoatTexture", s.materials[0].clearcoat_normal_texture.image = 1),
        BREAK("TextureImage", s.materials[0].normal_texture.image = 1),
        BREAK("TextureCoordinates", s.materials[0].normal_texture.texcoord = 2),
        BREAK("TextureTransform", s.materials[0].normal_texture.u_row.x = nan),
        BREAK("ImageEmpty", s.images[0].width = 0), BREAK("ImageShort", s.images[0].rgba.pop_back()),
        BREAK("SkyNaN", s.sky->top.x = nan), BREAK("EnvironmentEmpty", s.environment = Environment{}),
        BREAK("EnvironmentShort", s.environment->radiance.pop_back()),
        BREAK("EnvironmentWide", s.environment->width = 16385; s.environment->radiance.resize(16385)),
        BREAK("EnvironmentNegative", s.environment->radiance[1].z = -1),
        BREAK("EnvironmentNaN", s.environment->radiance[0].x = nan),
        BREAK("EnvironmentTooBright", s.environment->radiance[0].x = 1e25f; s.environment->strength = 1e6f),
        BREAK("EnvironmentStrength", s.environment->strength = -1),
        BREAK("EnvironmentRotation", s.environment->rotation = infinity)),
    name_of);

}  // namespace
}  // namespace lodestone::scene
