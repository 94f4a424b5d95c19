// SPDX-License-Identifier: MIT
// Where the quads of a chart stand within its block of slots: in Morton order, so that every 4^j slots that
// start at a multiple of 4^j are a small rectangle of quads. Of a chart that is longer one way, the bits that
// the longer side has more stand on top: the block is a row of squares, and a thin chart does not need a
// block as wide as it is long. Up to the size of these squares all nodes are squares; of 2 or 8 of them the
// block is half a node.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "lodestone/layout/atlas.h"

namespace lodestone::geometry_image {

class QuadOrder {
 public:
  explicit QuadOrder(const layout::ChartRecord& chart)
      : width_(chart.width - 1),
        height_(chart.height - 1),
        common_bits_(
            static_cast<uint32_t>(std::min(std::bit_width(width_ - 1), std::bit_width(height_ - 1)))) {}

  // The block's size: the lowest power of 2 that holds all slots.
  static uint64_t block_slots(const layout::ChartRecord& chart) {
    return uint64_t(1) << (std::bit_width(chart.width - 2) + std::bit_width(chart.height - 2));
  }

  uint32_t slot(uint32_t x, uint32_t y) const {
    const uint32_t low = (1u << common_bits_) - 1;
    const uint32_t above = (x >> common_bits_) | (y >> common_bits_);  // at most one has bits there
    return (above << (2 * common_bits_)) |
           (layout::spread_bits(x & low) | (layout::spread_bits(y & low) << 1));
  }

  struct Quad {
    uint32_t x, y;
    bool exists;  // or else the slot has no quad
  };
  Quad quad(uint32_t slot) const {
    const uint32_t low = slot & uint32_t((uint64_t(1) << (2 * common_bits_)) - 1);
    const auto above = static_cast<uint32_t>(uint64_t(slot) >> (2 * common_bits_) << common_bits_);
    uint32_t x = layout::gather_bits(low), y = layout::gather_bits(low >> 1);
    (width_ >= height_ ? x : y) |= above;
    return {x, y, x < width_ && y < height_};
  }

 private:
  uint32_t width_, height_;  // in quads
  uint32_t common_bits_;
};

}  // namespace lodestone::geometry_image
