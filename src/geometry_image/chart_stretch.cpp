// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_stretch.h"

#include <algorithm>
#include <cmath>

namespace lodestone::geometry_image {

ChartStretch chart_stretch(const base_complex::CellMap& map,
                           const std::vector<base_complex::TriangleShape>& rest, uint64_t quads) {
  ChartStretch chart;
  chart.quads = quads;
  // Over the surface's area the squares of how much longer steps along the rectangle's two sides become. With
  // another aspect one of them is multiplied by what the other is divided by, so their sum is least when they
  // are equal.
  double across = 0, along = 0, area = 0;
  for (size_t f = 0; f < map.faces.size(); ++f) {
    const auto& [a, b, c] = map.faces[f];
    if (!(rest[f].area > 0)) continue;
    const glm::dvec2 d1 = map.at[b] - map.at[a], d2 = map.at[c] - map.at[a];
    const double square = squared_stretch(rest[f], d1, d2);
    chart.faces.push_back({std::sqrt(square), rest[f].area});
    const double det = base_complex::cross(d1, d2);
    across += rest[f].area *
              (rest[f].e11 * d2.y * d2.y - 2 * rest[f].e12 * d1.y * d2.y + rest[f].e22 * d1.y * d1.y) /
              (det * det);
    along += rest[f].area *
             (rest[f].e11 * d2.x * d2.x - 2 * rest[f].e12 * d1.x * d2.x + rest[f].e22 * d1.x * d1.x) /
             (det * det);
    area += rest[f].area;
  }
  if (area > 0) chart.unevenness = std::sqrt(std::sqrt(across * along) * double(quads)) / area;
  return chart;
}

StretchSummary sum_up(const std::vector<ChartStretch>& charts) {
  constexpr double most = 0.95;
  std::vector<StretchedFace> all;
  double quads = 0, area = 0, sum = 0, below = 0;
  for (const ChartStretch& chart : charts) {
    all.insert(all.end(), chart.faces.begin(), chart.faces.end());
    quads += double(chart.quads);
  }
  for (const StretchedFace& face : all) {
    area += face.area;
    sum += face.area * face.stretch;
  }
  if (!(area > 0)) return {};
  const double scale = std::sqrt(quads / area);
  std::sort(all.begin(), all.end(), [](const StretchedFace& a, const StretchedFace& b) {
    return a.stretch != b.stretch ? a.stretch < b.stretch : a.area < b.area;
  });
  StretchSummary summary;
  summary.mean = sum / area * scale;
  for (const StretchedFace& face : all) {
    below += face.area;
    summary.high = face.stretch * scale;
    if (below >= most * area) break;
  }
  return summary;
}

}  // namespace lodestone::geometry_image
