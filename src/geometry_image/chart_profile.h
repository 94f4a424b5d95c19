// SPDX-License-Identifier: MIT
// What a chart would look like at each resolution: how far coarser lattices stray from a fine one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lodestone::geometry_image {

// Sides of 2^power quads.
struct ChartPowers {
  uint32_t width = 0, height = 0;
};

// A firm arc (see base_complex/base_complex.h) on a chart's border.
struct FirmArc {
  uint32_t side = 0;        // counterclockwise; the first row is 0
  double from = 0, to = 1;  // of the side's length, along that way round
};

class ChartProfile {
 public:
  // `points` are the (2^width + 1) x (2^height + 1) samples of a lattice, row by row.
  ChartProfile(ChartPowers powers, const std::vector<glm::dvec3>& points, const std::vector<FirmArc>& firm);

  // How far, at most, some samples of the fine lattice are from the quads of a coarser one (sides in quads),
  // measured across the surface; for sliding along it is no error, unless it leads over a firm arc. Of sides
  // between two powers of 2 it is something between theirs. Of a finer lattice than the profile's it is what
  // the error would shrink to if it fell with the square of the spacing.
  double error(uint32_t width, uint32_t height) const;

  // How wide and how high a quad is on average where there are so many, and the larger of the two.
  double width_spacing(uint32_t width) const { return width_ / width; }
  double height_spacing(uint32_t height) const { return height_ / height; }
  double spacing(uint32_t width, uint32_t height) const {
    return std::max(width_spacing(width), height_spacing(height));
  }

 private:
  double error_of(ChartPowers powers) const;

  ChartPowers powers_;
  std::vector<double> errors_;     // of all lattices up to the fine one: the height's power counts up first
  double width_ = 0, height_ = 0;  // mean lengths of rows and columns
};

}  // namespace lodestone::geometry_image
