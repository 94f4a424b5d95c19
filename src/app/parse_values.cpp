// SPDX-License-Identifier: MIT
#include "lodestone/app/parse_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "lodestone/base/error.h"

namespace lodestone::app {
namespace {

template <class... Args>
[[noreturn]] void fail_usage(const std::string& option, fmt::format_string<Args...> format, Args&&... args) {
  fail(ExitCode::usage, option, format, std::forward<Args>(args)...);
}

// Whether all of `text` is one number.
template <class T>
bool read_all(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

// Whether all of `text` is a whole number, lo..hi.
bool read_count(std::string_view text, uint64_t lo, uint64_t hi, uint64_t& value) {
  return read_all(text, value) && value >= lo && value <= hi;
}

}  // namespace

std::string parse_name(const std::string& option, const std::string& text) {
  if (text.empty()) fail_usage(option, "is empty; give a name");
  return text;
}

uint64_t parse_count(const std::string& option, const std::string& text, uint64_t lo, uint64_t hi) {
  uint64_t value = 0;
  if (!read_count(text, lo, hi, value))
    fail_usage(option, "`{}` is not a whole number from {} to {}", text, lo, hi);
  return value;
}

double parse_number(const std::string& option, const std::string& text, double lo, double hi) {
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  if (!read_all(digits, value) || !std::isfinite(value))
    fail_usage(option, "`{}` is not a finite number", text);
  if (value < lo || value > hi) fail_usage(option, "`{}` is not between {} and {}", text, lo, hi);
  return value;
}

uint64_t parse_bytes(const std::string& option, const std::string& text) {
  constexpr std::string_view units = "KMGT";
  const size_t unit = text.empty() ? std::string_view::npos : units.find(text.back());
  const uint32_t shift = unit == std::string_view::npos ? 0 : 10 * (static_cast<uint32_t>(unit) + 1);
  const std::string_view digits = std::string_view(text).substr(0, text.size() - (shift > 0 ? 1 : 0));
  uint64_t count = 0;
  if (!read_count(digits, 1, (uint64_t(1) << 50) >> shift, count))
    fail_usage(option, "`{}` is not a number of bytes like 800M or 2G", text);
  return count << shift;
}

Size parse_size(const std::string& option, const std::string& text) {
  const size_t cross = text.find('x');
  const std::string_view view = text;
  uint64_t width = 0, height = 0;
  if (cross == std::string::npos || !read_count(view.substr(0, cross), 1, max_side, width) ||
      !read_count(view.substr(cross + 1), 1, max_side, height))
    fail_usage(option, "`{}` is not WIDTHxHEIGHT, each from 1 to {}, e.g. 640x360", text, max_side);
  if (width * height > max_pixels)
    fail_usage(option, "`{}` has {} pixels, more than the {} that a picture may have", text, width * height,
               max_pixels);
  return {uint32_t(width), uint32_t(height)};
}

FrameRange parse_frames(const std::string& option, const std::string& text) {
  const size_t dash = text.find('-');
  const std::string_view view = text;
  uint64_t first = 0, last = 0;
  bool good = read_count(view.substr(0, dash), 0, max_frame, first);
  last = first;
  if (dash != std::string::npos) good = good && read_count(view.substr(dash + 1), 0, max_frame, last);
  if (!good) fail_usage(option, "`{}` is neither a frame nor FIRST-LAST, each from 0 to {}", text, max_frame);
  if (first > last) fail_usage(option, "`{}` ends before it begins; write the smaller frame first", text);
  return {uint32_t(first), uint32_t(last)};
}

std::vector<std::string> parse_list(const std::string& option, const std::string& text) {
  std::vector<std::string> items;
  size_t begin = 0;
  while (true) {
    const size_t end = std::min(text.find(',', begin), text.size());
    std::string item = text.substr(begin, end - begin);
    // Blanks beside a comma mean nothing.
    item.erase(0, std::min(item.find_first_not_of(' '), item.size()));
    item.erase(item.find_last_not_of(' ') + 1);
    if (item.empty()) fail_usage(option, "`{}` has an empty place in its list", text);
    if (std::find(items.begin(), items.end(), item) != items.end())
      fail_usage(option, "`{}` stands twice in the list", item);
    items.push_back(item);
    if (end == text.size()) return items;
    begin = end + 1;
  }
}

std::map<std::string, float> parse_weights(const std::string& option, const std::string& text) {
  std::map<std::string, float> weights;
  constexpr double limit = std::numeric_limits<float>::max();
  for (const std::string& item : parse_list(option, text)) {
    const size_t equals = item.find('=');
    if (equals == std::string::npos || equals == 0) fail_usage(option, "`{}` is not NAME=NUMBER", item);
    const std::string name = item.substr(0, equals);
    const float weight = float(parse_number(option, item.substr(equals + 1), -limit, limit));
    if (!weights.emplace(name, weight).second) fail_usage(option, "the weight `{}` is given twice", name);
  }
  return weights;
}

std::string parse_choice(const std::string& option, const std::string& text,
                         const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), text) == known.end())
    fail_usage(option, "there is no `{}`; there is {}", text, join_names(known));
  return text;
}

std::string join_names(const std::vector<std::string>& names) {
  std::string joined;
  for (size_t i = 0; i < names.size(); ++i)
    joined += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return joined;
}

}  // namespace lodestone::app
