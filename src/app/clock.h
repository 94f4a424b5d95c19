// SPDX-License-Identifier: MIT
// The host's clock that statistics and profiles are kept in.
#pragma once

#include <chrono>

namespace lodestone::app {

// Milliseconds since the first call, steady.
inline double now_ms() {
  using Clock = std::chrono::steady_clock;
  static const Clock::time_point begin = Clock::now();
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

}  // namespace lodestone::app
