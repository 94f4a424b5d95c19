// SPDX-License-Identifier: MIT
// Text of others on its way to a terminal.
#pragma once

#include <string>

namespace lodestone {

// On one line, whatever the names of files and of what they hold: control characters of ASCII and, as UTF-8,
// of Latin-1, which could move a terminal's cursor or worse, become `?`. Everything else stays.
std::string plain_line(std::string text);

}  // namespace lodestone
