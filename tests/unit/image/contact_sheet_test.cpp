// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include "lodestone/image/font.h"
#include "lodestone/image/image.h"
#include "pictures.h"

namespace lodestone::image {
namespace {

uint64_t pixels_of(const Image& image, float value) {
  const std::vector<float>& values = image.find("R")->values;
  return uint64_t(std::count(values.begin(), values.end(), value));
}

TEST(ContactSheet, ShowsEveryTileWhole) {
  const std::vector<Image> tiles = {plain(40, 30, 0.2f, 0, 0), plain(40, 30, 0.3f, 0, 0),
                                    plain(40, 30, 0.4f, 0, 0)};
  const Image sheet = contact_sheet(tiles, {"a", "b", "c"}, 2);
  for (const float red : {0.2f, 0.3f, 0.4f}) EXPECT_EQ(pixels_of(sheet, red), 40u * 30u) << red;
  EXPECT_GT(sheet.width, 80u);
  EXPECT_LT(sheet.width, 120u);
  EXPECT_GT(sheet.height, 60u);
}

TEST(ContactSheet, IsNoWiderThanItsTiles) {
  const Image one = contact_sheet({plain(40, 30, 0, 0, 0)}, {""}, 1);
  const Image wide = contact_sheet({plain(40, 30, 0, 0, 0)}, {""}, 100);
  EXPECT_EQ(one.width, wide.width);
}

TEST(ContactSheet, LabelsAreDrawnAndEqualOnlyForEqualText) {
  const auto with_label = [](const std::string& label) {
    return contact_sheet({plain(64, 8, 0, 0, 0)}, {label}, 1).find("R")->values;
  };
  EXPECT_NE(with_label("bvh"), with_label(""));
  EXPECT_NE(with_label("bvh"), with_label("rlod"));
  EXPECT_EQ(with_label("bvh"), with_label("bvh"));
  EXPECT_EQ(with_label("\x01\xff"), with_label("??"));
}

TEST(ContactSheet, LongLabelsAreCutAtTheirTile) {
  const Image sheet =
      contact_sheet({plain(20, 10, 0.5f, 0, 0), plain(20, 10, 0.6f, 0, 0)}, {std::string(1000, 'M'), ""}, 2);
  EXPECT_EQ(pixels_of(sheet, 0.5f), 200u);
  EXPECT_EQ(pixels_of(sheet, 0.6f), 200u);
  // No ink above the second tile: the first rows are background.
  const std::vector<float>& red = sheet.find("R")->values;
  for (uint32_t y = 0; y < 5; ++y) {
    for (uint32_t x = sheet.width / 2; x < sheet.width; ++x)
      EXPECT_EQ(red[size_t(y) * sheet.width + x], red[0]) << x << ' ' << y;
  }
  EXPECT_NE(red[size_t(4) * sheet.width + 4], red[0]);  // the M begins in the corner
}

TEST(ContactSheet, RefusesWhatItCannotShow) {
  const Image tile = plain(4, 4, 0, 0, 0);
  Image no_colour;
  no_colour.width = no_colour.height = 4;
  no_colour.add("depth.Z");
  EXPECT_THROW(contact_sheet({}, {}, 1), std::invalid_argument);
  EXPECT_THROW(contact_sheet({tile}, {}, 1), std::invalid_argument);
  EXPECT_THROW(contact_sheet({tile}, {"a"}, 0), std::invalid_argument);
  EXPECT_THROW(contact_sheet({tile, plain(4, 5, 0, 0, 0)}, {"a", "b"}, 1), std::invalid_argument);
  EXPECT_THROW(contact_sheet({no_colour}, {"a"}, 1), std::invalid_argument);
}

TEST(Font, EveryPrintableCharacterHasAGlyphOfItsOwn) {
  std::set<std::string> glyphs;
  for (char character = 32; character < 127; ++character) {
    std::string glyph;
    for (uint32_t y = 0; y < glyph_height; ++y) {
      for (uint32_t x = 0; x < glyph_width; ++x) glyph += glyph_ink(character, x, y) ? '#' : ' ';
    }
    EXPECT_EQ(glyph.find('#') == std::string::npos, character == ' ') << character;
    EXPECT_TRUE(glyphs.insert(glyph).second) << character << " looks like another";
  }
}

TEST(Font, ColumnsBetweenGlyphsAreBlank) {
  for (const std::string_view row : glyph_rows) {
    ASSERT_EQ(row.size(), 16u * (glyph_width + 1) - 1);
    for (size_t x = glyph_width; x < row.size(); x += glyph_width + 1) EXPECT_EQ(row[x], ' ');
  }
}

}  // namespace
}  // namespace lodestone::image
