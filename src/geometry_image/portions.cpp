// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/portions.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "lodestone/base/error.h"
#include "lodestone/geometry_image/chart_boxes.h"
#include "lodestone/geometry_image/charts.h"
#include "lodestone/geometry_image/slots.h"

namespace lodestone::geometry_image {
namespace {

using glm::uvec4;
using layout::ChartRecord;

constexpr uint32_t nowhere = std::numeric_limits<uint32_t>::max();

// A chart in as many rectangles as it takes.
void cut(const ChartRecord& chart, uint32_t number, uint64_t quads, std::vector<ChartPiece>& pieces) {
  const uint32_t width = chart.width - 1, height = chart.height - 1;
  uint32_t columns = 1, rows = 1;
  const auto size = [](uint32_t length, uint32_t parts) { return (length + parts - 1) / parts; };
  while (uint64_t(size(width, columns)) * size(height, rows) > quads)
    ++(size(width, columns) >= size(height, rows) ? columns : rows);
  const auto place = [](uint32_t length, uint32_t part, uint32_t parts) {
    return static_cast<uint32_t>(uint64_t(length) * part / parts);
  };
  for (uint32_t row = 0; row < rows; ++row)
    for (uint32_t column = 0; column < columns; ++column) {
      const uint32_t x = place(width, column, columns), y = place(height, row, rows);
      pieces.push_back(
          {number, x, y, place(width, column + 1, columns) - x + 1, place(height, row + 1, rows) - y + 1});
    }
}

template <class T>
void copy_items(const std::vector<T>& from, const std::vector<uint32_t>& numbers, std::vector<T>& to) {
  if (from.empty()) return;
  to.reserve(numbers.size());
  for (const uint32_t i : numbers) to.push_back(from[i]);
}

// Runs of `items`, vertex by vertex.
template <class T>
void copy_runs(const std::vector<uint32_t>& first, const std::vector<T>& items,
               const std::vector<uint32_t>& numbers, std::vector<uint32_t>& new_first,
               std::vector<T>& new_items) {
  new_first.reserve(numbers.size() + 1);
  new_first.push_back(0);
  for (const uint32_t v : numbers) {
    new_items.insert(new_items.end(), items.begin() + first[v], items.begin() + first[v + 1]);
    new_first.push_back(static_cast<uint32_t>(new_items.size()));
  }
}

}  // namespace

std::vector<std::vector<ChartPiece>> plan_portions(const Atlas& atlas, uint64_t quads) {
  if (atlas.objects.size() != 1)
    fail(ExitCode::usage, "portions", "are of one object, not of {}", atlas.objects.size());
  quads = std::max(quads, least_portion);
  std::vector<uint32_t> order(atlas.charts.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return atlas.charts[a].first_slot < atlas.charts[b].first_slot; });
  std::vector<ChartPiece> pieces;
  for (const uint32_t chart : order) cut(atlas.charts[chart], chart, quads, pieces);
  std::vector<std::vector<ChartPiece>> portions;
  uint64_t filled = 0;
  for (const ChartPiece& piece : pieces) {
    if (portions.empty() || filled + piece.quads() > quads || portions.back().back().chart == piece.chart) {
      portions.emplace_back();
      filled = 0;
    }
    portions.back().push_back(piece);
    filled += piece.quads();
  }
  for (std::vector<ChartPiece>& portion : portions)
    std::sort(portion.begin(), portion.end(),
              [](const ChartPiece& a, const ChartPiece& b) { return a.chart < b.chart; });
  return portions;
}

PortionMaker::PortionMaker(const scene::Assembly& assembly, const Atlas& atlas, std::string name)
    : assembly_(assembly),
      atlas_(atlas),
      name_(std::move(name)),
      local_triangles_(assembly.triangles.size(), nowhere),
      local_vertices_(assembly.positions.size(), nowhere) {}

uint32_t PortionMaker::local_triangle(uint32_t triangle, Portion& portion) {
  uint32_t& local = local_triangles_[triangle];
  if (local == nowhere) {
    local = static_cast<uint32_t>(portion.triangles.size());
    portion.triangles.push_back(triangle);
  }
  return local;
}

// Charts, texels and triangles. Those that a chart counts on to lie one after the other come first.
void PortionMaker::add_charts(std::span<const ChartPiece> pieces, Portion& portion) {
  Atlas& atlas = portion.atlas;
  for (const ChartPiece& piece : pieces) {
    const ChartRecord& whole = atlas_.charts[piece.chart];
    ChartRecord chart = whole;
    chart.first_texel = static_cast<uint32_t>(atlas.texel_map.size());
    chart.width = piece.width;
    chart.height = piece.height;
    chart.first_triangle = 0;
    if (whole.kind == layout::chart_exact)
      chart.first_triangle = local_triangle(whole.first_triangle, portion);
    if (whole.kind == layout::chart_grid) {
      chart.first_triangle = static_cast<uint32_t>(portion.triangles.size());
      for (uint32_t y = piece.y; y + 1 < piece.y + piece.height; ++y)
        for (uint32_t x = piece.x; x + 1 < piece.x + piece.width; ++x)
          for (uint32_t half = 0; half < 2; ++half)
            local_triangle(whole.first_triangle + 2 * (y * (whole.width - 1) + x) + half, portion);
    }
    atlas.charts.push_back(chart);
    for (uint32_t y = piece.y; y < piece.y + piece.height; ++y) {
      const uint32_t first = whole.first_texel + y * whole.width + piece.x;
      const auto local = static_cast<uint32_t>(atlas.texel_map.size());
      const TexelRun* last = portion.runs.empty() ? nullptr : &portion.runs.back();
      if (last == nullptr || first - last->whole != local - last->local)
        portion.runs.push_back({local, first});
      for (uint32_t i = 0; i < piece.width; ++i) {
        uvec4 texel = atlas_.texel_map[first + i];
        if (texel.w != 0) texel.w = static_cast<uint32_t>(atlas.charts.size());
        atlas.texel_map.push_back(texel);
      }
    }
  }
  for (uvec4& texel : atlas.texel_map)
    if (texel.w != 0) texel.x = local_triangle(texel.x, portion);
}

void PortionMaker::add_vertices(Portion& portion, std::vector<glm::vec3>& local_positions,
                                const std::vector<glm::vec3>& positions) {
  scene::Assembly& assembly = portion.assembly;
  std::vector<uint32_t> vertices;
  assembly.triangles.reserve(portion.triangles.size());
  for (const uint32_t t : portion.triangles) {
    uvec4 triangle = assembly_.triangles[t];
    for (glm::length_t corner = 0; corner < 3; ++corner) {
      uint32_t& local = local_vertices_[triangle[corner]];
      if (local == nowhere) {
        local = static_cast<uint32_t>(vertices.size());
        vertices.push_back(triangle[corner]);
      }
      triangle[corner] = local;
    }
    assembly.triangles.push_back(triangle);
  }
  copy_items(assembly_.positions, vertices, assembly.positions);
  copy_items(assembly_.normals, vertices, assembly.normals);
  copy_items(assembly_.tangents, vertices, assembly.tangents);
  copy_items(assembly_.texcoords[0], vertices, assembly.texcoords[0]);
  copy_items(assembly_.texcoords[1], vertices, assembly.texcoords[1]);
  copy_items(assembly_.colors, vertices, assembly.colors);
  copy_items(positions, vertices, local_positions);
  copy_runs(assembly_.first_morph, assembly_.morphs, vertices, assembly.first_morph, assembly.morphs);
  copy_runs(assembly_.first_influence, assembly_.influences, vertices, assembly.first_influence,
            assembly.influences);
  for (const uint32_t v : vertices) local_vertices_[v] = nowhere;
  scene::Object object;
  object.vertices = static_cast<uint32_t>(vertices.size());
  object.triangles = static_cast<uint32_t>(portion.triangles.size());
  assembly.objects.push_back(object);
  assembly.weight_count = assembly_.weight_count;
  assembly.matrix_count = assembly_.matrix_count;
  assembly.has_tangents = assembly_.has_tangents;
}

Portion PortionMaker::make(std::span<const ChartPiece> pieces, const std::vector<glm::vec3>& positions) {
  Portion portion;
  add_charts(pieces, portion);
  for (const uint32_t t : portion.triangles) local_triangles_[t] = nowhere;
  std::vector<glm::vec3> local_positions;
  add_vertices(portion, local_positions, positions);
  Atlas& atlas = portion.atlas;
  std::vector<ChartBox> boxes;
  if (atlas.charts.size() > 1)
    boxes = chart_boxes(portion.assembly.triangles, local_positions, atlas.charts, atlas.texel_map);
  const uint64_t slots = assign_slots(atlas.charts, boxes, ChartOrder::median, name_);
  atlas.kind = kind_of(atlas.charts);
  atlas.objects.push_back(
      {tree_depth(slots), 0, static_cast<uint32_t>(slots), 0, static_cast<uint32_t>(atlas.texel_map.size())});
  atlas.leaf_map = make_leaf_map(atlas.charts, slots);
  atlas.report.triangles = portion.triangles.size();
  atlas.report.texels = atlas.texel_map.size();
  atlas.report.slots = slots;
  for (const ChartPiece& piece : pieces)
    atlas.report.quads += atlas_.charts[piece.chart].kind == layout::chart_exact ? 3 : piece.quads();
  return portion;
}

scene::Bounds portion_bounds(const scene::Assembly& assembly, const Atlas& atlas,
                             std::span<const ChartPiece> pieces, const std::vector<glm::vec3>& positions) {
  scene::Bounds bounds;
  for (const ChartPiece& piece : pieces) {
    const ChartRecord& chart = atlas.charts[piece.chart];
    for (uint32_t y = piece.y; y < piece.y + piece.height; ++y)
      for (uint32_t x = piece.x; x < piece.x + piece.width; ++x) {
        const uvec4& texel = atlas.texel_map[chart.first_texel + y * chart.width + x];
        if (texel.w == 0) continue;
        for (glm::length_t corner = 0; corner < 3; ++corner)
          bounds.include(positions[assembly.triangles[texel.x][corner]]);
      }
  }
  return bounds;
}

}  // namespace lodestone::geometry_image
