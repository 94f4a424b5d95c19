// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/kept_map.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::BaseComplex;
using base_complex::CellMap;

// Appends where the corners of a face lie on its triangle, unless they are its vertices, in order.
uint32_t keep_piece(const BaseComplex& complex, uint32_t face, std::vector<layout::MapPiece>& pieces) {
  layout::MapPiece piece{};
  bool whole = true;
  for (uint32_t k = 0; k < 3; ++k) {
    const glm::dvec3 at = complex.mesh.barycentrics(3 * face + k);
    piece.corners[k] = glm::vec2(at.y, at.z);
    whole = whole && at[static_cast<glm::length_t>(k)] == 1;
  }
  if (whole) return layout::no_index;
  pieces.push_back(piece);
  return static_cast<uint32_t>(pieces.size() - 1);
}

}  // namespace

ChartMaps keep_map(const BaseComplex& complex, uint32_t cell, const CellMap& map,
                   const std::vector<uint32_t>& triangles, const std::vector<FacePoint>& points,
                   uint32_t columns) {
  ChartMaps kept;
  for (const glm::dvec2& at : map.at) kept.points.emplace_back(at);
  const FaceWalk walk(map);
  for (uint32_t f = 0; f < map.faces.size(); ++f) {
    const uint32_t of_mesh = complex.cells[cell].faces[f];
    layout::MapFace face{};
    for (uint32_t k = 0; k < 3; ++k) {
      face.points[k] = map.faces[f][k];
      const uint32_t beside = walk.beside(f, k);
      face.beside[k] = beside == base_complex::none ? layout::no_index : beside;
    }
    face.triangle = triangles[complex.mesh.triangle(of_mesh)];
    face.piece = keep_piece(complex, of_mesh, kept.pieces);
    kept.faces.push_back(face);
  }
  const auto rows = static_cast<uint32_t>(points.size() / columns);
  for (uint32_t i = 0; i < points.size(); ++i) {
    const uint32_t x = i % columns, y = i / columns;
    if (x == 0 || y == 0 || x + 1 == columns || y + 1 == rows)
      kept.sites.push_back({glm::vec2(x, y), layout::no_index, 1});
    else
      kept.sites.push_back({glm::vec2(place_in(map, points[i])), points[i].face, 1});
  }
  return kept;
}

}  // namespace lodestone::geometry_image
