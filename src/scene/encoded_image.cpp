// SPDX-License-Identifier: MIT
#include "lodestone/scene/encoded_image.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "lodestone/base/error.h"

namespace lodestone::scene {
namespace {

constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";
constexpr std::string_view jpeg_signature = "\xff\xd8\xff";

bool starts_with(std::span<const std::byte> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin(),
                                                    [](char c, std::byte b) { return std::byte(c) == b; });
}

uint32_t big_endian(std::span<const std::byte> bytes, size_t at, size_t count) {
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | std::to_integer<uint32_t>(bytes[at + i]);
  return value;
}

// CRC-32 of ISO 3309, as PNG (annex D) has it.
uint32_t checksum(std::span<const std::byte> bytes) {
  static const std::array<uint32_t, 256> table = [] {
    std::array<uint32_t, 256> entries{};
    for (uint32_t n = 0; n < entries.size(); ++n) {
      uint32_t c = n;
      for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
      entries[n] = c;
    }
    return entries;
  }();
  uint32_t crc = 0xffffffffu;
  for (std::byte b : bytes) crc = table[(crc ^ std::to_integer<uint32_t>(b)) & 0xff] ^ (crc >> 8);
  return ~crc;
}

// The first chunk (11.2.2): type, width, height, bits a sample, kind of colour, three methods. libpng reads
// no longer sides.
void check_png_header(std::span<const std::byte> chunk, const std::string& subject) {
  constexpr uint32_t type = 0x49484452, longest_side = 1000000;
  constexpr size_t size = 17;
  if (chunk.size() != size || big_endian(chunk, 0, 4) != type) {
    fail_input(subject, "is a PNG without a header; copy or export it again");
  }
  const uint32_t width = big_endian(chunk, 4, 4), height = big_endian(chunk, 8, 4);
  const uint32_t bits = big_endian(chunk, 12, 1), color = big_endian(chunk, 13, 1);
  const bool grey = color == 0, palette = color == 3,
             any = grey || palette || color == 2 || color == 4 || color == 6;
  const bool good_bits =
      bits == 8 || (bits == 16 && !palette) || ((grey || palette) && (bits == 1 || bits == 2 || bits == 4));
  const bool good_methods = big_endian(chunk, 14, 2) == 0 && big_endian(chunk, 16, 1) <= 1;
  if (!any || !good_bits || !good_methods || width - 1 >= longest_side || height - 1 >= longest_side) {
    fail_input(subject,
               "is a PNG of {} x {} texels, {} bits and colour type {}, which cannot be read; export "
               "it again",
               width, height, bits, color);
  }
}

void check_png(std::span<const std::byte> bytes, const std::string& subject) {
  constexpr size_t frame = 12;                 // length and type before a chunk's data, checksum behind
  constexpr uint32_t last_chunk = 0x49454e44;  // IEND
  size_t at = png_signature.size();
  while (true) {
    if (at + frame > bytes.size() || big_endian(bytes, at, 4) > bytes.size() - at - frame) {
      fail_input(subject, "is a PNG that is cut short at byte {}; copy or export it again", bytes.size());
    }
    const size_t length = big_endian(bytes, at, 4);
    if (checksum(bytes.subspan(at + 4, length + 4)) != big_endian(bytes, at + 8 + length, 4)) {
      fail_input(subject, "is a PNG that is damaged between bytes {} and {}; copy or export it again", at,
                 at + frame + length);
    }
    if (at == png_signature.size()) check_png_header(bytes.subspan(at + 4, length + 4), subject);
    if (big_endian(bytes, at + 4, 4) == last_chunk) return;
    at += frame + length;
  }
}

// Walks the marker segments to the start of the scan (a thumbnail in one of them has an end marker of its
// own), then looks for the end marker behind the entropy-coded data.
void check_jpeg(std::span<const std::byte> bytes, const std::string& subject) {
  constexpr std::byte escape{0xff}, start_of_scan{0xda}, end_of_image{0xd9};
  size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == escape) {
    const std::byte marker = bytes[at + 1];
    if (marker == escape) {  // fill byte
      ++at;
      continue;
    }
    at += 2 + big_endian(bytes, at + 2, 2);
    if (marker == start_of_scan) break;
  }
  for (; at + 2 <= bytes.size(); ++at) {
    if (bytes[at] == escape && bytes[at + 1] == end_of_image) return;
  }
  fail_input(subject, "is a JPEG that is cut short at byte {}; copy or export it again", bytes.size());
}

}  // namespace

void check_encoded_image(std::span<const std::byte> bytes, const std::string& subject) {
  if (starts_with(bytes, png_signature)) check_png(bytes, subject);
  if (starts_with(bytes, jpeg_signature)) check_jpeg(bytes, subject);
}

}  // namespace lodestone::scene
