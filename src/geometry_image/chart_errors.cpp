// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_errors.h"

#include <algorithm>

#include "lodestone/base/parallel.h"

namespace lodestone::geometry_image {
namespace {

constexpr uint64_t triangles_a_task = 1u << 10;

std::vector<glm::uvec3> triangles_of(const ChartPoints& image) {
  std::vector<glm::uvec3> triangles;
  for (const layout::ChartRecord& chart : image.charts) {
    for (uint32_t y = 0; y + 1 < chart.height; ++y) {
      for (uint32_t x = 0; x + 1 < chart.width; ++x) {
        const uint32_t a = chart.first_texel + y * chart.width + x, c = a + chart.width;
        triangles.emplace_back(a, a + 1, c);
        triangles.emplace_back(c + 1, c, a + 1);
      }
    }
  }
  return triangles;
}

}  // namespace

std::vector<double> errors_from_image(const ChartPoints& image, const mesh::TriangleTree& input) {
  std::vector<double> errors(image.charts.size(), 0);
  parallel_for(errors.size(), 1, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const auto check = [&](const glm::dvec3& point) {
        errors[i] = std::max(errors[i], input.nearest(point).distance);
      };
      for (const glm::uvec3& t : triangles_of({image.charts.subspan(i, 1), image.points})) {
        const glm::dvec3 a = image.points[t.x], b = image.points[t.y], c = image.points[t.z];
        check(0.5 * (a + b));
        check(0.5 * (a + c));
        check(0.5 * (b + c));
        check((a + b + c) / 3.0);
      }
    }
  });
  return errors;
}

std::vector<double> errors_from_input(const mesh::Surface& input, std::span<const uint32_t> chart_of_triangle,
                                      const ChartPoints& image) {
  const std::vector<glm::uvec3> triangles = triangles_of(image);
  const mesh::TriangleTree tree({image.points, triangles});
  std::vector<double> of_triangle(input.triangles.size(), 0);
  parallel_for(of_triangle.size(), triangles_a_task, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const glm::uvec3& t = input.triangles[i];
      const glm::dvec3 a = input.positions[t.x], b = input.positions[t.y], c = input.positions[t.z];
      for (const glm::dvec3& point : {a, b, c, (a + b + c) / 3.0})
        of_triangle[i] = std::max(of_triangle[i], tree.nearest(point).distance);
    }
  });
  std::vector<double> errors(image.charts.size(), 0);
  for (size_t i = 0; i < of_triangle.size(); ++i) {
    if (chart_of_triangle[i] == mesh::none) continue;
    double& error = errors[chart_of_triangle[i]];
    error = std::max(error, of_triangle[i]);
  }
  return errors;
}

}  // namespace lodestone::geometry_image
