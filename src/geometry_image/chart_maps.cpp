// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_maps.h"

#include <cmath>

namespace lodestone::geometry_image {
namespace {

// Sides of a chart are far shorter.
constexpr float largest_coordinate = 65536;

bool is_in_rectangle(const glm::vec2& at) {
  return at.x >= 0 && at.y >= 0 && at.x <= largest_coordinate && at.y <= largest_coordinate;
}

template <class Visit>
void for_each_inner(const layout::ChartRecord& chart, Visit visit) {
  if (chart.kind != layout::chart_mapped) return;
  for (uint32_t y = 1; y + 1 < chart.height; ++y)
    for (uint32_t x = 1; x + 1 < chart.width; ++x) visit(x, y, chart.first_texel + y * chart.width + x);
}

bool is_good_face(const ChartMaps& maps, uint32_t index, uint64_t triangles) {
  const layout::MapFace& face = maps.faces[index];
  for (uint32_t k = 0; k < 3; ++k) {
    if (face.points[k] >= maps.points.size()) return false;
    const uint32_t beside = face.beside[k];
    if (beside == layout::no_index) continue;
    if (beside >= maps.faces.size()) return false;
    // The face beside must have the same edge, the other way round, and this face behind it.
    const layout::MapFace& other = maps.faces[beside];
    bool found = false;
    for (uint32_t i = 0; i < 3; ++i) {
      found = found || (other.beside[i] == index && other.points[i] == face.points[(k + 1) % 3] &&
                        other.points[(i + 1) % 3] == face.points[k]);
    }
    if (!found) return false;
  }
  return face.triangle < triangles && (face.piece == layout::no_index || face.piece < maps.pieces.size());
}

bool is_good_piece(const layout::MapPiece& piece) {
  for (uint32_t k = 0; k < 3; ++k) {
    const float b1 = piece.corners[k].x, b2 = piece.corners[k].y;
    if (!(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1)) return false;
  }
  return true;
}

}  // namespace

uint64_t ChartMaps::bytes() const {
  return faces.size() * sizeof(layout::MapFace) + points.size() * sizeof(glm::vec2) +
         pieces.size() * sizeof(layout::MapPiece) + sites.size() * sizeof(layout::MapSite);
}

void ChartMaps::append(const ChartMaps& more) {
  const auto first_face = static_cast<uint32_t>(faces.size()),
             first_point = static_cast<uint32_t>(points.size()),
             first_piece = static_cast<uint32_t>(pieces.size());
  for (layout::MapFace face : more.faces) {
    for (uint32_t k = 0; k < 3; ++k) {
      face.points[k] += first_point;
      if (face.beside[k] != layout::no_index) face.beside[k] += first_face;
    }
    if (face.piece != layout::no_index) face.piece += first_piece;
    faces.push_back(face);
  }
  points.insert(points.end(), more.points.begin(), more.points.end());
  pieces.insert(pieces.end(), more.pieces.begin(), more.pieces.end());
  for (layout::MapSite site : more.sites) {
    if (site.face != layout::no_index) site.face += first_face;
    sites.push_back(site);
  }
}

InnerTexels inner_texels(const std::vector<layout::ChartRecord>& charts) {
  InnerTexels inner;
  for (uint32_t color = 0; color < InnerTexels::colors; ++color) {
    for (const layout::ChartRecord& chart : charts) {
      for_each_inner(chart, [&](uint32_t x, uint32_t y, uint32_t texel) {
        if ((x + 2 * y) % InnerTexels::colors == color) inner.texels.push_back(texel);
      });
    }
    inner.first[color + 1] = static_cast<uint32_t>(inner.texels.size());
  }
  return inner;
}

std::string find_fault(const ChartMaps& maps, const std::vector<layout::ChartRecord>& charts,
                       const std::vector<glm::uvec4>& texel_map, uint64_t triangles) {
  if (maps.empty()) {
    const bool none = maps.faces.empty() && maps.points.empty() && maps.pieces.empty();
    return none ? "" : "maps of no texel";
  }
  if (maps.sites.size() != texel_map.size()) return "maps of another number of texels";
  for (const glm::vec2& point : maps.points)
    if (!is_in_rectangle(point)) return "a map with a point outside its rectangle";
  for (const layout::MapSite& site : maps.sites)
    if (!is_in_rectangle(site.at) || site.weight != 1) return "a texel outside its rectangle";
  for (const layout::MapPiece& piece : maps.pieces)
    if (!is_good_piece(piece)) return "a map with a piece outside its triangle";
  for (uint32_t f = 0; f < maps.faces.size(); ++f)
    if (!is_good_face(maps, f, triangles)) return "a map with a face that is not as its neighbours say";
  uint64_t inner = 0, with_face = 0;
  bool good = true;
  for (const layout::ChartRecord& chart : charts) {
    for_each_inner(chart, [&](uint32_t, uint32_t, uint32_t texel) {
      ++inner;
      const uint32_t face = maps.sites[texel].face;
      good = good && face < maps.faces.size() && maps.faces[face].triangle == texel_map[texel].x;
    });
  }
  for (const layout::MapSite& site : maps.sites) with_face += site.face == layout::no_index ? 0 : 1;
  return good && with_face == inner ? "" : "a texel in no face of its map";
}

}  // namespace lodestone::geometry_image
