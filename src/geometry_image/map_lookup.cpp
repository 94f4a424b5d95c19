// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/map_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace lodestone::geometry_image {
namespace {

uint64_t edge_key(uint32_t from, uint32_t to) {
  return uint64_t(from) << 32 | to;
}

}  // namespace

std::vector<FacePoint> find_lattice(const base_complex::CellMap& map, uint32_t columns, uint32_t rows,
                                    double spacing) {
  constexpr double slack = 1e-6;
  std::vector<FacePoint> points(size_t(columns) * rows);
  std::vector<double> inside(points.size(), -std::numeric_limits<double>::infinity());
  for (uint32_t f = 0; f < map.faces.size(); ++f) {
    const glm::dvec2 a = map.at[map.faces[f][0]] / spacing, b = map.at[map.faces[f][1]] / spacing,
                     c = map.at[map.faces[f][2]] / spacing;
    const glm::dvec2 lo = glm::max(glm::min(a, glm::min(b, c)) - slack, 0.0);
    const glm::dvec2 hi = glm::max(a, glm::max(b, c)) + slack;
    const double det = base_complex::cross(b - a, c - a);
    if (!(det > 0)) continue;
    for (auto y = static_cast<uint32_t>(std::ceil(lo.y)); y < rows && y <= hi.y; ++y) {
      for (auto x = static_cast<uint32_t>(std::ceil(lo.x)); x < columns && x <= hi.x; ++x) {
        const glm::dvec2 p(x, y);
        const double b1 = base_complex::cross(p - a, c - a) / det,
                     b2 = base_complex::cross(b - a, p - a) / det;
        const glm::dvec3 at(1 - b1 - b2, b1, b2);
        const double margin = std::min({at.x, at.y, at.z});
        const size_t i = size_t(y) * columns + x;
        if (margin <= inside[i]) continue;
        inside[i] = margin;
        points[i] = {f, glm::max(at, glm::dvec3(0))};
      }
    }
  }
  return points;
}

glm::dvec2 place_in(const base_complex::CellMap& map, const FacePoint& point) {
  const auto& [a, b, c] = map.faces[point.face];
  const glm::dvec3& w = point.barycentrics;
  return (map.at[a] * w.x + map.at[b] * w.y + map.at[c] * w.z) / (w.x + w.y + w.z);
}

FaceWalk::FaceWalk(const base_complex::CellMap& map) : map_(map), beside_(map.faces.size()) {
  std::unordered_map<uint64_t, uint32_t> face_of_edge;
  for (uint32_t f = 0; f < map.faces.size(); ++f)
    for (uint32_t k = 0; k < 3; ++k)
      face_of_edge.emplace(edge_key(map.faces[f][k], map.faces[f][(k + 1) % 3]), f);
  for (uint32_t f = 0; f < map.faces.size(); ++f) {
    for (uint32_t k = 0; k < 3; ++k) {
      const auto beside = face_of_edge.find(edge_key(map.faces[f][(k + 1) % 3], map.faces[f][k]));
      beside_[f][k] = beside == face_of_edge.end() ? base_complex::none : beside->second;
    }
  }
}

FacePoint FaceWalk::find(const glm::dvec2& at, uint32_t start) const {
  constexpr int most_steps = 256;
  constexpr double slack = 1e-9;
  uint32_t face = start;
  for (int step = 0; step < most_steps && face != base_complex::none; ++step) {
    const auto& [i, j, k] = map_.faces[face];
    const glm::dvec2 a = map_.at[i], b = map_.at[j], c = map_.at[k];
    const double det = base_complex::cross(b - a, c - a);
    if (!(det > 0)) break;
    const double b1 = base_complex::cross(at - a, c - a) / det, b2 = base_complex::cross(b - a, at - a) / det;
    const std::array<double, 3> weights = {1 - b1 - b2, b1, b2};
    const auto least =
        static_cast<uint32_t>(std::min_element(weights.begin(), weights.end()) - weights.begin());
    if (weights[least] >= -slack)
      return {face, glm::max(glm::dvec3(weights[0], weights[1], weights[2]), glm::dvec3(0))};
    face = beside_[face][(least + 1) % 3];  // the edge that faces this corner
  }
  return {};
}

}  // namespace lodestone::geometry_image
