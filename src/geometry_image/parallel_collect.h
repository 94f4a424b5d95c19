// SPDX-License-Identifier: MIT
// Lists that many threads write and that come out in order all the same.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/parallel.h"

namespace lodestone::geometry_image {

// Calls emit(i, list) for i in [0, count); it may push to the list. Returns the lists of ascending i, joined.
// The number of threads does not show.
template <class Value, class Emit>
std::vector<Value> parallel_collect(uint64_t count, const Emit& emit) {
  constexpr uint64_t block = 1u << 16;
  std::vector<std::vector<Value>> lists((count + block - 1) / block);
  parallel_for(count, block, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) emit(i, lists[begin / block]);
  });
  size_t total = 0;
  for (const std::vector<Value>& list : lists) total += list.size();
  std::vector<Value> joined;
  joined.reserve(total);
  for (std::vector<Value>& list : lists) {
    joined.insert(joined.end(), list.begin(), list.end());
    list = {};
  }
  return joined;
}

}  // namespace lodestone::geometry_image
