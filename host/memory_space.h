// SPDX-License-Identifier: MIT
// Which bytes of a block of memory are free. Knows no Vulkan.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace lodestone::host {

class MemorySpace {
 public:
  explicit MemorySpace(uint64_t size);

  // The offset of `size` free bytes at a multiple of `alignment` (a power of two); the first that fit.
  std::optional<uint64_t> take(uint64_t size, uint64_t alignment);
  // Gives back what take() gave for the same size. Throws std::logic_error where that was free already.
  void give_back(uint64_t offset, uint64_t size);

  uint64_t size() const { return size_; }
  uint64_t free_bytes() const;
  bool is_empty() const { return free_bytes() == size_; }

 private:
  uint64_t size_;
  std::map<uint64_t, uint64_t> free_;  // offset to length; no two touch
};

}  // namespace lodestone::host
