// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/atlas_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/base/memory.h"
#include "lodestone/base/parallel.h"
#include "lodestone/base_complex/stretch.h"
#include "lodestone/geometry_image/chart_packing.h"
#include "lodestone/geometry_image/charts.h"
#include "lodestone/geometry_image/texel_values.h"
#include "lodestone/layout/arithmetic.h"

namespace lodestone::geometry_image {
namespace {

constexpr uint64_t charts_a_task = 64;

// An integral of the squared stretch over the surface, and that surface's area; and, for quads that have no
// area, the plain sum over how many there are.
struct Sum {
  double energy = 0, area = 0, squares = 0, count = 0;
  void add(const Sum& other) {
    energy += other.energy;
    area += other.area;
    squares += other.squares;
    count += other.count;
  }
  double squared_stretch() const { return area > 0 ? energy / area : count > 0 ? squares / count : 0; }
};

// A triangle of the corner `a` of a quad and its neighbours along the row and the column, in units of texels.
Sum half_quad(const glm::dvec3& a, const glm::dvec3& along_row, const glm::dvec3& along_column) {
  const base_complex::TriangleShape shape = base_complex::shape_of(a, along_row, along_column);
  const double square = base_complex::squared_stretch(shape, {1, 0}, {0, 1});
  return {shape.area * square, shape.area, square, 1};
}

Sum quad_sum(const std::vector<glm::vec3>& positions, const layout::ChartRecord& chart, uint32_t a) {
  const uint32_t b = a + 1, c = a + chart.width, d = c + 1;
  Sum sum = half_quad(positions[a], positions[b], positions[c]);
  sum.add(half_quad(positions[d], positions[c], positions[b]));
  return sum;
}

// Writes the stretch of each texel of a chart, in scene units; returns the area and the number of its quads.
Sum write_stretch(const layout::ChartRecord& chart, const Atlas& atlas,
                  const std::vector<glm::vec3>& positions, float* stretch) {
  Sum total;
  std::vector<Sum> row(chart.width), next(chart.width);
  for (uint32_t y = 0; y < chart.height; ++y) {
    for (uint32_t x = 0; x + 1 < chart.width && y + 1 < chart.height; ++x) {
      const uint32_t a = chart.first_texel + y * chart.width + x;
      if (atlas.texel_map[a + chart.width + 1].w == 0) continue;  // the last quad of an exact chart
      const Sum quad = quad_sum(positions, chart, a);
      for (Sum* texel : {&row[x], &row[x + 1], &next[x], &next[x + 1]}) texel->add(quad);
      total.area += quad.area;
      ++total.count;
    }
    for (const Sum& sum : row) *stretch++ = static_cast<float>(std::sqrt(sum.squared_stretch()));
    row.swap(next);
    std::fill(next.begin(), next.end(), Sum{});
  }
  return total;
}

std::vector<float> stretch_of(const Atlas& atlas, const std::vector<glm::vec3>& positions) {
  std::vector<float> stretch(atlas.texel_map.size(), 0.0f);
  std::vector<Sum> of_charts(atlas.charts.size());
  parallel_for(atlas.charts.size(), charts_a_task, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const layout::ChartRecord& chart = atlas.charts[i];
      of_charts[i] = write_stretch(chart, atlas, positions, &stretch[chart.first_texel]);
    }
  });
  Sum total;
  for (const Sum& sum : of_charts) total.add(sum);
  if (!(total.area > 0)) return stretch;
  const auto spacing = static_cast<float>(std::sqrt(total.area / total.count));
  for (float& s : stretch) s /= spacing;
  return stretch;
}

// Hues a golden section apart, so that charts with numbers near each other differ, in three strengths.
glm::vec3 colour_of_chart(uint32_t chart) {
  constexpr double golden = 0.6180339887498949;
  constexpr float weakest = 0.45f, step = 0.25f;
  const double turns = chart * golden;
  const auto hue = static_cast<float>(turns - std::floor(turns));
  const float saturation = weakest + step * static_cast<float>(chart % 3);
  const auto channel = [&](float third) {
    const float place = hue + third;
    const float away = std::abs(6 * (place - std::floor(place)) - 3);  // 0: the opposite hue, 3: the hue
    return 1 - saturation * (1 - std::clamp(away - 1, 0.0f, 1.0f));
  };
  return {channel(0), channel(2.0f / 3), channel(1.0f / 3)};
}

}  // namespace

AtlasPicture lay_out(const Atlas& atlas, const std::string& subject) {
  std::vector<glm::uvec2> sizes;
  for (const layout::ChartRecord& chart : atlas.charts) sizes.emplace_back(chart.width, chart.height);
  const ChartPacking packing = pack_charts(sizes);
  AtlasPicture picture{packing.width, packing.height, {}, packing.filled};
  const uint64_t pixels = uint64_t(packing.width) * packing.height;
  require_memory(pixels * sizeof(uint32_t), subject);
  picture.texels.assign(pixels, layout::no_index);
  parallel_for(atlas.charts.size(), charts_a_task, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const layout::ChartRecord& chart = atlas.charts[i];
      for (uint32_t y = 0; y < chart.height; ++y) {
        uint32_t texel = chart.first_texel + y * chart.width;
        uint32_t* pixel =
            &picture.texels[uint64_t(packing.places[i].y + y) * packing.width + packing.places[i].x];
        for (uint32_t x = 0; x < chart.width; ++x, ++texel, ++pixel)
          if (atlas.texel_map[texel].w != 0) *pixel = texel;
      }
    }
  });
  return picture;
}

AtlasSurface surface_of(const scene::Scene& scene, const scene::Assembly& assembly, const Atlas& atlas,
                        const scene::Pose& pose) {
  const std::vector<float> weights = scene::frame_weights(scene, assembly, pose);
  const std::vector<glm::vec4> matrices = scene::frame_matrices(scene, assembly, pose);
  AtlasSurface surface;
  surface.positions =
      at_texels(assembly, atlas.texel_map, scene::blended_positions(assembly, weights, matrices));
  surface.normals = at_texels(assembly, atlas.texel_map, scene::blended_normals(assembly, weights, matrices));
  for (glm::vec3& normal : surface.normals) normal = layout::normalize_or(normal, glm::vec3(0));
  surface.stretch = stretch_of(atlas, surface.positions);
  return surface;
}

std::vector<glm::vec3> position_colours(const Atlas& atlas, const AtlasSurface& surface) {
  glm::dvec3 lo(std::numeric_limits<double>::infinity()), hi = -lo;
  for (size_t i = 0; i < surface.positions.size(); ++i) {
    if (atlas.texel_map[i].w == 0) continue;
    lo = glm::min(lo, glm::dvec3(surface.positions[i]));
    hi = glm::max(hi, glm::dvec3(surface.positions[i]));
  }
  std::vector<glm::vec3> colours(surface.positions.size());
  for (size_t i = 0; i < colours.size(); ++i) {
    for (glm::length_t k = 0; k < 3; ++k) {
      const double range = hi[k] - lo[k];
      colours[i][k] =
          range > 0 ? static_cast<float>((double(surface.positions[i][k]) - lo[k]) / range) : 0.5f;
    }
  }
  return colours;
}

std::vector<glm::vec3> normal_colours(const AtlasSurface& surface) {
  std::vector<glm::vec3> colours = surface.normals;
  for (glm::vec3& colour : colours) colour = 0.5f * colour + 0.5f;
  return colours;
}

std::vector<glm::vec3> chart_colours(const Atlas& atlas, const AtlasSurface& surface) {
  const glm::vec3 light = glm::normalize(glm::vec3(0.4f, 0.7f, 0.6f));
  constexpr float darkest = 0.4f;
  std::vector<glm::vec3> colours(surface.normals.size(), glm::vec3(0));
  for (size_t i = 0; i < colours.size(); ++i) {
    if (atlas.texel_map[i].w == 0) continue;
    const float lit = 0.5f + 0.5f * glm::dot(light, surface.normals[i]);
    colours[i] = (darkest + (1 - darkest) * lit) * colour_of_chart(atlas.texel_map[i].w - 1);
  }
  return colours;
}

}  // namespace lodestone::geometry_image
