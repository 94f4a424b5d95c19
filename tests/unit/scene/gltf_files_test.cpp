// SPDX-License-Identifier: MIT
// Where buffers and images come from, and which extensions a file may ask for.
#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace lodestone::scene {
namespace {

namespace fs = std::filesystem;

GltfBuilder& with_triangle(GltfBuilder& gltf) {
  gltf.triangle_mesh();
  return gltf;
}

std::string external(const GltfBuilder& gltf, const std::string& uri) {
  json j = gltf.root;
  j["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", uri}}};
  return j.dump();
}

TEST(GltfFiles, BufferMayBeAChunkADataUriOrAFile) {
  GltfBuilder gltf;
  with_triangle(gltf);
  const TemporaryFolder& folder = gltf.folder();
  folder.write("a b+c.bin", gltf.binary);
  folder.write("sub/data.bin", gltf.binary + "longer than declared");
  const std::vector<fs::path> files = {
      folder.write("chunk.glb", gltf.glb()),
      folder.write("data.gltf", gltf.gltf_embedded()),
      folder.write("space.gltf", external(gltf, "a%20b%2Bc.bin")),
      folder.write("sub.gltf", external(gltf, "sub/data.bin")),
      folder.write("named-otherwise.glb", gltf.gltf_embedded()),
      folder.write("external.glb", make_glb(external(gltf, "./sub/data.bin"), ""))};
  for (const fs::path& file : files) {
    EXPECT_EQ(load_checked(file).meshes.at(0).positions.at(1), glm::vec3(1, 0, 0)) << file;
  }
}

TEST(GltfFiles, APlusSignInAFileNameIsItself) {
  GltfBuilder gltf;
  with_triangle(gltf);
  gltf.folder().write("a+b.bin", gltf.binary);
  EXPECT_EQ(load_checked(gltf.folder().write("s.gltf", external(gltf, "a+b.bin"))).meshes.size(), 1u);
}

TEST(GltfFiles, NamesMayHoldBlanksPlusAndPercentSigns) {
  GltfBuilder gltf;
  with_triangle(gltf);
  for (const char* name : {"a b+c.bin", "100%.bin", "50%25.bin", "é+ ü.bin"})
    gltf.folder().write(name, gltf.binary);
  for (const char* uri : {"a b+c.bin", "a%20b+c.bin", "a%20b%2bc.bin", "100%.bin", "100%25.bin",
                          "50%2525.bin", "%C3%A9+ %C3%BC.bin"}) {
    EXPECT_EQ(load_checked(gltf.folder().write("s.gltf", external(gltf, uri))).meshes.size(), 1u) << uri;
  }
}

TEST(GltfFiles, DataUrisMayBeLongerThanTheirBufferAndOfAnyType) {
  GltfBuilder gltf;
  with_triangle(gltf);
  const std::string content = base64(gltf.binary + "xy");
  for (const std::string_view head :
       {"data:application/octet-stream;base64,", "data:;base64,", "DATA:model/x;charset=utf-8;BASE64,"}) {
    EXPECT_EQ(load_checked(gltf.folder().write("s.gltf", external(gltf, std::string(head) + content)))
                  .meshes.size(),
              1u);
    const std::string message = expect_bad_input(gltf.folder().write(
        "s.gltf", external(gltf, std::string(head) + content.substr(0, content.size() / 8 * 4))));
    EXPECT_NE(message.find("cut short"), std::string::npos) << message;
  }
  for (const char* broken :
       {"data:", "data:application/octet-stream;base64", "data:;base64,A!AA", "data:;base64,A"}) {
    const std::string message = expect_bad_input(gltf.folder().write("s.gltf", external(gltf, broken)));
    EXPECT_NE(message.find("buffers[0]: its data URI is malformed"), std::string::npos) << message;
  }
  EXPECT_EQ(
      load_checked(gltf.folder().write("s.glb", make_glb(external(gltf, "data:;base64," + content), "")))
          .meshes.size(),
      1u);
}

TEST(GltfFiles, ImagesMayBeFilesOrDataUris) {
  GltfBuilder gltf;
  const std::string png = make_png(2, 1, 3, {1, 2, 3, 4, 5, 6});
  gltf.folder().write("two texels.png", png);
  gltf.append("images", {{"uri", "two%20texels.png"}});
  gltf.append("images", {{"uri", "data:image/png;base64," + base64(png)}});
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.images.size(), 2u);
  for (const Image& image : scene.images) {
    EXPECT_EQ(image.width, 2u);
    EXPECT_EQ(image.rgba, (std::vector<uint8_t>{1, 2, 3, 255, 4, 5, 6, 255}));
  }
}

TEST(GltfFiles, MissingOrBrokenImageIsAnError) {
  GltfBuilder gltf;
  gltf.append("images", {{"uri", "missing.png"}});
  EXPECT_NE(expect_bad_input(gltf.folder().write("s.glb", gltf.glb())).find("missing.png"),
            std::string::npos);
  gltf.folder().write("missing.png", "not a PNG");
  EXPECT_NE(expect_bad_input(gltf.folder().write("s.glb", gltf.glb())).find("missing.png"),
            std::string::npos);
  gltf.folder().write("missing.png", "");
  expect_bad_input(gltf.folder().write("s.glb", gltf.glb()));
  const std::string png = make_png(16, 16, 3, std::vector<uint8_t>(16 * 16 * 3, 77));
  gltf.folder().write("missing.png", png.substr(0, png.size() / 2));
  expect_bad_input(gltf.folder().write("s.glb", gltf.glb()));
  gltf.folder().write("missing.png", png);
  EXPECT_EQ(load_checked(gltf.folder().write("s.glb", gltf.glb())).images.size(), 1u);
}

TEST(GltfFiles, NothingOutsideTheFolderIsOpened) {
  const TemporaryFolder outside;
  GltfBuilder gltf;
  with_triangle(gltf);
  const fs::path secret = outside.write("secret.bin", gltf.binary);
  fs::create_symlink(secret, gltf.folder().path() / "link.bin");
  fs::create_directory_symlink(outside.path(), gltf.folder().path() / "folder");
  fs::create_symlink(gltf.folder().write("inside.bin", gltf.binary), gltf.folder().path() / "good-link.bin");
  const std::string climb = "../" + outside.path().filename().string() + "/secret.bin";
  const std::string slashes = "..%5C" + outside.path().filename().string() + "%5Csecret.bin";
  for (const std::string& uri :
       {secret.string(), "file://" + secret.string(), climb, slashes, std::string("link.bin"),
        std::string("folder/secret.bin"), "x/../" + climb, std::string("http://example.com/a.bin"),
        std::string("%2e%2e/") + outside.path().filename().string() + "/secret.bin", std::string("a%00.bin"),
        std::string("."), std::string("folder"), std::string("/dev/zero"), std::string("C:/x.bin")}) {
    const std::string message = expect_bad_input(gltf.folder().write("s.gltf", external(gltf, uri)));
    EXPECT_EQ(message.find("not valid glTF"), std::string::npos) << "a reason of its own: " << message;
  }
  EXPECT_EQ(load_checked(gltf.folder().write("s.gltf", external(gltf, "good-link.bin"))).meshes.size(), 1u);
}

TEST(GltfFiles, AFileInAnotherWorkingDirectoryIsNotTried) {
  // tinygltf looks in the working directory where a file is not beside the scene.
  GltfBuilder gltf;
  with_triangle(gltf);
  const fs::path before = fs::current_path();
  const TemporaryFolder elsewhere;
  elsewhere.write("data.bin", gltf.binary);
  const fs::path scene = gltf.folder().write("s.gltf", external(gltf, "data.bin"));
  fs::current_path(elsewhere.path());
  const std::string message = expect_bad_input(scene);
  fs::current_path(before);
  EXPECT_NE(message.find("data.bin"), std::string::npos);
}

TEST(GltfFiles, RequiredExtensionsThatAreNotReadAreErrorsWithARemedy) {
  GltfBuilder gltf;
  with_triangle(gltf);
  gltf.root["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  gltf.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  // As Draco files have it: accessors without views.
  gltf.root["accessors"][0].erase("bufferView");
  gltf.primitive(0)["indices"] =
      gltf.append("accessors", {{"componentType", u16}, {"count", 3}, {"type", "SCALAR"}});
  const std::string message = expect_bad_input(gltf.folder().write("s.glb", gltf.glb()));
  EXPECT_NE(message.find("KHR_draco_mesh_compression"), std::string::npos) << message;
  EXPECT_NE(message.find("without Draco compression"), std::string::npos) << message;
}

TEST(GltfFiles, UsedExtensionsThatAreNotReadOnlyWarn) {
  GltfBuilder gltf;
  with_triangle(gltf);
  gltf.root["extensionsUsed"] = {"VENDOR_unknown"};
  testing::internal::CaptureStderr();
  EXPECT_EQ(gltf.load().meshes.size(), 1u);
  EXPECT_EQ(gltf.load().meshes.size(), 1u);
  const std::string warnings = testing::internal::GetCapturedStderr();
  const size_t first = warnings.find("VENDOR_unknown");
  EXPECT_NE(first, std::string::npos);
  EXPECT_EQ(warnings.find("VENDOR_unknown", first + 1), std::string::npos) << "once";
}

TEST(GltfFiles, ExtrasMayHoldAnything) {
  GltfBuilder gltf;
  with_triangle(gltf);
  const json anything =
      json::parse(R"({"light": "on", "mesh": -1, "count": 1e30, "children": {"nodes": [[], "x"]},
                                        "extensions": 5, "targets": [1], "big": 123456789012345})");
  gltf.root["extras"] = anything;
  gltf.root["nodes"][0]["extras"] = anything;
  gltf.root["meshes"][0]["primitives"][0]["extras"] = anything;
  EXPECT_EQ(gltf.load().meshes.size(), 1u);
}

TEST(GltfFiles, NamesWithControlCharactersStayOnTheirLine) {
  GltfBuilder gltf;
  with_triangle(gltf);
  gltf.root["nodes"][0]["name"] = "a\nlodestone: error: \x1b[31m";
  gltf.root["nodes"][0]["mesh"] = 9;
  const std::string message = expect_bad_input(gltf.folder().write("s.glb", gltf.glb()));
  EXPECT_EQ(message.find_first_of("\n\x1b"), std::string::npos) << message;
}

TEST(GltfFiles, VersionsThatNeedMoreAreErrors) {
  GltfBuilder gltf;
  with_triangle(gltf);
  gltf.root["asset"]["version"] = "2.7";
  EXPECT_EQ(gltf.load().meshes.size(), 1u);
  gltf.root["asset"]["minVersion"] = "2.6";
  EXPECT_NE(expect_bad_input(gltf.folder().write("s.glb", gltf.glb())).find("2.6"), std::string::npos);
}

TEST(GltfFiles, OlderVersionsAreErrors) {
  GltfBuilder gltf;
  gltf.root["asset"]["version"] = "1.0";
  EXPECT_NE(expect_bad_input(gltf.folder().write("s.glb", gltf.glb())).find("1.0"), std::string::npos);
}

}  // namespace
}  // namespace lodestone::scene
