// SPDX-License-Identifier: MIT
// The values of options, from text. Each throws Error(usage) that names the option, what was given and what
// is wanted.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::app {

// The most pixels of a picture: with R G B A, as many samples as an image file may hold to be read back.
inline constexpr uint64_t max_pixels = uint64_t(1) << 26;
inline constexpr uint32_t max_side = 65536;
inline constexpr uint32_t max_frame = 9999999;

// Any text but none: an empty name would be taken for an option that was not given.
std::string parse_name(const std::string& option, const std::string& text);
// A whole number without sign, lo..hi.
uint64_t parse_count(const std::string& option, const std::string& text, uint64_t lo, uint64_t hi);
// A finite decimal number, lo..hi.
double parse_number(const std::string& option, const std::string& text, double lo, double hi);

// A whole number of bytes, at least 1; or of KiB, MiB, GiB, TiB with K, M, G or T behind it.
uint64_t parse_bytes(const std::string& option, const std::string& text);

struct Size {
  uint32_t width = 512, height = 512;
};
// WxH, each 1..max_side, the product at most max_pixels.
Size parse_size(const std::string& option, const std::string& text);

struct FrameRange {
  uint32_t first = 0, last = 0;
  uint32_t count() const { return last - first + 1; }
};
// A-B with A <= B, or A alone; up to max_frame.
FrameRange parse_frames(const std::string& option, const std::string& text);

// NAME=X,NAME=X,... A name may hold anything but `=` and `,`; none is given twice.
std::map<std::string, float> parse_weights(const std::string& option, const std::string& text);

// A,B,... none empty, none twice.
std::vector<std::string> parse_list(const std::string& option, const std::string& text);

// `text` where it is one of `known`, else an error that lists them.
std::string parse_choice(const std::string& option, const std::string& text,
                         const std::vector<std::string>& known);

// "a, b and c"
std::string join_names(const std::vector<std::string>& names);

}  // namespace lodestone::app
