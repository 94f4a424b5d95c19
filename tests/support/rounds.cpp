// SPDX-License-Identifier: MIT
#include "lodestone/test_support/rounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "lodestone/test_support/median.h"

namespace lodestone::test {

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string spread(const std::vector<double>& values) {
  const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", median(values), *lo, *hi);
}

void Rounds::add(double theirs_s, double ours_s) {
  theirs.push_back(theirs_s);
  ours.push_back(ours_s);
  ratio.push_back(theirs_s / ours_s);
}

}  // namespace lodestone::test
