// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

namespace lodestone::test {

// The upper one of an even number of values; of at least one.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace lodestone::test
