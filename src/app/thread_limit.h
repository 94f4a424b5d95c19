// SPDX-License-Identifier: MIT
// --threads, for everything that runs on the CPU.
#pragma once

#include <cstdint>

#include "lodestone/base/parallel.h"

namespace lodestone::app {

// While it lives, at most `threads` threads work; 0: as many as there are cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(uint32_t threads) { set_thread_count(threads); }
  ~ThreadLimit() { set_thread_count(0); }
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;
};

}  // namespace lodestone::app
