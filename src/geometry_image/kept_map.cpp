// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/kept_map.h"

#include <unordered_map>

#include "lodestone/geometry_image/chart_sampler.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::BaseComplex;
using base_complex::CellMap;

uint64_t edge_key(uint32_t from, uint32_t to) {
  return uint64_t(from) << 32 | to;
}

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
                   const std::vector<uint32_t>& triangles, uint32_t columns, uint32_t rows) {
  ChartMaps kept;
  for (const glm::dvec2& at : map.at) kept.points.emplace_back(at);
  std::unordered_map<uint64_t, uint32_t> face_of_edge;
  for (uint32_t f = 0; f < map.faces.size(); ++f)
    for (uint32_t k = 0; k < 3; ++k)
      face_of_edge.emplace(edge_key(map.faces[f][k], map.faces[f][(k + 1) % 3]), f);
  for (uint32_t f = 0; f < map.faces.size(); ++f) {
    const uint32_t of_mesh = complex.cells[cell].faces[f];
    layout::MapFace face{};
    for (uint32_t k = 0; k < 3; ++k) {
      face.points[k] = map.faces[f][k];
      const auto beside = face_of_edge.find(edge_key(map.faces[f][(k + 1) % 3], map.faces[f][k]));
      face.beside[k] = beside == face_of_edge.end() ? layout::no_index : beside->second;
    }
    face.triangle = triangles[complex.mesh.triangle(of_mesh)];
    face.piece = keep_piece(complex, of_mesh, kept.pieces);
    kept.faces.push_back(face);
  }
  const std::vector<FacePoint> found = find_lattice(map, columns, rows, 1);
  kept.face_of_texel.assign(found.size(), layout::no_index);
  for (uint32_t y = 1; y + 1 < rows; ++y) {
    for (uint32_t x = 1; x + 1 < columns; ++x) {
      const size_t i = size_t(y) * columns + x;
      if (found[i].face == base_complex::none) throw base_complex::NotMappable{};
      kept.face_of_texel[i] = found[i].face;
    }
  }
  return kept;
}

}  // namespace lodestone::geometry_image
