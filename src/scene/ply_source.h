// SPDX-License-Identifier: MIT
// The values behind the header of a PLY file, one after another, in either of its encodings.
#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "lodestone/base/error.h"
#include "lodestone/scene/ply_header.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene::ply {

// A source has these members:
//   double value(Type)          the next value; throws Error(bad_input) where the data end
//   void skip(uint64_t, Type)   passes over so many values
//   std::string place()         where the next value stands, for messages

class AsciiSource {
 public:
  AsciiSource(const std::string& file, std::string_view bytes, const Header& header)
      : reader_(file, bytes.substr(header.body), header.body_line) {}

  double value(Type) {
    const std::string_view word = next();
    double number = 0;
    const char* first = word.data() + (word.size() > 1 && word[0] == '+' ? 1 : 0);
    const auto [end, error] = std::from_chars(first, word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) {
      reader_.fail("`{}` is not a number; correct it or export the file again", printable(word));
    }
    return number;
  }

  void skip(uint64_t count, Type) {
    for (uint64_t i = 0; i < count; ++i) next();
  }

  std::string place() const { return fmt::format("line {}", reader_.line()); }

 private:
  std::string_view next() {
    const std::string_view word = reader_.word_across_lines();
    if (word.empty()) reader_.fail("the file ends before all of its elements; get the whole file");
    return word;
  }

  TextReader reader_;
};

template <std::endian order>
class BinarySource {
 public:
  BinarySource(const std::string& file, std::string_view bytes, const Header& header)
      : file_(file), bytes_(bytes), position_(header.body) {}

  double value(Type type) {
    switch (type) {
      case Type::int8:
        return read<int8_t>();
      case Type::uint8:
        return read<uint8_t>();
      case Type::int16:
        return read<int16_t>();
      case Type::uint16:
        return read<uint16_t>();
      case Type::int32:
        return read<int32_t>();
      case Type::uint32:
        return read<uint32_t>();
      case Type::float32:
        return read<float>();
      case Type::float64:
        break;
    }
    return read<double>();
  }

  void skip(uint64_t count, Type type) {
    if (count > (bytes_.size() - position_) / size_of(type)) fail_truncated();
    position_ += count * size_of(type);
  }

  std::string place() const { return fmt::format("byte {}", position_); }

 private:
  template <class T>
  T read() {
    if (bytes_.size() - position_ < sizeof(T)) fail_truncated();
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + position_, sizeof(T));
    if constexpr (order != std::endian::native) std::reverse(raw, raw + sizeof(T));
    position_ += sizeof(T);
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

  [[noreturn]] void fail_truncated() const {
    fail_input(file_, "byte {}: the file ends before all of its elements; get the whole file", bytes_.size());
  }

  const std::string& file_;
  std::string_view bytes_;
  uint64_t position_;
};

}  // namespace lodestone::scene::ply
