// SPDX-License-Identifier: MIT
#include "lodestone/render/scene_tables.h"

#include <algorithm>

#include "lodestone/layout/atlas.h"

namespace lodestone::render {
namespace {

using glm::uvec4;
using glm::vec3;
using glm::vec4;

uvec4 bits(const vec3& v, uint32_t w) {
  return {std::bit_cast<uint32_t>(v.x), std::bit_cast<uint32_t>(v.y), std::bit_cast<uint32_t>(v.z), w};
}

void upload_vertices(SceneTables& tables, Backend& backend, const scene::Assembly& assembly) {
  const size_t count = assembly.positions.size();
  std::vector<uvec4> quads(count);
  for (size_t i = 0; i < count; ++i) quads[i] = bits(assembly.positions[i], 0);
  tables.base_positions = make_buffer(backend, "base_positions", 16, quads);
  for (size_t i = 0; i < count; ++i) quads[i] = bits(assembly.normals[i], assembly.colors[i]);
  tables.base_normals = make_buffer(backend, "base_normals", 16, quads);
  for (size_t i = 0; i < count; ++i) {
    quads[i] = uvec4(assembly.first_morph[i], assembly.first_morph[i + 1], assembly.first_influence[i],
                     assembly.first_influence[i + 1]);
  }
  tables.vertex_ranges = make_buffer(backend, "vertex_ranges", 16, quads);
  for (size_t i = 0; i < count; ++i) {
    const glm::vec2 a = assembly.texcoords[0][i], b = assembly.texcoords[1][i];
    quads[i] = bits({a.x, a.y, b.x}, std::bit_cast<uint32_t>(b.y));
  }
  tables.texcoords = make_buffer(backend, "texcoords", 16, quads);
  quads.clear();
  if (assembly.has_tangents) {
    for (const vec4& t : assembly.tangents) quads.push_back(bits(vec3(t), std::bit_cast<uint32_t>(t.w)));
  }
  tables.base_tangents = make_buffer(backend, "base_tangents", 16, quads);
}

void upload_deltas(SceneTables& tables, Backend& backend, const scene::Assembly& assembly) {
  std::vector<uvec4> quads;
  quads.reserve(assembly.morphs.size());
  for (const scene::MorphEntry& morph : assembly.morphs) {
    const uvec4 p = bits(morph.position, 0);
    quads.emplace_back(morph.weight, p.x, p.y, p.z);
  }
  tables.morph_positions = make_buffer(backend, "morph_positions", 16, quads);
  for (size_t i = 0; i < quads.size(); ++i) quads[i] = bits(assembly.morphs[i].normal, 0);
  tables.morph_normals = make_buffer(backend, "morph_normals", 16, quads);
  if (!assembly.has_tangents) quads.clear();
  for (size_t i = 0; i < quads.size(); ++i) quads[i] = bits(assembly.morphs[i].tangent, 0);
  tables.morph_tangents = make_buffer(backend, "morph_tangents", 16, quads);
  static_assert(sizeof(scene::MatrixInfluence) == 8);
  tables.influences = make_buffer(backend, "influences", 4, assembly.influences);
}

}  // namespace

SceneTables::SceneTables(Backend& backend, const scene::Assembly& assembly,
                         const geometry_image::Atlas& atlas, const std::vector<uint32_t>& first_emitters) {
  upload_vertices(*this, backend, assembly);
  upload_deltas(*this, backend, assembly);
  triangles = make_buffer(backend, "triangles", 16, assembly.triangles);
  texel_map = make_buffer(backend, "texel_map", 16, atlas.texel_map);
  std::vector<glm::uvec2> slots = atlas.leaf_map;  // in pairs, for those who read them as quads
  if (slots.size() % 2 != 0) slots.emplace_back(layout::empty_slot, 0);
  leaf_map = make_buffer(backend, "leaf_map", 4, slots);
  std::vector<layout::ChartRecord> records;
  if (!first_emitters.empty()) {
    records = atlas.charts;
    for (size_t i = 0; i < records.size(); ++i) records[i].first_emitter = first_emitters[i];
  }
  charts = make_buffer(backend, "charts", 16, first_emitters.empty() ? atlas.charts : records);
  sources = sources_of(atlas);
}

uint32_t sources_of(const geometry_image::Atlas& atlas) {
  const auto is_mapped = [](const layout::ChartRecord& chart) { return chart.kind == layout::chart_mapped; };
  return std::any_of(atlas.charts.begin(), atlas.charts.end(), is_mapped) ? 3 : 1;
}

}  // namespace lodestone::render
