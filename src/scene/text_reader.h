// SPDX-License-Identifier: MIT
// Words and numbers of a text file, with the line that each stands on.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "lodestone/base/error.h"

namespace lodestone::scene {

// The bytes as characters; they must outlive the view.
inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Equal but for the case of ASCII letters.
bool equal_ignoring_case(std::string_view a, std::string_view b);

// Reads words that blanks separate, forward only. Lines end with \n, \r\n or \r. A byte order mark is
// passed over. The text must outlive the reader.
class TextReader {
 public:
  // `file` is the name in messages, `first_line` the number of the line on which `text` begins.
  // With `continued_lines` a backslash before the end of a line joins it to the next one.
  TextReader(std::string file, std::string_view text, uint64_t first_line = 1, bool continued_lines = false);

  // The next word of the current line; empty at the end of the line.
  std::string_view word();
  // The next word of this or a later line; empty at the end of the text.
  std::string_view word_across_lines();
  // The rest of the current line without the blanks around it.
  std::string_view rest_of_line();
  // Goes to the start of the next line; false at the end of the text.
  bool next_line();

  bool at_end() const { return position_ == text_.size(); }
  uint64_t line() const { return line_; }
  const std::string& file() const { return file_; }

  // The number that `word` spells in full: finite, within the range of a float, rounded to the nearest.
  // Throws Error(bad_input), calling it `what`, where it is none or the word is empty.
  float to_float(std::string_view word, const char* what) const;
  // A decimal integer, a `+` or `-` before it or not. Throws likewise.
  int64_t to_integer(std::string_view word, const char* what) const;
  float read_float(const char* what) { return to_float(word(), what); }

  // Throws Error(bad_input): `FILE: line N: ...`.
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    fail_input(file_, "line {}: {}", line_, fmt::format(format, std::forward<Args>(args)...));
  }

 private:
  void skip_blanks();

  std::string file_;
  std::string_view text_;
  size_t position_ = 0;
  uint64_t line_;
  bool continued_lines_;
};

// A name from a file for a message: cut to `longest` bytes, control characters shown as `?`, so that it stays
// on its line and does nothing to the terminal.
std::string shown(std::string_view name, size_t longest = 80);

// Text of a hostile file for a message: cut to 40 characters, anything but printable ASCII shown as `?`.
std::string printable(std::string_view text);

}  // namespace lodestone::scene
