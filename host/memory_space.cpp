// SPDX-License-Identifier: MIT
#include "lodestone/host/memory_space.h"

#include <iterator>

#include "lodestone/host/check.h"

namespace lodestone::host {

MemorySpace::MemorySpace(uint64_t size) : size_(size) {
  if (size > 0) free_[0] = size;
}

std::optional<uint64_t> MemorySpace::take(uint64_t size, uint64_t alignment) {
  for (auto gap = free_.begin(); gap != free_.end(); ++gap) {
    const auto [begin, length] = *gap;
    const uint64_t offset = (begin + alignment - 1) & ~(alignment - 1);
    if (offset + size > begin + length) continue;
    free_.erase(gap);
    if (offset > begin) free_[begin] = offset - begin;
    if (offset + size < begin + length) free_[offset + size] = begin + length - offset - size;
    return offset;
  }
  return std::nullopt;
}

void MemorySpace::give_back(uint64_t offset, uint64_t size) {
  uint64_t begin = offset, end = offset + size;
  auto after = free_.lower_bound(offset);
  require(end <= size_ && (after == free_.end() || after->first >= end), "{} bytes at {} were free already",
          size, offset);
  if (after != free_.begin()) {
    const auto before = std::prev(after);
    require(before->first + before->second <= begin, "{} bytes at {} were free already", size, offset);
    if (before->first + before->second == begin) {
      begin = before->first;
      free_.erase(before);
    }
  }
  if (after != free_.end() && after->first == end) {
    end += after->second;
    free_.erase(after);
  }
  free_[begin] = end - begin;
}

uint64_t MemorySpace::free_bytes() const {
  uint64_t bytes = 0;
  for (const auto& [offset, length] : free_) bytes += length;
  return bytes;
}

}  // namespace lodestone::host
