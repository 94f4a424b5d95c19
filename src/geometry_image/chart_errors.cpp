// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_errors.h"

#include <algorithm>

#include "lodestone/base/parallel.h"

namespace lodestone::geometry_image {
namespace {

constexpr uint64_t triangles_a_task = 1u << 8;

std::vector<glm::uvec3> triangles_of(std::span<const layout::ChartRecord> charts) {
  std::vector<glm::uvec3> triangles;
  for (const layout::ChartRecord& chart : charts) {
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

double longest_edge(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
}

bool is_long(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double apart) {
  return longest_edge(a, b, c) > 2 * apart;
}

// Calls check(point) for the middles of a triangle's edges, its centroid, and as many points between them as
// it takes that none is farther than `apart` from the next, but no more than some.
template <class Check>
void for_samples(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double apart, Check check) {
  constexpr double most = 4;  // halves of them an edge
  const double longest = longest_edge(a, b, c);
  const int steps =
      is_long(a, b, c, apart) ? 2 * static_cast<int>(std::min(std::ceil(0.5 * longest / apart), most)) : 2;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const bool corner = i == steps || j == steps || i + j == 0;
      if (!corner) check(a + (b - a) * (double(i) / steps) + (c - a) * (double(j) / steps));
    }
  }
  check((a + b + c) / 3.0);
}

void sort_out(std::vector<uint32_t>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

ChartErrors::ChartErrors(const base_complex::BaseComplex& complex, const mesh::Surface& input,
                         const mesh::TriangleTree& input_tree, double apart)
    : input_(input),
      input_tree_(input_tree),
      apart_(apart),
      neighbours_(complex.cells.size()),
      triangles_(complex.cells.size()),
      chart_of_triangle_(input.triangles.size(), mesh::none),
      of_image_(complex.cells.size(), 0),
      of_triangle_(input.triangles.size(), 0),
      errors_(complex.cells.size(), 0) {
  for (uint32_t face = 0; face < complex.mesh.faces(); ++face) {
    const uint32_t triangle = complex.mesh.triangle(face), chart = complex.cell_of_face[face];
    chart_of_triangle_[triangle] = chart;
    triangles_[chart].push_back(triangle);
  }
  for (std::vector<uint32_t>& list : triangles_) sort_out(list);
  const std::vector<std::vector<uint32_t>> beside = cells_beside_arcs(complex);
  for (uint32_t c = 0; c < complex.cells.size(); ++c) {
    neighbours_[c].push_back(c);
    for (const base_complex::Passage& passage : complex.cells[c].boundary)
      neighbours_[c].insert(neighbours_[c].end(), beside[passage.arc].begin(), beside[passage.arc].end());
    sort_out(neighbours_[c]);
  }
}

const std::vector<double>& ChartErrors::measure(const ChartPoints& image, const std::vector<bool>& changed) {
  measure_image(image, changed);
  measure_input(image, changed);
  errors_ = of_image_;
  for (size_t i = 0; i < of_triangle_.size(); ++i) {
    if (chart_of_triangle_[i] == mesh::none) continue;
    double& error = errors_[chart_of_triangle_[i]];
    error = std::max(error, of_triangle_[i]);
  }
  return errors_;
}

void ChartErrors::measure_image(const ChartPoints& image, const std::vector<bool>& changed) {
  parallel_for(of_image_.size(), 1, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      if (!changed[i]) continue;
      of_image_[i] = 0;
      const auto check = [&](const glm::dvec3& point) {
        of_image_[i] = std::max(of_image_[i], input_tree_.nearest(point).distance);
      };
      for (const glm::uvec3& t : triangles_of(image.charts.subspan(i, 1))) {
        const glm::dvec3 a = image.points[t.x], b = image.points[t.y], c = image.points[t.z];
        for_samples(a, b, c, apart_, check);
      }
    }
  });
}

void ChartErrors::measure_input(const ChartPoints& image, const std::vector<bool>& changed) {
  const std::vector<glm::uvec3> all = triangles_of(image.charts);
  const mesh::TriangleTree tree({image.points, all});
  std::vector<uint32_t> near;
  for (size_t c = 0; c < changed.size(); ++c) {
    if (!changed[c]) continue;
    near.insert(near.end(), neighbours_[c].begin(), neighbours_[c].end());
  }
  sort_out(near);
  std::vector<uint32_t> triangles;
  for (const uint32_t c : near) triangles.insert(triangles.end(), triangles_[c].begin(), triangles_[c].end());
  sort_out(triangles);
  parallel_for(triangles.size(), triangles_a_task, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const glm::uvec3& t = input_.triangles[triangles[i]];
      const glm::dvec3 a = input_.positions[t.x], b = input_.positions[t.y], c = input_.positions[t.z];
      double& error = of_triangle_[triangles[i]];
      error = 0;
      const auto check = [&](const glm::dvec3& point) {
        error = std::max(error, tree.nearest(point).distance);
      };
      for (const glm::dvec3& point : {a, b, c, (a + b + c) / 3.0}) check(point);
      if (is_long(a, b, c, apart_)) for_samples(a, b, c, apart_, check);
    }
  });
}

}  // namespace lodestone::geometry_image
