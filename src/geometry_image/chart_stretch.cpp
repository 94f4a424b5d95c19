// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_stretch.h"

#include <algorithm>
#include <cmath>

namespace lodestone::geometry_image {

double ChartStretch::root_mean_square() const {
  double area = 0, sum = 0;
  for (const StretchedFace& face : faces) {
    area += face.area;
    sum += face.area * face.stretch * face.stretch;
  }
  return area > 0 ? std::sqrt(sum * double(quads)) / area : 1.0;
}

ChartStretch chart_stretch(const base_complex::CellMap& map,
                           const std::vector<base_complex::TriangleShape>& rest, uint64_t quads) {
  ChartStretch chart;
  chart.quads = quads;
  for (size_t f = 0; f < map.faces.size(); ++f) {
    const auto& [a, b, c] = map.faces[f];
    if (!(rest[f].area > 0)) continue;
    const double square = squared_stretch(rest[f], map.at[b] - map.at[a], map.at[c] - map.at[a]);
    chart.faces.push_back({std::sqrt(square), rest[f].area});
  }
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
