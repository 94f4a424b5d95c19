// SPDX-License-Identifier: MIT
// A bitmap font for labels, so that a picture with text needs no font file: ASCII 32 to 126, drawn in 5 x 7
// cells.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace lodestone::image {

inline constexpr uint32_t glyph_width = 5;  // without the column that separates two glyphs
inline constexpr uint32_t glyph_height = 7;

// Sixteen glyphs a line of text, six columns a glyph; `#` is ink. The seven rows of glyph c start at row
// 7 * ((c - 32) / 16), column 6 * ((c - 32) % 16).
inline constexpr std::array<std::string_view, 42> glyph_rows = {
    //       !     "     #     $     %     &     '     (     )     *     +     ,     -     .     /
    "        #    # #   # #    #   ##  #  ##     #      #   #                                      #",
    "        #    # #   # #   #### ## #  #  #    #     #     #   # # #   #                        # ",
    "        #         ##### # #      #  # #          #       #   ###    #                        # ",
    "        #          # #   ###    #    #           #       #  ##### #####       #####         #  ",
    "        #         #####   # #  #    # # #        #       #   ###    #     #                #   ",
    "                   # #  ####   # ## #  #          #     #   # # #   #     #          ##    #   ",
    "        #          # #    #   #  ##  ## #          #   #                 #           ##   #    ",
    // 0     1     2     3     4     5     6     7     8     9     :     ;     <     =     >     ?
    " ###    #    ###   ###     #  #####   ##  #####  ###   ###                 #         #     ### ",
    "#   #  ##   #   # #   #   ##  #      #        # #   # #   #  ##     #     #           #   #   #",
    "#  ##   #       #     #  # #  ####  #        #  #   # #   #  ##     #    #    #####    #      #",
    "# # #   #     ##    ##  #  #      # ####    #    ###   ####             #               #    # ",
    "##  #   #    #        # #####     # #   #   #   #   #     #  ##     #    #    #####    #    #  ",
    "#   #   #   #     #   #    #  #   # #   #  #    #   #    #   ##     #     #           #        ",
    " ###   ###  #####  ###     #   ###   ###   #     ###   ##          #       #         #      #  ",
    // @     A     B     C     D     E     F     G     H     I     J     K     L     M     N     O
    " ###    #   ####   ###  ####  ##### #####  ###  #   #  ###    ### #   # #     #   # #   #  ### ",
    "#   #  # #  #   # #   # #   # #     #     #   # #   #   #      #  #  #  #     ## ## ##  # #   #",
    "# ### #   # #   # #     #   # #     #     #     #   #   #      #  # #   #     # # # ##  # #   #",
    "# # # #   # ####  #     #   # ####  ####  # ### #####   #      #  ##    #     # # # # # # #   #",
    "# ### ##### #   # #     #   # #     #     #   # #   #   #      #  # #   #     #   # #  ## #   #",
    "#     #   # #   # #   # #   # #     #     #   # #   #   #   #  #  #  #  #     #   # #  ## #   #",
    " ###  #   # ####   ###  ####  ##### #      ###  #   #  ###   ##   #   # ##### #   # #   #  ### ",
    // P     Q     R     S     T     U     V     W     X     Y     Z     [     \     ]     ^     _
    "####   ###  ####   #### ##### #   # #   # #   # #   # #   # #####  ###  #      ###    #        ",
    "#   # #   # #   # #       #   #   # #   # #   # #   # #   #     #  #     #       #   # #       ",
    "#   # #   # #   # #       #   #   # #   # #   #  # #   # #     #   #     #       #  #   #      ",
    "####  #   # ####   ###    #   #   # #   # # # #   #     #     #    #      #      #             ",
    "#     # # # # #       #   #   #   #  # #  # # #  # #    #    #     #       #     #             ",
    "#     #  #  #  #      #   #   #   #  # #  ## ## #   #   #   #      #       #     #             ",
    "#      ## # #   # ####    #    ###    #   #   # #   #   #   #####  ###      #  ###        #####",
    // `     a     b     c     d     e     f     g     h     i     j     k     l     m     n     o
    " #          #               #         ##        #       #      #  #      ##                    ",
    "  #         #               #        #     #### #                 #       #                    ",
    "       ###  ####   ####  ####  ###   #    #   # ####   ##     ##  #  #    #   ####  ####   ### ",
    "          # #   # #     #   # #   # ####  #   # #   #   #      #  # #     #   # # # #   # #   #",
    "       #### #   # #     #   # #####  #     #### #   #   #      #  ##      #   # # # #   # #   #",
    "      #   # #   # #     #   # #      #        # #   #   #   #  #  # #     #   # # # #   # #   #",
    "       #### ####   ####  ####  ###   #     ###  #   #  ###   ##   #  #   ###  # # # #   #  ### ",
    // p     q     r     s     t     u     v     w     x     y     z     {     |     }     ~
    "                         #                                          ##    #    ##              ",
    "####   ####              #                            #   #         #     #     #              ",
    "#   # #   # # ##   #### ####  #   # #   # #   # #   # #   # #####   #     #     #    #  #      ",
    "#   # #   # ##  # #      #    #   # #   # # # #  # #  #   #    #   #      #      #  # # #      ",
    "####   #### #      ###   #    #   # #   # # # #   #    ####   #     #     #     #   #  #       ",
    "#         # #         #  #  # #   #  # #  # # #  # #      #  #      #     #     #              ",
    "#         # #     ####    ##   ####   #    # #  #   #  ###  #####   ##    #    ##              ",
};

// Whether column x (below glyph_width) of row y (below glyph_height) of a character is ink; '?' stands for
// any character without a glyph.
constexpr bool glyph_ink(char character, uint32_t x, uint32_t y) {
  const uint32_t glyph = (character < 32 || character > 126 ? '?' : uint32_t(character)) - 32;
  return glyph_rows[glyph_height * (glyph / 16) + y][(glyph_width + 1) * (glyph % 16) + x] == '#';
}

}  // namespace lodestone::image
