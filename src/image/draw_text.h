// SPDX-License-Identifier: MIT
// Text in pictures, in the letters of font.h.
#pragma once

#include <cstdint>
#include <string_view>

#include "lodestone/image/image.h"

namespace lodestone::image {

inline constexpr float text_ink = 0.9f;

struct Point {
  uint32_t x = 0, y = 0;
};

// Pixels from the first column of ink to the last, letters magnified `scale` times.
uint32_t text_width(std::string_view text, uint32_t scale);

// Puts ink into all channels, the upper left corner at `at`; letters that end more than `width` pixels from
// there are left out.
void draw_text(Image& picture, Point at, std::string_view text, uint32_t scale, uint32_t width);

}  // namespace lodestone::image
