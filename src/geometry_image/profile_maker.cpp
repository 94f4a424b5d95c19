// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/profile_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lodestone/geometry_image/chart_sizes.h"
#include "lodestone/geometry_image/map_lookup.h"

namespace lodestone::geometry_image {

using base_complex::Cell;
using base_complex::CellMap;
using base_complex::NotMappable;
using base_complex::Rectangle;
using base_complex::Side;

ProfileMaker::ProfileMaker(const base_complex::BaseComplex& complex, uint64_t texel_budget)
    : complex_(complex) {
  double area = 0;
  for (const Cell& cell : complex.cells) area += cell.area;
  const double spacing = std::sqrt(area / double(texel_budget));
  spacing_ = spacing > 0 ? spacing : 1;  // of what is one point any will do
}

ChartProfile ProfileMaker::make(uint32_t cell, std::vector<base_complex::TriangleShape> shapes) const {
  constexpr int finer = 2, most = 7;  // powers of two
  const glm::dvec2 extent = glm::max(extent_of(complex_, complex_.cells[cell]) / spacing_, 1.0);
  const auto power = [](double quads) {
    return static_cast<uint32_t>(std::clamp(std::round(std::log2(quads)), 0.0, double(most - finer)));
  };
  const ChartPowers powers = {power(extent.x), power(extent.y)};
  Rectangle rectangle;
  rectangle.width = 1u << powers.width;
  rectangle.height = 1u << powers.height;
  const std::vector<FirmArc> firm = lay_out(complex_.cells[cell], rectangle);
  const CellMap map = map_cell(complex_, cell, rectangle, std::move(shapes), {});
  const ChartPowers fine = {powers.width + finer, powers.height + finer};
  std::vector<glm::dvec3> points;
  for (const FacePoint& p :
       find_lattice(map, (1u << fine.width) + 1, (1u << fine.height) + 1, std::ldexp(1.0, -finer))) {
    if (p.face == base_complex::none) throw NotMappable{};
    const auto& [a, b, c] = map.faces[p.face];
    const glm::dvec3 sum = complex_.mesh.position(map.points[a]) * p.barycentrics.x +
                           complex_.mesh.position(map.points[b]) * p.barycentrics.y +
                           complex_.mesh.position(map.points[c]) * p.barycentrics.z;
    points.push_back(sum / (p.barycentrics.x + p.barycentrics.y + p.barycentrics.z));
  }
  return {fine, points, firm};
}

// Gives each passage of a cell its share of its side, by length.
std::vector<FirmArc> ProfileMaker::lay_out(const Cell& cell, Rectangle& rectangle) const {
  constexpr double spread = 1e-4;  // so that no arc vanishes
  const std::array<Side, 4> sides = sides_of(complex_, cell);
  std::vector<FirmArc> firm;
  for (uint32_t s = 0; s < 4; ++s) {
    const double even = 1.0 / double(sides[s].end - sides[s].first);
    double walked = 0;
    for (size_t p = sides[s].first; p < sides[s].end; ++p) {
      const base_complex::Arc& arc = complex_.arcs[cell.boundary[p].arc];
      const double by_length = sides[s].length > 0 ? arc.length / sides[s].length : even;
      const double share = (1 - spread) * by_length + spread * even;
      if (arc.firm) firm.push_back({s, walked, walked + share});
      rectangle.segments.push_back(share * (s % 2 == 0 ? rectangle.width : rectangle.height));
      walked += share;
    }
  }
  return firm;
}

}  // namespace lodestone::geometry_image
