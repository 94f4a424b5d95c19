// SPDX-License-Identifier: MIT
// glTF 2.0, https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html; section numbers in the gltf_*.cpp
// files are of that text.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/gltf_container.h"
#include "lodestone/scene/gltf_convert.h"
#include "lodestone/scene/gltf_outline.h"
#include "lodestone/scene/gltf_parse.h"
#include "lodestone/scene/load.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

constexpr std::array<std::string_view, 10> known_extensions = {
    "EXT_mesh_gpu_instancing",    "KHR_lights_punctual",
    "KHR_materials_clearcoat",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_volume",
    "KHR_mesh_quantization",      "KHR_texture_transform"};

bool is_known(const std::string& extension) {
  return std::find(known_extensions.begin(), known_extensions.end(), extension) != known_extensions.end();
}

const char* remedy(const std::string& extension) {
  if (extension == "KHR_draco_mesh_compression") return "export it without Draco compression";
  if (extension == "EXT_meshopt_compression") return "export it without meshopt compression";
  if (extension == "KHR_texture_basisu" || extension == "EXT_texture_webp")
    return "export its textures as PNG or JPEG";
  return "export it without this extension";
}

void check_extensions(const std::string& file, const GltfOutline& outline) {
  for (const std::string& extension : outline.extensions_required) {
    if (is_known(extension)) continue;
    fail_input(file, "requires the extension {}, which is not read; {}", shown(extension), remedy(extension));
  }
  for (const std::string& extension : outline.extensions_used) {
    if (is_known(extension)) continue;
    log::warn_once("gltf extension " + extension,
                   fmt::format("{}: uses the extension {}, which is ignored", file, shown(extension)));
  }
}

}  // namespace

std::string gltf_label(const char* kind, size_t index, const std::string& name) {
  return name.empty() ? fmt::format("{} {}", kind, index)
                      : fmt::format("{} {} '{}'", kind, index, shown(name));
}

uint32_t gltf_index(const AccessorReader& reader, int index, size_t size, const std::string& use) {
  if (index < 0) return none;
  if (size_t(index) >= size) {
    fail_input(reader.file(), "{} {} does not exist (there are {}); export it again", use, index, size);
  }
  return uint32_t(index);
}

float gltf_float(const AccessorReader& reader, double value, const std::string& use) {
  const float number = float(value);
  if (!std::isfinite(number))
    fail_input(reader.file(), "{}: {} is no finite float; export it again", use, value);
  return number;
}

std::vector<float> gltf_floats(const AccessorReader& reader, const std::vector<double>& values,
                               const std::string& use) {
  std::vector<float> floats;
  for (double value : values) floats.push_back(gltf_float(reader, value, use));
  return floats;
}

const tinygltf::Value* gltf_member(const tinygltf::Value& object, const char* name) {
  return object.Has(name) ? &object.Get(name) : nullptr;
}

Scene load_gltf(const std::filesystem::path& path) {
  const GltfContainer gltf = open_gltf(path);
  const GltfOutline outline = outline_gltf(gltf);
  check_extensions(gltf.file, outline);
  ParsedGltf parsed = parse_gltf(gltf, outline);
  const AccessorReader reader(parsed.model, gltf.file, parsed.viewless);

  Scene scene;
  scene.name = gltf.file;
  scene.images = std::move(parsed.images);
  scene.materials = convert_materials(reader, parsed.image_of);
  for (size_t i = 0; i < parsed.model.meshes.size(); ++i) scene.meshes.push_back(convert_mesh(reader, i));
  scene.cameras = convert_cameras(reader);
  scene.lights = convert_lights(reader);
  const std::vector<uint32_t> node_of = convert_nodes(reader, scene);
  convert_animations(reader, node_of, scene);
  validate(scene);
  return scene;
}

}  // namespace lodestone::scene
