// SPDX-License-Identifier: MIT
#include "lodestone/render/material_tables.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "lodestone/layout/frame.h"
#include "lodestone/render/scene_tables.h"

namespace lodestone::render {
namespace {

using glm::vec3;
using glm::vec4;

float dielectric_ior(const scene::Material& material) {
  return material.ior == 0 ? layout::highest_ior : std::min(material.ior, layout::highest_ior);
}

// Of a surface seen straight on; 0.04f for 1.5.
float reflectance(float ior) {
  if (ior == layout::highest_ior) return 1;
  const double root = (double(ior) - 1) / (double(ior) + 1);
  return static_cast<float>(root * root);
}

// Per unit of length. Finite, and black is a colour of which nothing is seen.
vec3 attenuation(const scene::Material& material) {
  if (material.attenuation_distance == 0) return vec3(0);
  constexpr double darkest = 1e-6, most = 1e30;
  vec3 result;
  for (int i = 0; i < 3; ++i) {
    const double depth = std::log(1 / std::max(double(material.attenuation_color[i]), darkest));
    result[i] = static_cast<float>(std::min(depth / double(material.attenuation_distance), most));
  }
  return result;
}

// Whether it is more than a plain Surface (layout/surface.h).
bool is_layered(const layout::MaterialRecord& material) {
  return material.ior != 1.5f || material.specular != 1 || material.specular_color != vec3(1) ||
         material.specular_texture != layout::no_index ||
         material.specular_color_texture != layout::no_index || material.transmission > 0 ||
         material.clearcoat > 0;
}

std::vector<layout::MaterialRecord> material_records(const scene::Scene& scene,
                                                     std::vector<layout::TextureRecord>& textures,
                                                     const std::vector<uint32_t>& image_offsets) {
  const auto add_texture = [&](const scene::Texture& texture) -> uint32_t {
    if (texture.image == scene::none) return layout::no_index;
    const scene::Image& image = scene.images[texture.image];
    layout::TextureRecord record{};
    record.first_texel = image_offsets[texture.image];
    record.width = image.width;
    record.height = image.height;
    record.texcoord = texture.texcoord;
    record.wrap_u = static_cast<uint32_t>(texture.wrap_u);
    record.wrap_v = static_cast<uint32_t>(texture.wrap_v);
    record.nearest = texture.nearest ? 1 : 0;
    record.u_row = texture.u_row;
    record.v_row = texture.v_row;
    textures.push_back(record);
    return static_cast<uint32_t>(textures.size() - 1);
  };
  const auto record_of = [&](const scene::Material& material) {
    layout::MaterialRecord record{};
    record.base_color = material.base_color;
    record.emissive = material.emissive;
    record.metallic = material.metallic;
    record.roughness = material.roughness;
    record.normal_scale = material.normal_scale;
    record.occlusion_strength = material.occlusion_strength;
    record.alpha_cutoff = material.alpha_cutoff;
    record.alpha_mask = material.alpha_mask ? 1 : 0;
    record.base_color_texture = add_texture(material.base_color_texture);
    record.metallic_roughness_texture = add_texture(material.metallic_roughness_texture);
    record.normal_texture = add_texture(material.normal_texture);
    record.occlusion_texture = add_texture(material.occlusion_texture);
    record.emissive_texture = add_texture(material.emissive_texture);
    record.ior = dielectric_ior(material);
    record.f0 = reflectance(record.ior);
    record.specular_color = material.specular_color;
    record.specular = material.specular;
    record.attenuation = attenuation(material);
    record.transmission = material.transmission;
    record.clearcoat = material.clearcoat;
    record.clearcoat_roughness = material.clearcoat_roughness;
    record.clearcoat_normal_scale = material.clearcoat_normal_scale;
    record.solid = material.thickness > 0 ? 1 : 0;
    record.specular_texture = add_texture(material.specular_texture);
    record.specular_color_texture = add_texture(material.specular_color_texture);
    record.transmission_texture = add_texture(material.transmission_texture);
    record.clearcoat_texture = add_texture(material.clearcoat_texture);
    record.clearcoat_roughness_texture = add_texture(material.clearcoat_roughness_texture);
    record.clearcoat_normal_texture = add_texture(material.clearcoat_normal_texture);
    return record;
  };
  std::vector<layout::MaterialRecord> records;
  for (const scene::Material& material : scene.materials) records.push_back(record_of(material));
  // Parts without a material are of this one.
  scene::Material grey;
  grey.base_color = vec4(0.55f, 0.55f, 0.55f, 1);
  grey.metallic = 0;
  grey.roughness = 0.6f;
  records.push_back(record_of(grey));
  return records;
}

}  // namespace

float srgb_level(uint32_t value) {
  const double x = value / 255.0;
  return static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
}

MaterialTables::MaterialTables(Backend& backend, const scene::Scene& scene, const scene::Assembly& assembly) {
  std::vector<uint32_t> texels, offsets;
  for (uint32_t i = 0; i < layout::srgb_levels; ++i) texels.push_back(std::bit_cast<uint32_t>(srgb_level(i)));
  for (const scene::Image& image : scene.images) {
    offsets.push_back(static_cast<uint32_t>(texels.size()));
    for (size_t i = 0; i + 4 <= image.rgba.size(); i += 4) {
      texels.push_back(uint32_t(image.rgba[i]) | uint32_t(image.rgba[i + 1]) << 8 |
                       uint32_t(image.rgba[i + 2]) << 16 | uint32_t(image.rgba[i + 3]) << 24);
    }
  }
  images = make_buffer(backend, "images", 4, texels);

  std::vector<layout::TextureRecord> texture_records;
  const auto records = material_records(scene, texture_records, offsets);
  const auto grey = static_cast<uint32_t>(records.size() - 1);
  std::vector<layout::PartRecord> part_records;
  for (const scene::AssemblyPart& part : assembly.parts) {
    part_records.push_back({part.material == scene::none ? grey : part.material, part.mesh,
                            part.first_triangle, part.first_mesh_triangle});
    const layout::MaterialRecord& material = records[part_records.back().material];
    has_masks = has_masks || material.alpha_mask != 0;
    if (is_layered(material)) layered = 1;
  }
  materials = make_buffer(backend, "materials", sizeof(layout::MaterialRecord), records);
  textures = make_buffer(backend, "textures", sizeof(layout::TextureRecord), texture_records);
  parts = make_buffer(backend, "parts", sizeof(layout::PartRecord), part_records);
}

}  // namespace lodestone::render
