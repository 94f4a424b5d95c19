// SPDX-License-Identifier: MIT
#include "lodestone/scene/gltf_uri.h"

#include <array>
#include <cstdint>

#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

constexpr std::string_view data_scheme = "data:";

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// The six bits of each base64 character, -1 for any other.
std::array<int8_t, 256> base64_digits() {
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int8_t, 256> digits{};
  digits.fill(-1);
  for (size_t i = 0; i < alphabet.size(); ++i) digits[static_cast<uint8_t>(alphabet[i])] = int8_t(i);
  return digits;
}

std::optional<std::vector<std::byte>> decode_base64(std::string_view text) {
  static const std::array<int8_t, 256> digits = base64_digits();
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  if (text.size() % 4 == 1) return {};
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int8_t digit = digits[static_cast<uint8_t>(c)];
    if (digit < 0) return {};
    bits = (bits << 6 | uint32_t(digit)) & 0xffffu;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(std::byte(bits >> count & 0xffu));
  }
  return bytes;
}

}  // namespace

std::string percent_decoded(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    const bool escapes = text[i] == '%' && i + 2 < text.size();
    const int high = escapes ? hex_digit(text[i + 1]) : -1, low = escapes ? hex_digit(text[i + 2]) : -1;
    if (high < 0 || low < 0) {
      decoded += text[i];
    } else {
      decoded += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  return decoded;
}

bool is_data_uri(std::string_view uri) {
  return uri.size() >= data_scheme.size() &&
         equal_ignoring_case(uri.substr(0, data_scheme.size()), data_scheme);
}

std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri) {
  constexpr std::string_view base64 = ";base64";
  const size_t comma = uri.find(',');
  if (!is_data_uri(uri) || comma == std::string_view::npos) return {};
  const std::string_view type = uri.substr(0, comma), payload = uri.substr(comma + 1);
  const bool escaped = payload.find('%') != std::string_view::npos;
  const std::string unescaped = escaped ? percent_decoded(payload) : std::string();
  const std::string_view content = escaped ? std::string_view(unescaped) : payload;
  if (type.size() >= base64.size() && equal_ignoring_case(type.substr(type.size() - base64.size()), base64)) {
    return decode_base64(content);
  }
  const auto* first = reinterpret_cast<const std::byte*>(content.data());
  return std::vector<std::byte>(first, first + content.size());
}

}  // namespace lodestone::scene
