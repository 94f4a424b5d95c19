// SPDX-License-Identifier: MIT
#include "lodestone/test_support/mapped_charts.h"

#include <bit>

#include "lodestone/geometry_image/charts.h"
#include "lodestone/geometry_image/slots.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

constexpr uint32_t side_materials[2] = {0, 1}, plain_material = 2;

scene::Mesh split_square(const Straddled& options) {
  scene::Mesh mesh;
  // In the first triangle u runs along +X and v along -Y, in the second u along +Y and v along -X.
  mesh.positions = {{-1, 1, 0}, {-1, -1, 0}, {1, 1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, -1, 0}};
  mesh.normals.assign(6, {0, 0, 1});
  mesh.texcoords[0] = {{0.25f, 0.5f}, {0.25f, 1.5f}, {0.5f, 0.5f}, {5, 3}, {6, 3}, {5, 5}};
  mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 1}, {1, 1, 0, 0}, {0, 1, 1, 0}, {1, 1, 1, 1}};
  if (options.tangents) {
    mesh.tangents.assign(6, {1, 0, 0, 1});
    for (size_t v = 3; v < 6; ++v) mesh.tangents[v] = {0, 1, 0, -1};
  }
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh.parts = {{0, 1, side_materials[0]}, {1, 1, side_materials[1]}};
  return mesh;
}

// From `left` to `left` + 0.3.
scene::Mesh strip(float left) {
  scene::Mesh mesh = square(0, plain_material);
  for (glm::vec3& p : mesh.positions) p.x = left + 0.15f * (p.x + 1);
  mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
  return mesh;
}

scene::Scene three_squares(const Straddled& options) {
  scene::Mesh grid = strip(-1.4f);
  grid.grids = {{2, 2, 0, {0, 2, 1, 3}}};
  scene::Material first;
  first.metallic = 0;
  first.base_color = {1, 0.5f, 0.25f, 1};
  first.normal_texture.image = 0;
  first.alpha_mask = options.cut_out;
  scene::Material second = first;
  second.base_color = {0.25f, 1, 0.5f, 1};
  scene::Scene scene = facing_camera({split_square(options), strip(1.1f), grid}, {first, second, {}});
  scene::Image tilted;
  tilted.width = tilted.height = 1;
  tilted.rgba = {204, 153, 255, 255};  // 0.6, 0.2, 1
  scene.images = {tilted};
  return scene;
}

glm::uvec4 straddled_texel(uint32_t x, uint32_t y) {
  const glm::dvec2 p = straddled_point(x, y);
  const bool second = p.y < p.x;
  const auto b1 = static_cast<float>(0.5 * (second ? 1 + p.y : 1 - p.y));
  const auto b2 = static_cast<float>(0.5 * (second ? 1 - p.x : 1 + p.x));
  return {second ? 1 : 0, std::bit_cast<uint32_t>(b1), std::bit_cast<uint32_t>(b2), 1};
}

}  // namespace

void map_grids(geometry_image::Atlas& atlas, uint32_t nth) {
  for (size_t i = 0; i < atlas.charts.size(); i += nth) {
    if (atlas.charts[i].kind != layout::chart_grid) continue;
    atlas.charts[i].kind = layout::chart_mapped;
    atlas.charts[i].first_triangle = 0;
  }
  atlas.kind = geometry_image::kind_of(atlas.charts);
}

ReadyScene straddled_squares(const Straddled& options) {
  // Of its six exact charts, the first two and the last two make room for a mapped one and a grid.
  ReadyScene ready(three_squares(options), geometry_image::AtlasKind::exact);
  geometry_image::Atlas& atlas = ready.atlas;
  std::vector<layout::ChartRecord> charts(atlas.charts.begin(), atlas.charts.begin() + 4);
  charts.push_back({0, 2, 2, layout::chart_grid, atlas.charts[4].first_triangle, 0, 0, 0});
  if (options.mapped) {
    charts.erase(charts.begin());
    charts[0] = {0, straddled_width, straddled_height, layout::chart_mapped, 0, 0, 0, 0};
  }
  std::vector<glm::uvec4> texels;
  for (uint32_t i = 0; i < charts.size(); ++i) {
    charts[i].first_texel = static_cast<uint32_t>(texels.size());
    for (uint32_t y = 0; y < charts[i].height; ++y) {
      for (uint32_t x = 0; x < charts[i].width; ++x)
        texels.push_back(options.mapped && i == 0 ? straddled_texel(x, y)
                                                  : geometry_image::texel_entry(charts[i], i, x, y));
    }
  }
  const uint64_t slots =
      geometry_image::assign_slots(charts, std::vector<geometry_image::ChartBox>(charts.size()),
                                   geometry_image::ChartOrder::median, ready.scene.name);
  atlas.kind = geometry_image::kind_of(charts);
  atlas.objects = {{geometry_image::tree_depth(slots), 0, static_cast<uint32_t>(slots), 0,
                    static_cast<uint32_t>(texels.size())}};
  atlas.leaf_map = geometry_image::make_leaf_map(charts, slots);
  atlas.report.quads = 0;
  for (const layout::ChartRecord& chart : charts)
    atlas.report.quads += chart.kind == layout::chart_exact ? 3 : geometry_image::quad_count(chart);
  atlas.report.texels = texels.size();
  atlas.report.slots = slots;
  atlas.charts = std::move(charts);
  atlas.texel_map = std::move(texels);
  return ready;
}

}  // namespace lodestone::test
