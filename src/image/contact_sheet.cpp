// SPDX-License-Identifier: MIT
#include <algorithm>
#include <stdexcept>

#include "lodestone/image/draw_text.h"
#include "lodestone/image/font.h"
#include "lodestone/image/image.h"

namespace lodestone::image {
namespace {

constexpr uint32_t gap = 4;  // pixels around every tile
constexpr float background = 0.1f;
constexpr uint32_t largest_scale = 3;

// The largest whole magnification at which every label fits the width of a tile, at least 1.
uint32_t label_scale(const std::vector<std::string>& labels, uint32_t width) {
  uint32_t scale = largest_scale;
  for (const std::string& label : labels) {
    while (scale > 1 && text_width(label, scale) > width) --scale;
  }
  return scale;
}

void draw_tile(Image& sheet, Point at, const Image& tile) {
  for (Channel& channel : sheet.channels) {
    const std::vector<float>& source = tile.find(channel.name)->values;
    for (uint32_t y = 0; y < tile.height; ++y) {
      std::copy_n(source.begin() + ptrdiff_t(y) * tile.width, tile.width,
                  channel.values.begin() + ptrdiff_t(at.y + y) * sheet.width + at.x);
    }
  }
}

void check_tiles(const std::vector<Image>& tiles, const std::vector<std::string>& labels, uint32_t columns) {
  if (tiles.empty() || columns == 0) throw std::invalid_argument("a contact sheet without tiles");
  if (labels.size() != tiles.size()) throw std::invalid_argument("a contact sheet needs a label a tile");
  for (const Image& tile : tiles) {
    if (tile.width != tiles[0].width || tile.height != tiles[0].height)
      throw std::invalid_argument("tiles of a contact sheet differ in size");
    for (const char* name : {"R", "G", "B"}) {
      const Channel* channel = tile.find(name);
      if (channel == nullptr || channel->values.size() != tile.pixels())
        throw std::invalid_argument("a tile of a contact sheet has no R G B");
    }
  }
}

}  // namespace

Image contact_sheet(const std::vector<Image>& tiles, const std::vector<std::string>& labels,
                    uint32_t columns) {
  check_tiles(tiles, labels, columns);
  const uint32_t width = tiles[0].width, height = tiles[0].height;
  const uint32_t scale = label_scale(labels, width);
  const uint32_t cell_width = width + gap, cell_height = height + glyph_height * scale + 2 * gap;
  const uint32_t across = std::min(columns, uint32_t(tiles.size()));
  const uint32_t down = (uint32_t(tiles.size()) + across - 1) / across;

  Image sheet;
  sheet.width = across * cell_width + gap;
  sheet.height = down * cell_height + gap;
  sheet.linear = tiles[0].linear;
  for (const char* name : {"R", "G", "B"}) {
    std::vector<float>& values = sheet.add(name).values;
    std::fill(values.begin(), values.end(), background);
  }
  for (uint32_t i = 0; i < tiles.size(); ++i) {
    const Point label = {gap + i % across * cell_width, gap + i / across * cell_height};
    draw_text(sheet, label, labels[i], scale, width);
    draw_tile(sheet, {label.x, label.y + glyph_height * scale + gap}, tiles[i]);
  }
  return sheet;
}

}  // namespace lodestone::image
