// SPDX-License-Identifier: MIT
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "scene_files.h"

namespace lodestone::scene::test {
namespace {

// Nine triangles' worth of vertices; a face of each material named.
std::string model(const std::string& libraries, const std::vector<std::string>& materials) {
  std::string text = libraries + "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const std::string& material : materials) text += "usemtl " + material + "\nf 1 2 3\n";
  return text;
}

class ObjMaterial : public testing::Test {
 protected:
  // The only material of a library of that text.
  Material material(const std::string& properties) const {
    folder_.write("m.mtl", "newmtl only\n" + properties);
    const Scene scene = load_valid(folder_.write("m.obj", model("mtllib m.mtl\n", {"only"})));
    EXPECT_EQ(scene.materials.size(), 1u);
    return scene.materials.at(0);
  }

  // A 1 x 1 PNG of that red.
  std::filesystem::path write_image(const std::string& name, uint8_t red) const {
    const std::filesystem::path path = folder_.path() / name;
    std::filesystem::create_directories(path.parent_path());
    const auto output = OIIO::ImageOutput::create(path.string());
    const uint8_t texel[3] = {red, 0, 0};
    EXPECT_TRUE(output->open(path.string(), OIIO::ImageSpec(1, 1, 3, OIIO::TypeDesc::UINT8)));
    EXPECT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, texel));
    EXPECT_TRUE(output->close());
    return path;
  }

  TemporaryFolder folder_;
};

TEST_F(ObjMaterial, PartsAreRunsOfOneMaterialInTheOrderOfTheFile) {
  folder_.write("m.mtl", "newmtl a\nnewmtl b\n");
  const Scene scene = load_valid(
      folder_.write("m.obj", model("mtllib m.mtl\n", {"b", "b", "a", "b"}) + "g other\nf 1 2 3\n"));
  const std::vector<Part>& parts = scene.meshes[0].parts;
  ASSERT_EQ(parts.size(), 3u);
  const uint32_t firsts[] = {0, 2, 3}, counts[] = {2, 1, 2}, materials[] = {1, 0, 1};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(parts[i].first_triangle, firsts[i]);
    EXPECT_EQ(parts[i].triangle_count, counts[i]);
    EXPECT_EQ(parts[i].material, materials[i]);
  }
}

TEST_F(ObjMaterial, ColoursMetalAndRoughnessAreRead) {
  const Material read =
      material("Kd 0.25 0.5 2\nKe 0 3 0.5\nPm 0.75\nPr 0.125\nd 0.5\nillum 2\nmap_Bump b.png\n");
  EXPECT_EQ(read.base_color, glm::vec4(0.25f, 0.5f, 1, 1));
  EXPECT_EQ(read.emissive, glm::vec3(0, 3, 0.5f));
  EXPECT_EQ(read.metallic, 0.75f);
  EXPECT_EQ(read.roughness, 0.125f);
  EXPECT_FALSE(read.alpha_mask);
}

TEST_F(ObjMaterial, WithoutPropertiesItIsARoughWhiteDielectric) {
  const Material read = material("");
  EXPECT_EQ(read.base_color, glm::vec4(1));
  EXPECT_EQ(read.metallic, 0);
  EXPECT_EQ(read.roughness, 1);
  EXPECT_EQ(read.base_color_texture.image, none);
}

TEST_F(ObjMaterial, OneNumberIsAGrey) {
  EXPECT_EQ(material("Kd .5\n").base_color, glm::vec4(0.5f, 0.5f, 0.5f, 1));
}

// alpha^2 = 2 / (Ns + 2), alpha = roughness^2.
TEST_F(ObjMaterial, SpecularExponentBecomesRoughness) {
  EXPECT_FLOAT_EQ(material("Ns 0\n").roughness, 1);
  EXPECT_FLOAT_EQ(material("Ns 6\n").roughness, std::sqrt(0.5f));
  EXPECT_FLOAT_EQ(material("Ns 510\n").roughness, 0.25f);
}

TEST_F(ObjMaterial, RoughnessCountsMoreThanTheExponentInEitherOrder) {
  EXPECT_EQ(material("Ns 6\nPr 0\n").roughness, 0);
  EXPECT_EQ(material("Pr 0\nNs 6\n").roughness, 0);
}

TEST_F(ObjMaterial, ClearcoatIsRead) {
  const Material read = material("Pc 0.5\nPcr 0.25\n");
  EXPECT_EQ(read.clearcoat, 0.5f);
  EXPECT_EQ(read.clearcoat_roughness, 0.25f);
  EXPECT_EQ(material("Pc 2\nPcr -1\n").clearcoat, 1);
}

// In whatever order the statements come.
TEST_F(ObjMaterial, ModelsThatLetLightThroughDoByTheirOpacity) {
  for (const std::string text :
       {"Kd 0 0 1\nd 0.25\nTf 1 1 0\nillum 9\n", "illum 9\nTf 1 1 0\nd .25\nKd 0 0 1\n",
        "Tr 0.75\nillum 4\nKd 0 0 1\nTf 1 1 0\n"}) {
    const Material read = material(text);
    EXPECT_EQ(read.transmission, 0.75f) << text;
    EXPECT_EQ(read.thickness, 0) << text;
    EXPECT_EQ(read.base_color, glm::vec4(0.75f, 0.75f, 0.25f, 1)) << text;
  }
}

TEST_F(ObjMaterial, ModelsThatRefractAreClearSolids) {
  const Material glass = material("illum 7\nKd 0 0 0\nNi 1.75\n");
  EXPECT_EQ(glass.transmission, 1);
  EXPECT_EQ(glass.ior, 1.75f);
  EXPECT_GT(glass.thickness, 0);
  EXPECT_EQ(glass.base_color, glm::vec4(1)) << "black is what it scatters";
  EXPECT_EQ(material("illum 6\nd 0.5\n").transmission, 0.5f);
  EXPECT_EQ(material("illum 6\nNi 1\n").ior, 1) << "invisible, if that is what is asked for";
}

TEST_F(ObjMaterial, OpaqueModelsStayOpaque) {
  for (const std::string text : {"illum 2\nd 0.5\n", "d 0.5\n", "illum 4\nTf 1 1 1\n", "illum 9\nd 1\n"})
    EXPECT_EQ(material(text).transmission, 0) << text;
  EXPECT_EQ(material("Ni 1.25\n").ior, 1.25f);
  for (const std::string text : {"Ni 1\n", "Ni 0.001\n", "illum 2\n"})
    EXPECT_EQ(material(text).ior, 1.5f) << text;
}

TEST_F(ObjMaterial, WhatOneMaterialSaysIsNotSaidOfTheNext) {
  folder_.write("m.mtl", "newmtl a\nillum 7\nNi 2\nnewmtl b\nPc 1\nnewmtl c\n");
  const Scene scene = load_valid(folder_.write("m.obj", model("mtllib m.mtl\n", {"a", "b", "c"})));
  EXPECT_EQ(scene.materials[0].transmission, 1);
  EXPECT_EQ(scene.materials[1].transmission, 0);
  EXPECT_EQ(scene.materials[1].ior, 1.5f);
  EXPECT_EQ(scene.materials[2].clearcoat, 0);
}

TEST_F(ObjMaterial, TextureOptionsAreReadInTheirOwnOrientation) {
  write_image("a b.png", 7);
  const Material read = material("map_Kd -blendu on -s 2 4 1 -o 0.5 0.25 -mm 0 1 -clamp on a b.png\n");
  EXPECT_EQ(read.base_color_texture.image, 0u);
  EXPECT_EQ(read.base_color_texture.wrap_u, Texture::Wrap::clamp);
  EXPECT_EQ(read.base_color_texture.wrap_v, Texture::Wrap::clamp);
  EXPECT_EQ(read.base_color_texture.u_row, glm::vec3(2, 0, 0.5f));
  // v from the bottom is 1 - v; scaled and shifted 4 (1 - v) + 0.25, from the top again 4 v - 3.25.
  EXPECT_EQ(read.base_color_texture.v_row, glm::vec3(0, 4, -3.25f));
}

TEST_F(ObjMaterial, WithoutOptionsATextureIsNeitherMovedNorScaled) {
  write_image("t.png", 7);
  const Material read = material("map_Kd t.png\nmap_Ke t.png\n");
  EXPECT_EQ(read.base_color_texture.wrap_u, Texture::Wrap::repeat);
  EXPECT_EQ(read.base_color_texture.u_row, glm::vec3(1, 0, 0));
  EXPECT_EQ(read.base_color_texture.v_row, glm::vec3(0, 1, 0));
  EXPECT_EQ(read.emissive_texture.image, 0u);
}

TEST_F(ObjMaterial, AnImageOfSeveralMaterialsIsLoadedOnce) {
  write_image("textures/t.png", 200);
  folder_.write("m.mtl", "newmtl a\nmap_Kd textures/t.png\nnewmtl b\nmap_Kd textures\\t.png\n");
  const Scene scene = load_valid(folder_.write("m.obj", model("mtllib m.mtl\n", {"a", "b"})));
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0].rgba, (std::vector<uint8_t>{200, 0, 0, 255}));
  EXPECT_EQ(scene.materials[0].base_color_texture.image, 0u);
  EXPECT_EQ(scene.materials[1].base_color_texture.image, 0u);
}

TEST_F(ObjMaterial, LibrariesMayBeSeveralOrHaveBlanksInTheirName) {
  folder_.write("one.mtl", "newmtl a\nKd 1 0 0\n");
  folder_.write("two.mtl", "newmtl b\n");
  folder_.write("number three.mtl", "newmtl c d\nnewmtl a\nKd 0 1 0\n");
  const Scene scene = load_valid(
      folder_.write("m.obj", model("mtllib one.mtl two.mtl\nmtllib number three.mtl\n", {"a", "b", "c d"})));
  ASSERT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.meshes[0].parts[2].material, 2u);
  EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1, 0, 0, 1)) << "of equal names the first counts";
}

TEST_F(ObjMaterial, WithoutItsLibraryTheGeometryIsLoaded) {
  const Scene scene = load_valid(folder_.write("m.obj", model("mtllib gone.mtl\n", {"a", "b"})));
  EXPECT_TRUE(scene.materials.empty());
  ASSERT_EQ(scene.meshes[0].parts.size(), 1u);
  EXPECT_EQ(scene.meshes[0].parts[0].material, none);
}

TEST_F(ObjMaterial, WithoutItsImageTheMaterialIsLoaded) {
  const Material green = material("Kd 0 1 0\nmap_Kd gone.png\n");
  EXPECT_EQ(green.base_color_texture.image, none);
  EXPECT_EQ(green.base_color, glm::vec4(0, 1, 0, 1));
  EXPECT_EQ(material("map_Kd\n").base_color_texture.image, none);
}

TEST_F(ObjMaterial, ADamagedImageIsAnError) {
  folder_.write("text.png", "no image");
  folder_.write("m.mtl", "newmtl a\nmap_Kd text.png\n");
  EXPECT_THROW(load_obj(folder_.write("m.obj", model("mtllib m.mtl\n", {"a"}))), Error);
}

TEST_F(ObjMaterial, WhatIsNotDrawnIsWarnedOfOnce) {
  testing::internal::CaptureStderr();
  material("d 0.5\nd 0.25\nTr 1\nmap_d leaf.png\nmap_d leaf.png\n");
  const std::string warnings = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(warnings.begin(), warnings.end(), '\n'), 2) << warnings;
  EXPECT_NE(warnings.find("line 2: material only is transparent"), std::string::npos) << warnings;
  EXPECT_NE(warnings.find("line 5: map_d is not used"), std::string::npos) << warnings;
  testing::internal::CaptureStderr();
  material("d 1\nTr 0\nd -halo 1\n");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ObjMaterial, WarningsAreFewHoweverMuchIsMissing) {
  std::string libraries;
  for (int i = 0; i < 1000; ++i) libraries += "mtllib gone" + std::to_string(i) + ".mtl\n";
  testing::internal::CaptureStderr();
  load_valid(folder_.write("m.obj", model(libraries, {"a"})));
  const std::string warnings = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(warnings.begin(), warnings.end(), '\n'), 11) << warnings;
}

TEST_F(ObjMaterial, LibrariesOutsideTheFolderAreNotRead) {
  const std::filesystem::path outside = folder_.write("outside.mtl", "newmtl a\n");
  folder_.write("inside/real.mtl", "newmtl a\n");
  std::filesystem::create_symlink(outside, folder_.path() / "inside/link.mtl");
  const auto materials_of = [&](const std::string& name) {
    return load_valid(folder_.write("inside/m.obj", model("mtllib " + name + "\n", {"a"}))).materials.size();
  };
  EXPECT_EQ(materials_of("real.mtl"), 1u);
  EXPECT_EQ(materials_of("../outside.mtl"), 0u);
  EXPECT_EQ(materials_of(outside.string()), 0u);
  EXPECT_EQ(materials_of("link.mtl"), 0u);
}

TEST_F(ObjMaterial, ImagesOutsideTheFolderAreNotRead) {
  const std::filesystem::path outside = write_image("outside.png", 1);
  write_image("inside/real.png", 1);
  std::filesystem::create_symlink(outside, folder_.path() / "inside/link.png");
  const auto images_of = [&](const std::string& name) {
    folder_.write("inside/m.mtl", "newmtl a\nmap_Kd " + name + "\n");
    return load_valid(folder_.write("inside/m.obj", model("mtllib m.mtl\n", {"a"}))).images.size();
  };
  EXPECT_EQ(images_of("real.png"), 1u);
  EXPECT_EQ(images_of("../outside.png"), 0u);
  EXPECT_EQ(images_of(outside.string()), 0u);
  EXPECT_EQ(images_of("link.png"), 0u);
}

TEST_F(ObjMaterial, MalformedNumbersNameTheLibraryAndItsLine) {
  const std::filesystem::path obj = folder_.write("m.obj", model("mtllib m.mtl\n", {"a"}));
  for (const std::string broken :
       {"Kd 1 0", "Kd 1 x 0", "Ke nan 0 0", "Ns", "Pr inf", "Pc", "Pcr x", "Ni x", "Tf 1 1", "illum x",
        "map_Kd -s x 1 1 t.png", "map_Kd -s 1 3e38 -o 0 3e38 t.png"}) {
    const std::filesystem::path library = folder_.write("m.mtl", "newmtl a\n\n" + broken + "\n");
    try {
      load_obj(obj);
      ADD_FAILURE() << broken << " was loaded";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      EXPECT_TRUE(std::string(error.what()).starts_with(library.string() + ": line 3: ")) << error.what();
    }
  }
}

}  // namespace
}  // namespace lodestone::scene::test
