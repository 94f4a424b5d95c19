// SPDX-License-Identifier: MIT
// What a chart would look like at each resolution: its surface on a fine lattice, and how far coarser
// lattices stray from that.
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
  ChartProfile(ChartPowers powers, std::vector<glm::dvec3> points, const std::vector<FirmArc>& firm);

  // How far, at most, samples of the fine lattice are from the quads of a coarser one (sides in quads, powers
  // of 2), measured across the surface; for sliding along it is no error, unless it leads over a firm arc. Of
  // a finer lattice than the profile's it is what the error would shrink to if it fell with the square of the
  // spacing.
  double error(uint32_t width, uint32_t height) const;

  // How wide and how high a quad is on average where there are so many, and the larger of the two.
  double width_spacing(uint32_t width) const { return width_ / width; }
  double height_spacing(uint32_t height) const { return height_ / height; }
  double spacing(uint32_t width, uint32_t height) const {
    return std::max(width_spacing(width), height_spacing(height));
  }

 private:
  const glm::dvec3& at(uint32_t x, uint32_t y) const {
    return points_[size_t(y) * ((1u << powers_.width) + 1) + x];
  }
  glm::dvec3 normal_at(uint32_t x, uint32_t y) const;
  void find_room(const std::vector<FirmArc>& firm);
  double surface_error(ChartPowers powers) const;
  double error_of_quad(uint32_t x, uint32_t y, uint32_t step_x, uint32_t step_y) const;

  ChartPowers powers_;
  std::vector<glm::dvec3> points_, normals_;
  std::vector<double> room_;  // of each sample, how far it is from the nearest firm arc

  double width_ = 0, height_ = 0;  // mean lengths of rows and columns
};

}  // namespace lodestone::geometry_image
