// SPDX-License-Identifier: MIT
// The fields of a baked file, little-endian, one after the other.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "lodestone/base/error.h"

namespace lodestone::geometry_image {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they lie in memory");

class ByteWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void number(T value) { bytes(std::as_bytes(std::span(&value, 1))); }
  void text(const std::string& value) {  // with its length
    number(static_cast<uint32_t>(value.size()));
    bytes(std::as_bytes(std::span(value)));
  }
  void bytes(std::span<const std::byte> more) {
    if (more.empty()) return;
    const size_t end = written_.size();
    written_.resize(end + more.size());
    std::memcpy(&written_[end], more.data(), more.size());
  }

  const std::vector<std::byte>& written() const { return written_; }
  std::vector<std::byte> take() { return std::move(written_); }

 private:
  std::vector<std::byte> written_;
};

// Reads what a ByteWriter wrote and trusts none of it: every read throws Error(bad_input) where the bytes do
// not suffice.
class ByteReader {
 public:
  // Keeps a view of `all`. `file` names it in errors.
  ByteReader(std::string file, std::span<const std::byte> all) : file_(std::move(file)), rest_(all) {}

  template <class T>
  requires std::is_arithmetic_v<T> T number() {
    T value;
    std::memcpy(&value, bytes(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string text(uint32_t longest) {
    const auto length = number<uint32_t>();
    if (length > longest) fail("a text is too long");
    const std::span<const std::byte> read = bytes(length);
    return {reinterpret_cast<const char*>(read.data()), read.size()};
  }
  std::span<const std::byte> bytes(uint64_t count) {
    if (count > rest_.size()) fail("it is cut short");
    const std::span<const std::byte> read = rest_.first(count);
    rest_ = rest_.subspan(count);
    return read;
  }
  bool at_end() const { return rest_.empty(); }

  [[noreturn]] void fail(const char* what) const { fail_input(file_, "is damaged: {}; bake it again", what); }

 private:
  std::string file_;
  std::span<const std::byte> rest_;
};

}  // namespace lodestone::geometry_image
