// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_builder.h"

namespace lodestone::scene {
namespace {

// Two images, each a texel: red and a quarter-transparent green.
void add_images(GltfBuilder& gltf) {
  gltf.append("images", {{"name", "red"},
                         {"mimeType", "image/png"},
                         {"bufferView", gltf.view_bytes(make_png(1, 1, 3, {255, 0, 0}))}});
  gltf.append("images", {{"mimeType", "image/png"},
                         {"bufferView", gltf.view_bytes(make_png(1, 1, 4, {0, 200, 0, 64}))}});
}

TEST(GltfMaterial, HasTheDefaultsOfTheFormat) {
  GltfBuilder gltf;
  gltf.append("materials", json::object());
  const Material m = gltf.load().materials.at(0);
  EXPECT_EQ(m.base_color, glm::vec4(1));
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.emissive, glm::vec3(0));
  EXPECT_EQ(m.normal_scale, 1);
  EXPECT_EQ(m.occlusion_strength, 1);
  EXPECT_FALSE(m.alpha_mask);
  EXPECT_FALSE(m.double_sided);
  EXPECT_EQ(m.base_color_texture.image, none);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.specular, 1);
  EXPECT_EQ(m.specular_color, glm::vec3(1));
  EXPECT_EQ(m.transmission, 0);
  EXPECT_EQ(m.thickness, 0);
  EXPECT_EQ(m.attenuation_color, glm::vec3(1));
  EXPECT_EQ(m.attenuation_distance, 0);
  EXPECT_EQ(m.clearcoat, 0);
  EXPECT_EQ(m.clearcoat_roughness, 0);
  EXPECT_EQ(m.clearcoat_normal_scale, 1);
}

// A material with those extensions and nothing else.
Material layered(const json& extensions) {
  GltfBuilder gltf;
  add_images(gltf);
  gltf.append("textures", {{"source", 0}});
  gltf.append("textures", {{"source", 1}});
  for (const auto& [name, values] : extensions.items()) gltf.root["extensionsRequired"].push_back(name);
  gltf.append("materials", {{"extensions", extensions}});
  return gltf.load().materials.at(0);
}

TEST(GltfMaterial, ReadsTransmissionAndVolume) {
  const Material m =
      layered({{"KHR_materials_ior", {{"ior", 1.33}}},
               {"KHR_materials_transmission",
                {{"transmissionFactor", 0.75}, {"transmissionTexture", {{"index", 1}, {"texCoord", 1}}}}},
               {"KHR_materials_volume",
                {{"thicknessFactor", 2},
                 {"attenuationColor", {0.5, 0.25, 1}},
                 {"attenuationDistance", 3},
                 {"thicknessTexture", {{"index", 0}}}}}});
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_EQ(m.transmission, 0.75f);
  EXPECT_EQ(m.transmission_texture.image, 1u);
  EXPECT_EQ(m.transmission_texture.texcoord, 1u);
  EXPECT_EQ(m.thickness, 2);
  EXPECT_EQ(m.attenuation_color, glm::vec3(0.5f, 0.25f, 1));
  EXPECT_EQ(m.attenuation_distance, 3);
}

TEST(GltfMaterial, ReadsClearcoat) {
  const json transform = {{"KHR_texture_transform", {{"offset", {0.5, 0.25}}}}};
  const Material m = layered({{"KHR_materials_clearcoat",
                               {{"clearcoatFactor", 0.5},
                                {"clearcoatRoughnessFactor", 0.25},
                                {"clearcoatTexture", {{"index", 0}, {"extensions", transform}}},
                                {"clearcoatRoughnessTexture", {{"index", 1}}},
                                {"clearcoatNormalTexture", {{"index", 1}, {"scale", 0.125}}}}}});
  EXPECT_EQ(m.clearcoat, 0.5f);
  EXPECT_EQ(m.clearcoat_roughness, 0.25f);
  EXPECT_EQ(m.clearcoat_normal_scale, 0.125f);
  EXPECT_EQ(m.clearcoat_texture.image, 0u);
  EXPECT_EQ(m.clearcoat_texture.u_row, glm::vec3(1, 0, 0.5f));
  EXPECT_EQ(m.clearcoat_texture.v_row, glm::vec3(0, 1, 0.25f));
  EXPECT_EQ(m.clearcoat_roughness_texture.image, 1u);
  EXPECT_EQ(m.clearcoat_normal_texture.image, 1u);
}

TEST(GltfMaterial, ReadsSpecular) {
  const Material m = layered({{"KHR_materials_specular",
                               {{"specularFactor", 0.5},
                                {"specularColorFactor", {0.5, 2, 0}},
                                {"specularTexture", {{"index", 1}}},
                                {"specularColorTexture", {{"index", 0}}}}}});
  EXPECT_EQ(m.specular, 0.5f);
  EXPECT_EQ(m.specular_color, glm::vec3(0.5f, 2, 0)) << "may be more than white";
  EXPECT_EQ(m.specular_texture.image, 1u);
  EXPECT_EQ(m.specular_color_texture.image, 0u);
}

TEST(GltfMaterial, TakesTheNearestNumberThatThereIs) {
  const Material low =
      layered({{"KHR_materials_ior", {{"ior", 0.5}}},
               {"KHR_materials_specular", {{"specularFactor", -1}, {"specularColorFactor", {-1, 0, 0}}}},
               {"KHR_materials_transmission", {{"transmissionFactor", -1}}},
               {"KHR_materials_volume",
                {{"thicknessFactor", -1}, {"attenuationColor", {-1, 2, 0}}, {"attenuationDistance", -1}}},
               {"KHR_materials_clearcoat", {{"clearcoatFactor", -1}, {"clearcoatRoughnessFactor", -1}}}});
  EXPECT_EQ(low.ior, 1);
  EXPECT_EQ(low.specular, 0);
  EXPECT_EQ(low.specular_color, glm::vec3(0));
  EXPECT_EQ(low.transmission, 0);
  EXPECT_EQ(low.thickness, 0);
  EXPECT_EQ(low.attenuation_color, glm::vec3(0, 1, 0));
  EXPECT_EQ(low.attenuation_distance, 0);
  EXPECT_EQ(low.clearcoat, 0);
  EXPECT_EQ(low.clearcoat_roughness, 0);
  const Material high =
      layered({{"KHR_materials_ior", {{"ior", 0}}},
               {"KHR_materials_specular", {{"specularFactor", 2}}},
               {"KHR_materials_transmission", {{"transmissionFactor", 2}}},
               {"KHR_materials_clearcoat", {{"clearcoatFactor", 2}, {"clearcoatRoughnessFactor", 2}}}});
  EXPECT_EQ(high.ior, 0) << "infinite";
  EXPECT_EQ(high.specular, 1);
  EXPECT_EQ(high.transmission, 1);
  EXPECT_EQ(high.clearcoat, 1);
  EXPECT_EQ(high.clearcoat_roughness, 1);
}

TEST(GltfMaterial, ExtensionsWithoutValuesHaveTheirDefaults) {
  const Material m = layered({{"KHR_materials_ior", json::object()},
                              {"KHR_materials_specular", json::object()},
                              {"KHR_materials_transmission", json::object()},
                              {"KHR_materials_volume", json::object()},
                              {"KHR_materials_clearcoat", json::object()}});
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.specular, 1);
  EXPECT_EQ(m.specular_color, glm::vec3(1));
  EXPECT_EQ(m.transmission, 0);
  EXPECT_EQ(m.attenuation_color, glm::vec3(1));
  EXPECT_EQ(m.clearcoat, 0);
  for (const Texture* texture : m.textures()) EXPECT_EQ(texture->image, none);
}

TEST(GltfMaterial, ReadsFactorsAndEmissiveStrength) {
  GltfBuilder gltf;
  gltf.root["extensionsUsed"] = {"KHR_materials_emissive_strength"};
  gltf.append(
      "materials",
      {{"name", "glow"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 0.25, 0.125, 1}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.75}}},
       {"emissiveFactor", {1, 0.5, 0}},
       {"doubleSided", true},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}});
  const Material m = gltf.load().materials.at(0);
  EXPECT_EQ(m.name, "glow");
  EXPECT_EQ(m.base_color, glm::vec4(0.5f, 0.25f, 0.125f, 1));
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.75f);
  EXPECT_EQ(m.emissive, glm::vec3(4, 2, 0));
  EXPECT_TRUE(m.double_sided);
}

TEST(GltfMaterial, CutsOutMaskedAndBlendedSurfaces) {
  GltfBuilder gltf;
  gltf.append("materials", {{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}});
  gltf.append("materials", {{"alphaMode", "BLEND"}, {"alphaCutoff", 0.25}});
  gltf.append("materials", {{"alphaMode", "OPAQUE"}});
  const Scene scene = gltf.load();
  EXPECT_TRUE(scene.materials[0].alpha_mask);
  EXPECT_EQ(scene.materials[0].alpha_cutoff, 0.25f);
  EXPECT_TRUE(scene.materials[1].alpha_mask);
  EXPECT_EQ(scene.materials[1].alpha_cutoff, 0.5f);
  EXPECT_FALSE(scene.materials[2].alpha_mask);
}

TEST(GltfMaterial, ReadsAllFiveTextures) {
  GltfBuilder gltf;
  add_images(gltf);
  gltf.append("textures", {{"source", 0}});
  gltf.append("textures", {{"source", 1}});
  gltf.append("materials", {{"pbrMetallicRoughness",
                             {{"baseColorTexture", {{"index", 1}}},
                              {"metallicRoughnessTexture", {{"index", 0}, {"texCoord", 1}}}}},
                            {"normalTexture", {{"index", 1}, {"scale", 0.5}}},
                            {"occlusionTexture", {{"index", 0}, {"strength", 0.25}}},
                            {"emissiveTexture", {{"index", 1}}}});
  const Scene scene = gltf.load();
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.base_color_texture.image, 1u);
  EXPECT_EQ(m.metallic_roughness_texture.image, 0u);
  EXPECT_EQ(m.metallic_roughness_texture.texcoord, 1u);
  EXPECT_EQ(m.normal_texture.image, 1u);
  EXPECT_EQ(m.normal_scale, 0.5f);
  EXPECT_EQ(m.occlusion_texture.image, 0u);
  EXPECT_EQ(m.occlusion_strength, 0.25f);
  EXPECT_EQ(m.emissive_texture.image, 1u);
  EXPECT_EQ(scene.images.at(0).name, "red");
  EXPECT_EQ(scene.images[0].rgba, (std::vector<uint8_t>{255, 0, 0, 255}));
  EXPECT_EQ(scene.images[1].rgba, (std::vector<uint8_t>{0, 200, 0, 64})) << "alpha is not multiplied in";
}

TEST(GltfMaterial, ReadsSamplers) {
  GltfBuilder gltf;
  add_images(gltf);
  gltf.append("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
  gltf.append("samplers", json::object());
  gltf.append("textures", {{"source", 0}, {"sampler", 0}});
  gltf.append("textures", {{"source", 0}, {"sampler", 1}});
  gltf.append("materials", {{"emissiveTexture", {{"index", 0}}}, {"normalTexture", {{"index", 1}}}});
  const Material m = gltf.load().materials.at(0);
  EXPECT_EQ(m.emissive_texture.wrap_u, Texture::Wrap::clamp);
  EXPECT_EQ(m.emissive_texture.wrap_v, Texture::Wrap::mirror);
  EXPECT_TRUE(m.emissive_texture.nearest);
  EXPECT_EQ(m.normal_texture.wrap_u, Texture::Wrap::repeat);
  EXPECT_FALSE(m.normal_texture.nearest);
}

TEST(GltfMaterial, AppliesTextureTransforms) {
  GltfBuilder gltf;
  gltf.root["extensionsUsed"] = {"KHR_texture_transform"};
  add_images(gltf);
  gltf.append("textures", {{"source", 0}});
  const json transform = {
      {"offset", {0.5, 0.25}}, {"rotation", M_PI / 2}, {"scale", {2, 3}}, {"texCoord", 1}};
  gltf.append("materials",
              {{"emissiveTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}});
  const Texture t = gltf.load().materials.at(0).emissive_texture;
  EXPECT_EQ(t.texcoord, 1u) << "the extension's set replaces the other";
  // Scaled to (2, 3); a quarter turn counter-clockwise with v down takes (u, v) to (v, -u); then moved.
  const glm::vec3 uv(1, 1, 1);
  EXPECT_NEAR(glm::dot(t.u_row, uv), 3 + 0.5, 1e-5);
  EXPECT_NEAR(glm::dot(t.v_row, uv), -2 + 0.25, 1e-5);
}

TEST(GltfMaterial, IgnoresTexturesOfFurtherCoordinateSetsOrWithoutImage) {
  GltfBuilder gltf;
  add_images(gltf);
  gltf.append("textures", {{"source", 0}});
  gltf.append("textures", json::object());
  gltf.append("materials",
              {{"emissiveTexture", {{"index", 0}, {"texCoord", 2}}}, {"normalTexture", {{"index", 1}}}});
  const Material m = gltf.load().materials.at(0);
  EXPECT_EQ(m.emissive_texture.image, none);
  EXPECT_EQ(m.normal_texture.image, none);
}

TEST(GltfMaterial, DecodesAnImageThatIsNamedTwiceOnce) {
  GltfBuilder gltf;
  add_images(gltf);
  gltf.root["images"].push_back(gltf.root["images"][0]);
  gltf.append("textures", {{"source", 2}});
  gltf.append("materials", {{"emissiveTexture", {{"index", 0}}}});
  const Scene scene = gltf.load();
  EXPECT_EQ(scene.images.size(), 2u);
  EXPECT_EQ(scene.materials.at(0).emissive_texture.image, 0u);
}

}  // namespace
}  // namespace lodestone::scene
