// SPDX-License-Identifier: MIT
#include "lodestone/host/memory_space.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <stdexcept>

namespace lodestone::host {
namespace {

TEST(MemorySpace, GivesAlignedPiecesUntilItIsFull) {
  MemorySpace space(256);
  EXPECT_EQ(space.take(10, 1), 0u);
  EXPECT_EQ(space.take(100, 64), 64u);
  EXPECT_EQ(space.take(54, 1), 10u);  // the gap that alignment left
  EXPECT_EQ(space.take(92, 4), 164u);
  EXPECT_EQ(space.take(1, 1), std::nullopt);
  EXPECT_EQ(space.free_bytes(), 0u);
}

TEST(MemorySpace, JoinsWhatIsGivenBack) {
  MemorySpace space(90);
  for (uint64_t i = 0; i < 3; ++i) ASSERT_EQ(space.take(30, 1), i * 30);
  space.give_back(0, 30);
  space.give_back(60, 30);
  EXPECT_EQ(space.take(40, 1), std::nullopt);
  space.give_back(30, 30);
  EXPECT_TRUE(space.is_empty());
  EXPECT_EQ(space.take(90, 1), 0u);
}

TEST(MemorySpace, NoticesWhatIsGivenBackTwice) {
  MemorySpace space(64);
  space.take(16, 16);
  space.take(16, 16);
  space.give_back(0, 16);
  EXPECT_THROW(space.give_back(0, 16), std::logic_error);
  EXPECT_THROW(space.give_back(8, 16), std::logic_error);
  EXPECT_THROW(space.give_back(60, 16), std::logic_error);
}

TEST(MemorySpace, NeverGivesAByteTwice) {
  constexpr uint64_t size = 4096;
  MemorySpace space(size);
  std::map<uint64_t, uint64_t> taken;
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    if (random() % 2 == 0 || taken.empty()) {
      const uint64_t length = 1 + random() % 200, alignment = uint64_t(1) << random() % 8;
      const std::optional<uint64_t> offset = space.take(length, alignment);
      if (!offset) continue;
      ASSERT_EQ(*offset % alignment, 0u);
      ASSERT_LE(*offset + length, size);
      const auto after = taken.lower_bound(*offset);
      ASSERT_TRUE(after == taken.end() || after->first >= *offset + length);
      ASSERT_TRUE(after == taken.begin() || std::prev(after)->first + std::prev(after)->second <= *offset);
      taken[*offset] = length;
    } else {
      const auto victim = std::next(taken.begin(), std::ptrdiff_t(random() % taken.size()));
      space.give_back(victim->first, victim->second);
      taken.erase(victim);
    }
  }
  for (const auto& [offset, length] : taken) space.give_back(offset, length);
  EXPECT_TRUE(space.is_empty());
}

}  // namespace
}  // namespace lodestone::host
