// SPDX-License-Identifier: MIT
#include "lodestone/image/colour_scale.h"

#include <algorithm>
#include <cmath>

#include "lodestone/image/colour_map.h"
#include "lodestone/image/draw_text.h"
#include "lodestone/image/font.h"

namespace lodestone::image {
namespace {

constexpr float background = 0.1f;
constexpr uint32_t largest_scale = 4;
constexpr uint32_t pixels_a_scale = 400;  // of a picture's width, for letters of the next size

// Lengths in pixels.
struct Strip {
  explicit Strip(uint32_t picture_width)
      : scale(std::clamp(picture_width / pixels_a_scale, 1u, largest_scale)),
        gap(4 * scale),
        line(glyph_height * scale),
        bar(2 * line),
        height(4 * gap + 2 * line + bar) {}
  uint32_t scale, gap, line, bar, height;
};

void draw_bar(Image& picture, Point at, uint32_t width, uint32_t height) {
  for (uint32_t x = 0; x < width; ++x) {
    const Rgb colour = heat((float(x) + 0.5f) / float(width));
    for (size_t c = 0; c < picture.channels.size(); ++c) {
      for (uint32_t y = 0; y < height; ++y)
        picture.channels[c].values[size_t(at.y + y) * picture.width + at.x + x] = colour[c];
    }
  }
}

// Its label centred below its place, moved inwards where it would leave the picture.
void draw_mark(Image& picture, Point bar, uint32_t width, const Strip& strip, const Mark& mark) {
  const auto x = uint32_t(std::lround(std::clamp(mark.place, 0.0f, 1.0f) * float(width - 1)));
  const uint32_t bottom = bar.y + strip.bar;
  for (uint32_t y = bottom; y < bottom + strip.gap / 2; ++y) {
    for (Channel& channel : picture.channels)
      channel.values[size_t(y) * picture.width + bar.x + x] = text_ink;
  }
  const uint32_t length = text_width(mark.label, strip.scale);
  if (length > width) return;
  const uint32_t left = std::min(x - std::min(x, length / 2), width - length);
  draw_text(picture, {bar.x + left, bottom + strip.gap}, mark.label, strip.scale, width);
}

}  // namespace

Image with_colour_scale(const Image& picture, const std::string& title, const std::vector<Mark>& marks) {
  const Strip strip(picture.width);
  Image whole;
  whole.width = picture.width;
  whole.height = picture.height + strip.height;
  whole.linear = picture.linear;
  for (const char* name : {"R", "G", "B"}) {
    std::vector<float>& values = whole.add(name).values;
    const std::vector<float>& above = picture.find(name)->values;
    std::fill(std::copy(above.begin(), above.end(), values.begin()), values.end(), background);
  }
  if (picture.width <= 2 * strip.gap) return whole;
  const uint32_t width = picture.width - 2 * strip.gap;
  const Point text = {strip.gap, picture.height + strip.gap};
  const Point bar = {strip.gap, text.y + strip.line + strip.gap};
  draw_text(whole, text, title, strip.scale, width);
  draw_bar(whole, bar, width, strip.bar);
  for (const Mark& mark : marks) draw_mark(whole, bar, width, strip, mark);
  return whole;
}

}  // namespace lodestone::image
