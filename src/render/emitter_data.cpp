// SPDX-License-Identifier: MIT
#include "lodestone/render/emitter_data.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/layout/shading.h"
#include "lodestone/render/material_tables.h"
#include "lodestone/render/number_shares.h"

namespace lodestone::render {
namespace {

using geometry_image::Atlas;
using glm::vec2;
using glm::vec3;
using layout::ChartRecord;

// The most rows of points at which what a triangle emits is looked up.
constexpr int most_rows = 32;

struct Corner {
  uint32_t triangle = 0;  // of the assembly
  vec3 shares{0};         // of its vertices
};

class EmissionMeter {
 public:
  EmissionMeter(const scene::Scene& scene, const scene::Assembly& assembly, const Atlas& atlas)
      : scene_(scene), assembly_(assembly), atlas_(atlas), rest_(scene::rest_positions(scene, assembly)) {
    for (uint32_t i = 0; i < layout::srgb_levels; ++i) linear_[i] = srgb_level(i);
  }

  bool shines(uint32_t triangle) const { return material_of(triangle) != nullptr; }
  bool shines(const ChartRecord& chart) const;

  // Of half `half` of the quad whose corner a is the chart's texel (x, y).
  double power(const ChartRecord& chart, uint32_t x, uint32_t y, uint32_t half) const;

 private:
  // Null: it does not shine.
  const scene::Material* material_of(uint32_t triangle) const {
    const uint32_t material = assembly_.parts[assembly_.triangles[triangle].w].material;
    if (material == scene::none || scene_.materials[material].emissive == vec3(0)) return nullptr;
    return &scene_.materials[material];
  }

  Corner corner_of(uint32_t texel) const {
    const glm::uvec4& entry = atlas_.texel_map[texel];
    const auto b1 = std::bit_cast<float>(entry.y), b2 = std::bit_cast<float>(entry.z);
    return {entry.x, vec3(1 - b1 - b2, b1, b2)};
  }
  template <class Value>
  auto at(const Corner& corner, const Value& of_vertex) const {
    const glm::uvec4& triangle = assembly_.triangles[corner.triangle];
    return of_vertex(triangle.x) * corner.shares.x + of_vertex(triangle.y) * corner.shares.y +
           of_vertex(triangle.z) * corner.shares.z;
  }
  double mean_emission(const scene::Material& material, const std::array<Corner, 3>& corners) const;
  double texel_luminance(const scene::Texture& texture, vec2 uv, const vec3& factor) const;

  const scene::Scene& scene_;
  const scene::Assembly& assembly_;
  const Atlas& atlas_;
  std::vector<vec3> rest_;
  std::array<float, layout::srgb_levels> linear_{};
};

uint32_t grid_triangle(const ChartRecord& chart, uint32_t x, uint32_t y, uint32_t half) {
  return chart.first_triangle + 2 * (y * (chart.width - 1) + x) + half;
}

bool EmissionMeter::shines(const ChartRecord& chart) const {
  if (chart.kind == layout::chart_exact) return shines(chart.first_triangle);
  if (chart.kind == layout::chart_grid) {
    const uint32_t triangles = 2 * (chart.width - 1) * (chart.height - 1);
    for (uint32_t i = 0; i < triangles; ++i)
      if (shines(chart.first_triangle + i)) return true;
    return false;
  }
  for (uint32_t i = 0; i < chart.width * chart.height; ++i)
    if (shines(atlas_.texel_map[chart.first_texel + i].x)) return true;
  return false;
}

double EmissionMeter::power(const ChartRecord& chart, uint32_t x, uint32_t y, uint32_t half) const {
  const uint32_t texel = chart.first_texel + y * chart.width + x;
  const std::array<uint32_t, 3> texels =
      half == 0 ? std::array<uint32_t, 3>{texel, texel + 1, texel + chart.width}
                : std::array<uint32_t, 3>{texel + chart.width + 1, texel + chart.width, texel + 1};
  std::array<Corner, 3> places, corners;
  for (size_t i = 0; i < 3; ++i) {
    if (atlas_.texel_map[texels[i]].w == 0) return 0;  // the last quad of an exact chart
    places[i] = corners[i] = corner_of(texels[i]);
  }
  if (chart.kind == layout::chart_grid) {  // what is there is the triangle's own
    for (size_t i = 0; i < 3; ++i) {
      corners[i] = {grid_triangle(chart, x, y, half), vec3(0)};
      corners[i].shares[static_cast<glm::length_t>(i)] = 1;
    }
  }
  const auto position = [&](const Corner& corner) {
    return glm::dvec3(at(corner, [&](uint32_t vertex) { return rest_[vertex]; }));
  };
  const glm::dvec3 a = position(places[0]);
  const double area = glm::length(glm::cross(position(places[1]) - a, position(places[2]) - a)) / 2;
  // Where corners are of different parts, the brightest counts for all.
  double emission = 0;
  std::array<const scene::Material*, 3> materials{};
  for (size_t i = 0; i < 3; ++i) {
    materials[i] = material_of(corners[i].triangle);
    if (materials[i] == nullptr || std::find(materials.begin(), materials.begin() + i, materials[i]) !=
                                       materials.begin() + static_cast<std::ptrdiff_t>(i))
      continue;
    emission = std::max(emission, mean_emission(*materials[i], corners));
  }
  const double power = area * emission;
  return std::isfinite(power) ? power : 0;
}

double EmissionMeter::mean_emission(const scene::Material& material,
                                    const std::array<Corner, 3>& corners) const {
  const scene::Texture& texture = material.emissive_texture;
  if (texture.image == scene::none) return double(layout::luminance(material.emissive));
  const std::vector<vec2>& texcoords = assembly_.texcoords[texture.texcoord];
  const scene::Image& image = scene_.images[texture.image];
  std::array<vec2, 3> uv;
  for (size_t i = 0; i < 3; ++i) {
    const vec3 own(at(corners[i], [&](uint32_t vertex) { return texcoords[vertex]; }), 1);
    uv[i] = vec2(glm::dot(texture.u_row, own), glm::dot(texture.v_row, own));
  }
  // About one a texel.
  const vec2 size(image.width, image.height);
  float longest = 1;
  for (size_t i = 0; i < 3; ++i) longest = std::max(longest, glm::length((uv[(i + 1) % 3] - uv[i]) * size));
  if (!std::isfinite(longest)) return 0;
  const int rows = static_cast<int>(std::min(std::ceil(longest), float(most_rows)));
  double sum = 0;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; i + j < rows; ++j) {
      const float u = (float(i) + 1.0f / 3) / float(rows), v = (float(j) + 1.0f / 3) / float(rows);
      sum += texel_luminance(texture, uv[0] * (1 - u - v) + uv[1] * u + uv[2] * v, material.emissive);
    }
  }
  return sum / (rows * (rows + 1) / 2);
}

// Of the texel nearest to there.
double EmissionMeter::texel_luminance(const scene::Texture& texture, vec2 uv, const vec3& factor) const {
  const scene::Image& image = scene_.images[texture.image];
  const auto nearest = [](float coordinate, uint32_t size, scene::Texture::Wrap wrap) {
    return layout::texel_pair(coordinate, size, static_cast<uint32_t>(wrap), 1).first;
  };
  const size_t texel = size_t(nearest(uv.y, image.height, texture.wrap_v)) * image.width +
                       nearest(uv.x, image.width, texture.wrap_u);
  const uint8_t* rgba = &image.rgba[4 * texel];
  return double(layout::luminance(factor * vec3(linear_[rgba[0]], linear_[rgba[1]], linear_[rgba[2]])));
}

}  // namespace

EmitterData make_emitters(const scene::Scene& scene, const scene::Assembly& assembly, const Atlas& atlas) {
  EmitterData data;
  const auto is_emissive = [](const scene::Material& material) { return material.emissive != vec3(0); };
  if (std::none_of(scene.materials.begin(), scene.materials.end(), is_emissive)) return data;
  const EmissionMeter meter(scene, assembly, atlas);
  std::vector<uint8_t> shining(atlas.charts.size());
  parallel_for(shining.size(), 256, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) shining[i] = meter.shines(atlas.charts[i]) ? 1 : 0;
  });
  if (std::find(shining.begin(), shining.end(), 1) == shining.end()) return data;

  data.first_of_charts.resize(atlas.charts.size(), 0);
  size_t c = 0;
  std::vector<uint32_t> charts;  // that shine
  for (const geometry_image::AtlasObject& atlas_object : atlas.objects) {
    EmitterData::Object& object = data.objects.emplace_back();
    object.first_half = static_cast<uint32_t>(2 * data.texels.size());
    for (; c < atlas.charts.size() &&
           atlas.charts[c].first_texel < atlas_object.first_texel + atlas_object.texels;
         ++c) {
      if (shining[c] == 0) continue;
      const ChartRecord& chart = atlas.charts[c];
      charts.push_back(static_cast<uint32_t>(c));
      data.first_of_charts[c] = static_cast<uint32_t>(data.texels.size()) + 1;
      for (uint32_t i = 0; i < chart.width * chart.height; ++i) data.texels.push_back(chart.first_texel + i);
    }
    object.end_half = static_cast<uint32_t>(2 * data.texels.size());
    data.texels.push_back(0);  // never drawn
  }

  std::vector<double> powers(2 * data.texels.size());
  parallel_for(charts.size(), 1, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const ChartRecord& chart = atlas.charts[charts[i]];
      const size_t first = data.first_of_charts[charts[i]] - 1;
      for (uint32_t y = 0; y + 1 < chart.height; ++y)
        for (uint32_t x = 0; x + 1 < chart.width; ++x)
          for (uint32_t half = 0; half < 2; ++half)
            powers[2 * (first + size_t(y) * chart.width + x) + half] = meter.power(chart, x, y, half);
    }
  });

  data.numbers.resize(powers.size(), drawn_numbers);
  bool any = false;
  for (EmitterData::Object& object : data.objects) {
    const std::span<const double> own =
        std::span(powers).subspan(object.first_half, object.end_half - object.first_half);
    for (const double power : own) object.power += power;
    if (!(object.power > 0)) continue;
    any = true;
    share_out(own, std::span(data.numbers).subspan(object.first_half, own.size() + 1));
  }
  return any ? data : EmitterData{};
}

}  // namespace lodestone::render
