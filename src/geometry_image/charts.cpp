// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/charts.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "lodestone/base/error.h"
#include "lodestone/base/parallel.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::geometry_image {
namespace {

constexpr uint64_t texel_limit = uint64_t(1) << 31;

// Small charts are filled many a task, each row of a large one is a task.
constexpr uint64_t charts_a_task = 1u << 10;
constexpr uint64_t worth_many_tasks = 1u << 16;  // texels

// An exact chart, row by row: corners v0 v1 v2 and edge midpoints m of the triangle, its centroid c.
//
//   v0  m01  v1
//   m20  c   m12
//   v2  m12   .
//
// Its three quads are two small triangles each, six in all, and cover the triangle once. An edge midpoint is
// the sum of half one end and half the other (the third weight is exactly 0): equal bits from both sides of
// the edge.
struct Barycentrics {
  float b1, b2;
};
constexpr float third = 1.0f / 3.0f;
constexpr uint32_t exact_side = 3;
constexpr Barycentrics exact_samples[exact_side * exact_side - 1] = {
    {0, 0}, {0.5f, 0}, {1, 0}, {0, 0.5f}, {third, third}, {0.5f, 0.5f}, {0, 1}, {0.5f, 0.5f}};

glm::uvec4 entry(uint32_t triangle, Barycentrics at, uint32_t chart_index) {
  return {triangle, std::bit_cast<uint32_t>(at.b1), std::bit_cast<uint32_t>(at.b2), chart_index + 1};
}

// A sample of a grid is a corner of a triangle of the quad right below it or, on the far borders, of the last
// quad.
glm::uvec4 grid_entry(const layout::ChartRecord& chart, uint32_t chart_index, uint32_t x, uint32_t y) {
  const bool last_x = x + 1 == chart.width, last_y = y + 1 == chart.height;
  const uint32_t quad = (y - uint32_t(last_y)) * (chart.width - 1) + (x - uint32_t(last_x));
  const uint32_t half = last_x && last_y ? 1 : 0;  // (a, b, c) and (d, c, b)
  const Barycentrics at = last_x == last_y ? Barycentrics{0, 0}
                          : last_x         ? Barycentrics{1, 0}
                                           : Barycentrics{0, 1};
  return entry(chart.first_triangle + 2 * quad + half, at, chart_index);
}

std::string label(const scene::Mesh& mesh) {
  return mesh.name.empty() ? std::string("a mesh") : "mesh '" + scene::printable(mesh.name) + "'";
}

bool matches(const scene::Mesh& mesh, const scene::Grid& grid) {
  std::atomic<bool> good = true;
  parallel_for(grid.height - 1, 1, [&](uint64_t y, uint64_t) {
    const uint32_t* row = &grid.vertices[y * grid.width];
    size_t t = grid.first_triangle + 2 * y * (grid.width - 1);
    for (uint32_t x = 0; x + 1 < grid.width; ++x, t += 2) {
      const uint32_t a = row[x], b = row[x + 1], c = row[x + grid.width], d = row[x + grid.width + 1];
      if (mesh.triangles[t] != glm::uvec3(a, b, c) || mesh.triangles[t + 1] != glm::uvec3(d, c, b))
        good = false;
    }
  });
  return good;
}

}  // namespace

void check_grids(const scene::Scene& scene, const scene::Mesh& mesh) {
  uint64_t next = 0;
  for (const scene::Grid& grid : mesh.grids) {
    if (grid.width < 2 || grid.height < 2 || grid.vertices.size() != uint64_t(grid.width) * grid.height) {
      fail_input(scene.name,
                 "{}: a grid of {} x {} samples lists {} vertices; a grid needs at least 2 x 2 and a vertex "
                 "a sample",
                 label(mesh), grid.width, grid.height, grid.vertices.size());
    }
    const uint64_t triangles = uint64_t(2) * (grid.width - 1) * (grid.height - 1);
    const bool in_place = grid.first_triangle == next && next + triangles <= mesh.triangles.size();
    if (!in_place || !matches(mesh, grid)) {
      fail_input(scene.name,
                 "{}: a grid of {} x {} samples is not the triangles of the mesh; leave the grids out",
                 label(mesh), grid.width, grid.height);
    }
    next += triangles;
  }
  if (next != mesh.triangles.size()) {
    fail_input(scene.name, "{}: its grids are {} triangles, the mesh is {}; leave the grids out", label(mesh),
               next, mesh.triangles.size());
  }
}

std::vector<layout::ChartRecord> make_charts(const scene::Scene& scene, const scene::Assembly& assembly,
                                             const TriangleSurvey& survey, const std::vector<bool>& as_grid) {
  // Count first: a list of charts of too many texels is never made.
  uint64_t charts_needed = 0, texels = 0;
  const auto for_each_chart = [&](const auto& visit) {
    for (size_t p = 0; p < assembly.placements.size(); ++p) {
      const scene::Placement& placement = assembly.placements[p];
      const scene::Mesh& mesh = scene.meshes[placement.mesh];
      if (as_grid[p]) {
        for (const scene::Grid& grid : mesh.grids) {
          visit(grid.width, grid.height, layout::chart_grid, placement.first_triangle + grid.first_triangle);
        }
        continue;
      }
      for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const uint32_t t = placement.first_triangle + i;
        if (has_own_chart(survey.fates[t])) visit(exact_side, exact_side, layout::chart_exact, t);
      }
    }
  };
  for_each_chart([&](uint32_t width, uint32_t height, uint32_t, uint32_t) {
    ++charts_needed;
    texels += uint64_t(width) * height;
  });
  if (texels >= texel_limit) {
    fail_input(scene.name,
               "needs a geometry image of {} texels in {} charts, and {} is the most; draw fewer meshes, or "
               "simplify them",
               texels, charts_needed, texel_limit - 1);
  }
  std::vector<layout::ChartRecord> charts;
  charts.reserve(charts_needed);
  uint32_t next = 0;
  for_each_chart([&](uint32_t width, uint32_t height, uint32_t kind, uint32_t triangle) {
    charts.push_back({next, width, height, kind, triangle, 0, 0, 0});
    next += width * height;
  });
  return charts;
}

AtlasKind kind_of(const std::vector<layout::ChartRecord>& charts) {
  const auto all = [&](uint32_t kind) {
    return std::all_of(charts.begin(), charts.end(),
                       [kind](const layout::ChartRecord& chart) { return chart.kind == kind; });
  };
  if (all(layout::chart_grid)) return AtlasKind::grid;
  if (all(layout::chart_mapped)) return AtlasKind::charts;
  return all(layout::chart_exact) ? AtlasKind::exact : AtlasKind::automatic;
}

glm::uvec4 texel_entry(const layout::ChartRecord& chart, uint32_t chart_index, uint32_t x, uint32_t y) {
  if (chart.kind == layout::chart_grid) return grid_entry(chart, chart_index, x, y);
  const uint32_t sample = y * exact_side + x;
  if (sample >= std::size(exact_samples)) return glm::uvec4(0);
  return entry(chart.first_triangle, exact_samples[sample], chart_index);
}

std::vector<glm::uvec4> make_texel_map(const std::vector<layout::ChartRecord>& charts) {
  uint64_t texels = 0;
  for (const layout::ChartRecord& chart : charts) texels += texel_count(chart);
  std::vector<glm::uvec4> map(texels);
  const auto fill_rows = [&](uint64_t index, uint64_t begin, uint64_t end) {
    const layout::ChartRecord& chart = charts[index];
    glm::uvec4* texel = &map[chart.first_texel + begin * chart.width];
    for (auto y = static_cast<uint32_t>(begin); y < end; ++y) {
      for (uint32_t x = 0; x < chart.width; ++x)
        *texel++ = texel_entry(chart, static_cast<uint32_t>(index), x, y);
    }
  };
  parallel_for(charts.size(), charts_a_task, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      if (texel_count(charts[i]) < worth_many_tasks) {
        fill_rows(i, 0, charts[i].height);
      } else {
        parallel_for(charts[i].height, 1, [&](uint64_t first, uint64_t last) { fill_rows(i, first, last); });
      }
    }
  });
  return map;
}

}  // namespace lodestone::geometry_image
