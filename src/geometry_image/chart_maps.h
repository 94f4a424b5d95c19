// SPDX-License-Identifier: MIT
// The maps of mapped charts onto their rectangles, kept: with them a texel can be moved to another place of
// its chart after the atlas was made (the `relax` pass). shaders/layout/relax.h declares the buffers.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "lodestone/layout/atlas.h"
#include "lodestone/layout/relax.h"

namespace lodestone::geometry_image {

struct ChartMaps {
  std::vector<layout::MapFace> faces;    // of all charts
  std::vector<glm::vec2> points;         // in the rectangle of their chart, whose unit is a quad
  std::vector<layout::MapPiece> pieces;  // of faces that are not a whole triangle
  // One a texel of the atlas. Only inner texels of mapped charts have a face; those of other charts have no
  // place either.
  std::vector<layout::MapSite> sites;

  bool empty() const { return sites.empty(); }
  uint64_t bytes() const;
  // Appends those of further charts, whose texels follow.
  void append(const ChartMaps& more);
};

// The texels that a relaxation may move: all of mapped charts but those on their borders. Colour c has
// texels[first[c]] .. texels[first[c + 1] - 1], ascending; no two of one colour share a triangle of the
// lattice.
struct InnerTexels {
  static constexpr uint32_t colors = 3;
  std::vector<uint32_t> texels;
  std::array<uint32_t, colors + 1> first{};
};
InnerTexels inner_texels(const std::vector<layout::ChartRecord>& charts);

// What is wrong with maps that claim to be those of an atlas over `triangles` triangles; empty where every
// index leads to what it should.
std::string find_fault(const ChartMaps& maps, const std::vector<layout::ChartRecord>& charts,
                       const std::vector<glm::uvec4>& texel_map, uint64_t triangles);

}  // namespace lodestone::geometry_image
