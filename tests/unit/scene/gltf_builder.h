// SPDX-License-Identifier: MIT
// Small glTF files made by the tests, in a folder that vanishes with the builder.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/scene/scene.h"

namespace lodestone::scene {

using nlohmann::json;

// A fresh folder, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& bytes) const;

 private:
  std::filesystem::path path_;
};

enum Component : int { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

// A glTF file in the making: `root` is free to be edited; the functions append to it and return indices.
class GltfBuilder {
 public:
  json root = {{"asset", {{"version", "2.0"}}}};
  std::string binary;  // buffer 0

  int append(const char* section, json thing);
  template <class T>
  int view(const std::vector<T>& values, json extra = json::object()) {
    return view_bytes({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)},
                      std::move(extra));
  }
  int view_bytes(const std::string& bytes, json extra = json::object());
  // `values` are all components one after another; the count follows from `type` (SCALAR, VEC3, ...).
  template <class T>
  int accessor(const std::vector<T>& values, const char* type, int component, json extra = json::object()) {
    json a = {{"bufferView", view(values)},
              {"componentType", component},
              {"count", values.size() / components_of(type)},
              {"type", type}};
    a.update(extra);
    return append("accessors", a);
  }
  int floats(const std::vector<float>& values, const char* type) { return accessor(values, type, f32); }
  int indices(const std::vector<uint16_t>& values) { return accessor(values, "SCALAR", u16); }

  // A mesh of one primitive with the triangle (0,0,0) (1,0,0) (0,1,0) and a node that draws it; returns the
  // mesh.
  int triangle_mesh();
  // Gives every primitive of the mesh the normal (0, 0, 1); without one it would have facets.
  void give_normals(int mesh);
  json& primitive(int mesh, int index = 0) {
    return root["meshes"].at(size_t(mesh)).at("primitives").at(size_t(index));
  }

  std::string glb() const;            // buffer 0 in the binary chunk
  std::string gltf_embedded() const;  // buffer 0 as a data URI
  // Writes a GLB and loads it; validates.
  Scene load() const;
  const TemporaryFolder& folder() const { return folder_; }

  static size_t components_of(const std::string& type);

 private:
  json with_buffer() const;
  TemporaryFolder folder_;
};

std::string base64(const std::string& bytes);
std::string make_glb(const std::string& json_text, const std::string& binary);
// A PNG of width x height texels with the given channels, 8 bits each.
std::string make_png(uint32_t width, uint32_t height, int channels, const std::vector<uint8_t>& samples);

// load_gltf and validate.
Scene load_checked(const std::filesystem::path& path);
// The message of the Error(bad_input) that loading must give; fails the test where there is none.
std::string expect_bad_input(const std::filesystem::path& path);

}  // namespace lodestone::scene
