// SPDX-License-Identifier: MIT
// Loading what must be refused, quickly and without much memory.
#pragma once

#include <gtest/gtest.h>

#include <ctime>

#include "allocation_count.h"
#include "gltf_builder.h"

namespace lodestone::scene {

// More than any file of these tests can mean; the limit of AccessorReader for a tiny file is 64 MiB.
inline constexpr size_t max_hostile_bytes = size_t(200) << 20;
// Code that checks its every access is some times slower.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr double max_hostile_seconds = 4;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr double max_hostile_seconds = 4;
#else
inline constexpr double max_hostile_seconds = 1;
#endif
#else
inline constexpr double max_hostile_seconds = 1;
#endif

// Of this process, so that a busy machine does not matter.
inline double cpu_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

// Expects Error(bad_input) within a second of computing and 200 MiB; the message.
inline std::string expect_refused(const std::filesystem::path& path) {
  reset_peak();
  const size_t held = current_allocation();
  const double begin = cpu_seconds();
  const std::string message = expect_bad_input(path);
  EXPECT_LT(cpu_seconds() - begin, max_hostile_seconds);
  EXPECT_LT(peak_allocation() - held, max_hostile_bytes);
  return message;
}

}  // namespace lodestone::scene
