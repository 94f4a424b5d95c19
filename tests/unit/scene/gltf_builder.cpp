// SPDX-License-Identifier: MIT
#include "gltf_builder.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>

#include "lodestone/base/file.h"
#include "lodestone/scene/load.h"

namespace lodestone::scene {
namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  static std::atomic<int> serial{0};
  path_ = fs::temp_directory_path() / fmt::format("lodestone-gltf-{}-{}", ::getpid(), serial++);
  fs::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

fs::path TemporaryFolder::write(const std::string& name, const std::string& bytes) const {
  write_file(path_ / name, bytes);
  return path_ / name;
}

size_t GltfBuilder::components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "MAT4") return 16;
  return size_t(type.back() - '0');
}

int GltfBuilder::append(const char* section, json thing) {
  root[section].push_back(std::move(thing));
  return int(root[section].size()) - 1;
}

int GltfBuilder::view_bytes(const std::string& bytes, json extra) {
  binary.resize((binary.size() + 3) / 4 * 4);
  json v = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  v.update(extra);
  binary += bytes;
  return append("bufferViews", v);
}

int GltfBuilder::triangle_mesh() {
  const int positions = floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int mesh = append("meshes", {{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
  append("nodes", {{"mesh", mesh}});
  return mesh;
}

void GltfBuilder::give_normals(int mesh) {
  for (json& primitive : root["meshes"].at(size_t(mesh)).at("primitives")) {
    const size_t positions = primitive["attributes"]["POSITION"];
    const size_t count = root["accessors"].at(positions)["count"];
    std::vector<float> normals(3 * count, 0.0f);
    for (size_t i = 0; i < count; ++i) normals[3 * i + 2] = 1;
    primitive["attributes"]["NORMAL"] = floats(normals, "VEC3");
  }
}

json GltfBuilder::with_buffer() const {
  json j = root;
  if (!binary.empty() && !j.contains("buffers")) j["buffers"] = {{{"byteLength", binary.size()}}};
  return j;
}

std::string GltfBuilder::glb() const {
  return make_glb(with_buffer().dump(), binary);
}

std::string GltfBuilder::gltf_embedded() const {
  json j = with_buffer();
  j["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(binary);
  return j.dump();
}

Scene GltfBuilder::load() const {
  return load_checked(folder_.write("scene.glb", glb()));
}

std::string base64(const std::string& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string make_glb(const std::string& json_text, const std::string& binary) {
  const auto word = [](size_t value) {
    const uint32_t bits = uint32_t(value);
    return std::string(reinterpret_cast<const char*>(&bits), sizeof bits);
  };
  const auto padded = [](std::string text, char fill) {
    text.resize((text.size() + 3) / 4 * 4, fill);
    return text;
  };
  const std::string j = padded(json_text, ' '), b = padded(binary, '\0');
  std::string chunks = word(j.size()) + "JSON" + j;
  if (!b.empty()) chunks += word(b.size()) + std::string("BIN\0", 4) + b;
  return "glTF" + word(2) + word(chunks.size() + 12) + chunks;
}

std::string make_png(uint32_t width, uint32_t height, int channels, const std::vector<uint8_t>& samples) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "image.png";
  OIIO::ImageSpec spec(int(width), int(height), channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(path.string());
  EXPECT_TRUE(out && out->open(path.string(), spec) &&
              out->write_image(OIIO::TypeDesc::UINT8, samples.data()) && out->close());
  const std::vector<std::byte> bytes = read_file(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Scene load_checked(const fs::path& path) {
  Scene scene = load_gltf(path);
  validate(scene);
  return scene;
}

std::string expect_bad_input(const fs::path& path) {
  try {
    load_checked(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input) << error.what();
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(message.size(), 1000u) << message;
    return message;
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an Error: " << error.what();
    return {};
  }
  ADD_FAILURE() << "loaded " << path;
  return {};
}

}  // namespace lodestone::scene
