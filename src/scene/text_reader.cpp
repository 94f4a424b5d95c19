// SPDX-License-Identifier: MIT
#include "lodestone/scene/text_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "lodestone/base/plain_line.h"

namespace lodestone::scene {
namespace {

bool is_line_end(char c) {
  return c == '\n' || c == '\r';
}
bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// std::from_chars knows no leading plus.
std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

template <class T>
bool parse(std::string_view word, T& value) {
  word = without_plus(word);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

TextReader::TextReader(std::string file, std::string_view text, uint64_t first_line, bool continued_lines)
    : file_(std::move(file)), text_(text), line_(first_line), continued_lines_(continued_lines) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (text_.starts_with(byte_order_mark)) position_ = byte_order_mark.size();
}

void TextReader::skip_blanks() {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (is_blank(c)) {
      ++position_;
    } else if (c == '\\' && continued_lines_ && position_ + 1 < text_.size() &&
               is_line_end(text_[position_ + 1])) {
      const bool pair = text_.substr(position_ + 1, 2) == "\r\n";
      position_ += pair ? 3 : 2;
      ++line_;
    } else {
      return;
    }
  }
}

std::string_view TextReader::word() {
  skip_blanks();
  const size_t start = position_;
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (is_blank(c) || is_line_end(c)) break;
    const bool continues =
        c == '\\' && continued_lines_ && position_ + 1 < text_.size() && is_line_end(text_[position_ + 1]);
    if (continues) break;
    ++position_;
  }
  return text_.substr(start, position_ - start);
}

std::string_view TextReader::word_across_lines() {
  for (;;) {
    const std::string_view found = word();
    if (!found.empty() || !next_line()) return found;
  }
}

std::string_view TextReader::rest_of_line() {
  skip_blanks();
  const size_t start = position_;
  while (position_ < text_.size() && !is_line_end(text_[position_])) ++position_;
  size_t end = position_;
  while (end > start && is_blank(text_[end - 1])) --end;
  return text_.substr(start, end - start);
}

bool TextReader::next_line() {
  // Word by word, so that continued lines are left behind too.
  while (!word().empty()) {
  }
  if (position_ == text_.size()) return false;
  position_ += text_.substr(position_, 2) == "\r\n" ? 2 : 1;
  ++line_;
  return true;
}

float TextReader::to_float(std::string_view word, const char* what) const {
  if (word.empty()) fail("{} is missing; the line is cut off or the file damaged, export it again", what);
  float value = 0;
  if (!parse(word, value)) {
    // What is too small for a float becomes zero or denormal; what is too large becomes infinite.
    double wide = 0;
    if (!parse(word, wide))
      fail("{} `{}` is not a number; correct it or export the file again", what, printable(word));
    value = static_cast<float>(wide);
  }
  if (!std::isfinite(value)) {
    fail("{} `{}` is not a finite number; correct it or export the file again", what, printable(word));
  }
  return value;
}

int64_t TextReader::to_integer(std::string_view word, const char* what) const {
  if (word.empty()) fail("{} is missing; the line is cut off or the file damaged, export it again", what);
  int64_t value = 0;
  if (!parse(word, value))
    fail("{} `{}` is not an integer; correct it or export the file again", what, printable(word));
  return value;
}

std::string shown(std::string_view name, size_t longest) {
  size_t end = std::min(longest, name.size());
  // Not between the bytes of one character of UTF-8.
  if (end < name.size()) {
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;
  }
  const std::string text = plain_line(std::string(name.substr(0, end)));
  return end < name.size() ? text + "..." : text;
}

std::string printable(std::string_view text) {
  std::string shown(text.substr(0, 40));
  for (char& c : shown) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text.size() > 40 ? shown + "..." : shown;
}

}  // namespace lodestone::scene
