// SPDX-License-Identifier: MIT
// Materials, textures and samplers (3.8, 3.9), KHR_texture_transform, and of KHR_materials_*
// emissive_strength, ior, specular, transmission, volume (without its texture) and clearcoat.
#include <algorithm>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/gltf_convert.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

class MaterialConverter {
 public:
  MaterialConverter(const AccessorReader& reader, const std::vector<uint32_t>& image_of)
      : reader_(reader), model_(reader.model()), image_of_(image_of) {}

  Material convert(size_t index) {
    const tinygltf::Material& from = model_.materials[index];
    label_ = gltf_label("material", index, from.name);
    Material to;
    to.name = from.name;
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    const std::vector<float> base = gltf_floats(reader_, pbr.baseColorFactor, label_ + ", baseColorFactor");
    to.base_color = glm::clamp(glm::vec4(base.at(0), base.at(1), base.at(2), base.at(3)), 0.0f, 1.0f);
    to.metallic = unit(pbr.metallicFactor, "metallicFactor");
    to.roughness = unit(pbr.roughnessFactor, "roughnessFactor");
    const std::vector<float> emissive =
        gltf_floats(reader_, from.emissiveFactor, label_ + ", emissiveFactor");
    to.emissive = glm::vec3(emissive.at(0), emissive.at(1), emissive.at(2)) * emissive_strength(from);
    to.normal_scale = gltf_float(reader_, from.normalTexture.scale, label_ + ", normalTexture");
    to.occlusion_strength = unit(from.occlusionTexture.strength, "occlusionTexture");
    to.double_sided = from.doubleSided;
    set_alpha(from, to);
    to.base_color_texture = texture(pbr.baseColorTexture, "baseColorTexture");
    to.metallic_roughness_texture = texture(pbr.metallicRoughnessTexture, "metallicRoughnessTexture");
    to.normal_texture = texture(from.normalTexture, "normalTexture");
    to.occlusion_texture = texture(from.occlusionTexture, "occlusionTexture");
    to.emissive_texture = texture(from.emissiveTexture, "emissiveTexture");
    set_specular(from, to);
    set_transmission(from, to);
    set_clearcoat(from, to);
    return to;
  }

 private:
  float unit(double value, const char* name) const {
    return std::clamp(gltf_float(reader_, value, label_ + ", " + name), 0.0f, 1.0f);
  }

  float number(const tinygltf::Value& value, const std::string& use) const {
    if (!value.IsNumber()) fail_input(reader_.file(), "{}: must be a number; export it again", use);
    return gltf_float(reader_, value.GetNumberAsDouble(), use);
  }

  // Not below `least`; `absent` where `extension` does not have it.
  float factor(const tinygltf::Value& extension, const char* name, float absent, float least = 0) const {
    const tinygltf::Value* value = gltf_member(extension, name);
    return value == nullptr ? absent : std::max(number(*value, label_ + ", " + name), least);
  }
  float unit_factor(const tinygltf::Value& extension, const char* name, float absent) const {
    return std::min(factor(extension, name, absent), 1.0f);
  }

  // White where it is absent.
  glm::vec3 color_factor(const tinygltf::Value& extension, const char* name) const {
    const tinygltf::Value* value = gltf_member(extension, name);
    if (value == nullptr) return glm::vec3(1);
    const std::string use = label_ + ", " + name;
    if (!value->IsArray() || value->ArrayLen() != 3) {
      fail_input(reader_.file(), "{}: must be three numbers; export it again", use);
    }
    return glm::max(
        glm::vec3(number(value->Get(0), use), number(value->Get(1), use), number(value->Get(2), use)), 0.0f);
  }

  glm::vec2 pair(const tinygltf::Value& value, const std::string& use) const {
    if (!value.IsArray() || value.ArrayLen() != 2) {
      fail_input(reader_.file(), "{}: must be two numbers; export it again", use);
    }
    return {number(value.Get(0), use), number(value.Get(1), use)};
  }

  // Null where the material does not have it.
  const tinygltf::Value* extension(const tinygltf::Material& from, const char* name) const {
    const auto found = from.extensions.find(name);
    return found == from.extensions.end() ? nullptr : &found->second;
  }

  float emissive_strength(const tinygltf::Material& from) const {
    const tinygltf::Value* values = extension(from, "KHR_materials_emissive_strength");
    const tinygltf::Value* strength = values == nullptr ? nullptr : gltf_member(*values, "emissiveStrength");
    return strength == nullptr ? 1 : number(*strength, label_ + ", emissiveStrength");
  }

  void set_specular(const tinygltf::Material& from, Material& to) const {
    if (const tinygltf::Value* values = extension(from, "KHR_materials_ior")) {
      const float ior = factor(*values, "ior", to.ior);
      to.ior = ior == 0 ? 0 : std::max(ior, 1.0f);
    }
    if (const tinygltf::Value* values = extension(from, "KHR_materials_specular")) {
      to.specular = unit_factor(*values, "specularFactor", 1);
      to.specular_color = color_factor(*values, "specularColorFactor");
      to.specular_texture = extension_texture(*values, "specularTexture");
      to.specular_color_texture = extension_texture(*values, "specularColorTexture");
    }
  }

  void set_transmission(const tinygltf::Material& from, Material& to) const {
    if (const tinygltf::Value* values = extension(from, "KHR_materials_transmission")) {
      to.transmission = unit_factor(*values, "transmissionFactor", 0);
      to.transmission_texture = extension_texture(*values, "transmissionTexture");
    }
    const tinygltf::Value* values = extension(from, "KHR_materials_volume");
    if (values == nullptr) return;
    to.thickness = factor(*values, "thicknessFactor", 0);
    to.attenuation_color = glm::min(color_factor(*values, "attenuationColor"), 1.0f);
    to.attenuation_distance = factor(*values, "attenuationDistance", 0);
    if (gltf_member(*values, "thicknessTexture") != nullptr) {
      log::warn_once(reader_.file() + " thickness texture",
                     fmt::format("{}: {}: a thickness texture is ignored; rays find how thick the mesh is",
                                 reader_.file(), label_));
    }
  }

  void set_clearcoat(const tinygltf::Material& from, Material& to) const {
    const tinygltf::Value* values = extension(from, "KHR_materials_clearcoat");
    if (values == nullptr) return;
    to.clearcoat = unit_factor(*values, "clearcoatFactor", 0);
    to.clearcoat_roughness = unit_factor(*values, "clearcoatRoughnessFactor", 0);
    to.clearcoat_texture = extension_texture(*values, "clearcoatTexture");
    to.clearcoat_roughness_texture = extension_texture(*values, "clearcoatRoughnessTexture");
    to.clearcoat_normal_texture = extension_texture(*values, "clearcoatNormalTexture");
    const tinygltf::Value* normal = gltf_member(*values, "clearcoatNormalTexture");
    const tinygltf::Value* scale = normal == nullptr ? nullptr : gltf_member(*normal, "scale");
    if (scale != nullptr) to.clearcoat_normal_scale = number(*scale, label_ + ", clearcoatNormalTexture");
  }

  void set_alpha(const tinygltf::Material& from, Material& to) const {
    if (from.alphaMode == "OPAQUE") return;
    to.alpha_mask = true;
    if (from.alphaMode == "MASK") {
      to.alpha_cutoff = gltf_float(reader_, from.alphaCutoff, label_ + ", alphaCutoff");
    } else if (from.alphaMode == "BLEND") {
      to.alpha_cutoff = 0.5f;
      log::warn_once(
          reader_.file() + " alpha blending",
          fmt::format(
              "{}: {}: blended transparency is drawn as cut out at alpha 0.5, in all materials that have it; "
              "what is fainter is not seen",
              reader_.file(), label_));
    } else {
      fail_input(reader_.file(), "{}: alphaMode '{}' does not exist; export it again", label_,
                 printable(from.alphaMode));
    }
  }

  Texture::Wrap wrap(int mode) const {
    switch (mode) {
      case TINYGLTF_TEXTURE_WRAP_REPEAT:
        return Texture::Wrap::repeat;
      case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return Texture::Wrap::clamp;
      case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return Texture::Wrap::mirror;
      default:
        fail_input(reader_.file(), "{}: wrapping mode {} does not exist; export it again", label_, mode);
    }
  }

  // `Info` is one of tinygltf's three kinds of texture info.
  template <class Info>
  Texture texture(const Info& info, const char* name) const {
    const std::string use = label_ + ", " + name;
    Texture to;
    const uint32_t index = gltf_index(reader_, info.index, model_.textures.size(), use + ", texture");
    if (index == none) return to;
    const tinygltf::Texture& from = model_.textures[index];
    const uint32_t source = gltf_index(reader_, from.source, image_of_.size(), use + ", image");
    if (source == none) {
      log::warn_once(
          reader_.file() + " texture without image",
          fmt::format("{}: {}: a texture without an image that can be read is ignored", reader_.file(), use));
      return to;
    }
    int texcoord = info.texCoord;
    const auto transform = info.extensions.find("KHR_texture_transform");
    if (transform != info.extensions.end()) set_transform(transform->second, use, to, texcoord);
    if (texcoord < 0 || texcoord > 1) {
      log::warn_once(reader_.file() + " texture coordinates",
                     fmt::format("{}: {}: only TEXCOORD_0 and TEXCOORD_1 are read; the texture is ignored",
                                 reader_.file(), use));
      return {};
    }
    to.texcoord = uint32_t(texcoord);
    to.image = image_of_[source];
    const uint32_t sampler = gltf_index(reader_, from.sampler, model_.samplers.size(), use + ", sampler");
    if (sampler == none) return to;
    to.wrap_u = wrap(model_.samplers[sampler].wrapS);
    to.wrap_v = wrap(model_.samplers[sampler].wrapT);
    to.nearest = model_.samplers[sampler].magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    return to;
  }

  // Of an extension; tinygltf leaves those as it found them.
  Texture extension_texture(const tinygltf::Value& extension, const char* name) const {
    const tinygltf::Value* value = gltf_member(extension, name);
    if (value == nullptr) return {};
    const tinygltf::Value* index = gltf_member(*value, "index");
    const tinygltf::Value* set = gltf_member(*value, "texCoord");
    if (index == nullptr || !index->IsInt() || (set != nullptr && !set->IsInt())) {
      fail_input(reader_.file(), "{}, {}: must be an object with the index of a texture; export it again",
                 label_, name);
    }
    tinygltf::TextureInfo info;
    info.index = index->Get<int>();
    if (set != nullptr) info.texCoord = set->Get<int>();
    if (const tinygltf::Value* more = gltf_member(*value, "extensions")) {
      for (const std::string& key : more->Keys()) info.extensions.emplace(key, more->Get(key));
    }
    return texture(info, name);
  }

  // Translation x rotation x scale. A positive angle turns counter-clockwise as seen with v pointing down;
  // the GLSL in the extension's text turns the other way, its sample model and the reference viewer this one
  // (KhronosGroup/glTF issue 1563).
  void set_transform(const tinygltf::Value& extension, const std::string& use, Texture& to,
                     int& texcoord) const {
    glm::vec2 offset(0), scale(1);
    float rotation = 0;
    if (const tinygltf::Value* v = gltf_member(extension, "offset")) offset = pair(*v, use + ", offset");
    if (const tinygltf::Value* v = gltf_member(extension, "scale")) scale = pair(*v, use + ", scale");
    if (const tinygltf::Value* v = gltf_member(extension, "rotation"))
      rotation = number(*v, use + ", rotation");
    if (const tinygltf::Value* v = gltf_member(extension, "texCoord")) {
      if (!v->IsInt()) fail_input(reader_.file(), "{}: texCoord must be an integer; export it again", use);
      texcoord = v->Get<int>();
    }
    const float c = std::cos(rotation), s = std::sin(rotation);
    to.u_row = {c * scale.x, s * scale.y, offset.x};
    to.v_row = {-s * scale.x, c * scale.y, offset.y};
  }

  const AccessorReader& reader_;
  const tinygltf::Model& model_;
  const std::vector<uint32_t>& image_of_;
  std::string label_;
};

}  // namespace

std::vector<Material> convert_materials(const AccessorReader& reader, const std::vector<uint32_t>& image_of) {
  MaterialConverter converter(reader, image_of);
  std::vector<Material> materials;
  for (size_t i = 0; i < reader.model().materials.size(); ++i) materials.push_back(converter.convert(i));
  return materials;
}

}  // namespace lodestone::scene
