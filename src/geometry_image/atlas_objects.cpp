// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/atlas_objects.h"

#include <algorithm>
#include <cmath>

#include "lodestone/base/error.h"

namespace lodestone::geometry_image {
namespace {

constexpr uint64_t most_texels = (uint64_t(1) << 31) - 1, most_slots = uint64_t(1) << (2 * layout::max_depth);

double area_of(const scene::Assembly& assembly, const scene::Object& object,
               const std::vector<glm::vec3>& positions) {
  double area = 0;
  for (uint32_t t = object.first_triangle; t < object.first_triangle + object.triangles; ++t) {
    const glm::uvec4& corners = assembly.triangles[t];
    const glm::dvec3 a(positions[corners.x]), b(positions[corners.y]), c(positions[corners.z]);
    area += glm::length(glm::cross(b - a, c - a)) / 2;
  }
  return std::isfinite(area) ? area : 0;
}

// By how much an instance enlarges areas, in the mean of all directions or so.
double area_scale(const glm::mat4& matrix) {
  return std::cbrt(std::pow(std::abs(double(glm::determinant(glm::mat3(matrix)))), 2));
}

void check_room(uint64_t count, uint64_t most, const char* what, const std::string& subject) {
  if (count > most) {
    fail_input(subject, "needs {} {}, and {} is the most; lower --texel-budget, or draw fewer meshes", count,
               what, most);
  }
}

}  // namespace

std::vector<double> object_areas(const scene::Scene& scene, const scene::Assembly& assembly) {
  const scene::Pose rest = scene::evaluate(scene, scene::none, 0);
  const std::vector<glm::vec3> positions = scene::rest_positions(scene, assembly);
  const std::vector<glm::mat4> matrices = scene::frame_instances(assembly, rest);
  std::vector<double> scales(assembly.objects.size(), 0), areas;
  for (size_t i = 0; i < matrices.size(); ++i) {
    double& scale = scales[assembly.instances[i].object];
    scale = std::max(scale, area_scale(matrices[i]));
  }
  for (size_t i = 0; i < assembly.objects.size(); ++i)
    areas.push_back(scales[i] * area_of(assembly, assembly.objects[i], positions));
  return areas;
}

void append(const Atlas& part, uint32_t first_triangle, const std::string& subject, Atlas& atlas) {
  check_room(atlas.texel_map.size() + part.texel_map.size(), most_texels, "texels", subject);
  check_room(atlas.leaf_map.size() + part.leaf_map.size(), most_slots, "leaf slots", subject);
  const auto first_chart = static_cast<uint32_t>(atlas.charts.size());
  const auto first_texel = static_cast<uint32_t>(atlas.texel_map.size());
  const auto first_slot = static_cast<uint32_t>(atlas.leaf_map.size());
  AtlasObject object = part.objects.at(0);
  object.first_slot = first_slot;
  object.first_texel = first_texel;
  atlas.objects.push_back(object);
  for (layout::ChartRecord chart : part.charts) {
    chart.first_texel += first_texel;
    chart.first_slot += first_slot;
    if (chart.kind != layout::chart_mapped) chart.first_triangle += first_triangle;
    atlas.charts.push_back(chart);
  }
  for (const glm::uvec4& texel : part.texel_map)
    atlas.texel_map.push_back(texel.w == 0 ? texel : texel + glm::uvec4(first_triangle, 0, 0, first_chart));
  for (const glm::uvec2& leaf : part.leaf_map)
    atlas.leaf_map.push_back(leaf.x == layout::empty_slot ? leaf : leaf + glm::uvec2(first_texel, 0));
  AtlasReport& report = atlas.report;
  for (uint64_t AtlasReport::*count :
       {&AtlasReport::triangles, &AtlasReport::quads, &AtlasReport::texels, &AtlasReport::slots,
        &AtlasReport::degenerate_triangles, &AtlasReport::duplicate_triangles,
        &AtlasReport::non_manifold_edges, &AtlasReport::boundary_edges, &AtlasReport::welded_vertices,
        &AtlasReport::mapped_triangles, &AtlasReport::mapped_charts, &AtlasReport::repeated_texels})
    report.*count += part.report.*count;
  report.notes.insert(report.notes.end(), part.report.notes.begin(), part.report.notes.end());
}

void join_stretch(const std::vector<AtlasReport>& parts, const std::vector<double>& areas, AtlasReport& all) {
  double mapped = 0;
  all.mean_stretch = all.high_stretch = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].mapped_charts == 0) continue;
    mapped += areas[i];
    all.mean_stretch += areas[i] * parts[i].mean_stretch;
    all.high_stretch = std::max(all.high_stretch, parts[i].high_stretch);
  }
  if (mapped > 0) all.mean_stretch /= mapped;
}

}  // namespace lodestone::geometry_image
