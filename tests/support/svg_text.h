// SPDX-License-Identifier: MIT
// What the plots are written with.
#pragma once

#include <fmt/format.h>

#include <string>

namespace lodestone::test {

inline std::string svg_escaped(const std::string& text) {
  std::string safe;
  for (const char c : text)
    safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return safe;
}

// `anchor`: start, middle or end; `more`: further attributes, each with a space before it.
inline std::string svg_text(double x, double y, const char* anchor, const std::string& words,
                            const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                     svg_escaped(words));
}

// A white page of this many pixels and what is on it.
inline std::string svg_document(double width, double height, const std::string& content) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
             "height=\"{1:g}\" "
             "font-family=\"sans-serif\" font-size=\"12\">\n<path d=\"M0 0h{0:g}v{1:g}h-{0:g}z\" "
             "fill=\"#fff\"/>\n",
             width, height) +
         content + "</svg>\n";
}

}  // namespace lodestone::test
