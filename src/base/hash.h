// SPDX-License-Identifier: MIT
// Content hashes: the keys of baked files and pipeline caches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace lodestone {

// A 128-bit XXH3 hash over everything that was added, in order.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void add(std::span<const std::byte> bytes);
  void add(const std::string& text);  // with its length
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void add_value(const T& value) { add(std::as_bytes(std::span(&value, 1))); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void add_array(const std::vector<T>& values) {  // with its length
    add_value(uint64_t(values.size()));
    add(std::as_bytes(std::span(values)));
  }
  std::string hex() const;  // 32 hexadecimal digits

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lodestone
