// SPDX-License-Identifier: MIT
#include "lodestone/base/plain_line.h"

namespace lodestone {

std::string plain_line(std::string text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  for (size_t i = 0; i < text.size(); ++i) {
    // U+0080 to U+009F are the bytes c2 80 to c2 9f; some terminals take 9b for an escape sequence.
    const bool latin_1 = byte(i) == 0xc2 && i + 1 < text.size() && byte(i + 1) >= 0x80 && byte(i + 1) < 0xa0;
    if (latin_1) text.erase(i, 1);
    if (latin_1 || byte(i) < ' ' || byte(i) == 0x7f) text[i] = '?';
  }
  return text;
}

}  // namespace lodestone
