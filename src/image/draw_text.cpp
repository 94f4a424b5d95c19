// SPDX-License-Identifier: MIT
#include "lodestone/image/draw_text.h"

#include "lodestone/image/font.h"

namespace lodestone::image {

uint32_t text_width(std::string_view text, uint32_t scale) {
  return text.empty() ? 0 : (uint32_t(text.size()) * (glyph_width + 1) - 1) * scale;
}

void draw_text(Image& picture, Point at, std::string_view text, uint32_t scale, uint32_t width) {
  for (size_t i = 0; i < text.size(); ++i) {
    const uint32_t left = uint32_t(i) * (glyph_width + 1) * scale;
    if (left + glyph_width * scale > width) return;
    for (uint32_t y = 0; y < glyph_height * scale; ++y) {
      for (uint32_t x = 0; x < glyph_width * scale; ++x) {
        if (!glyph_ink(text[i], x / scale, y / scale)) continue;
        const size_t pixel = size_t(at.y + y) * picture.width + at.x + left + x;
        for (Channel& channel : picture.channels) channel.values[pixel] = text_ink;
      }
    }
  }
}

}  // namespace lodestone::image
