// SPDX-License-Identifier: MIT
// Walks the chunks of a PNG (ISO/IEC 15948, clause 5): length, type, data, CRC-32 of type and data.
#include "lodestone/image/png_check.h"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/image/image.h"

namespace lodestone::image {
namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);

// By the first four bytes, as far as there are any: the rest of the signature is there to notice damage.
bool begins_as_png(const std::filesystem::path& path) {
  char start[4];
  std::ifstream stream(path, std::ios::binary);
  stream.read(start, sizeof start);
  const std::string_view read(start, size_t(stream.gcount()));
  return !read.empty() && signature.starts_with(read);
}

uint32_t big_endian(std::span<const std::byte> bytes) {
  return uint32_t(bytes[0]) << 24 | uint32_t(bytes[1]) << 16 | uint32_t(bytes[2]) << 8 | uint32_t(bytes[3]);
}

// Four letters, or hexadecimal digits where they are none: a damaged name must not reach a terminal as it is.
std::string printable(std::span<const std::byte> type) {
  std::string text;
  for (const std::byte byte : type) text += char(byte);
  const bool letters =
      std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
  return letters ? text : fmt::format("0x{:08x}", big_endian(type));
}

// `header`: width and height. libpng prints about sizes beyond its own limits.
void check_size(const std::string& name, std::span<const std::byte> header) {
  const uint64_t width = big_endian(header), height = big_endian(header.subspan(4));
  if (width * height > max_samples)
    fail_input(name, "claims {} x {} pixels, more than the {} samples that are read", width, height,
               max_samples);
  if (width * height == 0) fail_input(name, "has no pixels");
}

}  // namespace

void check_png(const std::filesystem::path& path) {
  if (!begins_as_png(path)) return;
  const std::vector<std::byte> file = read_file(path);
  const std::string name = path.string();
  if (std::memcmp(file.data(), signature.data(), std::min(file.size(), signature.size())) != 0)
    fail_input(name, "is damaged: the signature of a PNG is wrong; was it copied as text?");
  constexpr size_t frame = 12;  // length, type and checksum
  size_t at = signature.size();
  for (;;) {
    if (at > file.size() || file.size() - at < frame)
      fail_input(name, "is cut short at byte {}, before the end of the PNG; copy or render it again",
                 file.size());
    const size_t length = big_endian(std::span(file).subspan(at, 4));
    const std::span<const std::byte> type = std::span(file).subspan(at + 4, 4);
    if (file.size() - at - frame < length)
      fail_input(name, "is cut short at byte {}, within the PNG chunk {}; copy or render it again",
                 file.size(), printable(type));
    const auto* checked = reinterpret_cast<const Bytef*>(type.data());
    if (crc32_z(0, checked, length + 4) != big_endian(std::span(file).subspan(at + 8 + length, 4)))
      fail_input(name,
                 "is damaged: the PNG chunk {} at byte {} has a wrong checksum; copy or render it again",
                 printable(type), at);
    if (printable(type) == "IHDR" && length >= 8) check_size(name, std::span(file).subspan(at + 8, 8));
    if (printable(type) == "IEND") return;
    at += frame + length;
  }
}

}  // namespace lodestone::image
