// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/first_equal.h"

#include <gtest/gtest.h>

#include <map>

namespace lodestone::geometry_image {
namespace {

uint32_t hash_of(uint64_t value) {
  WordHash hash;
  hash.add(value);
  return hash.value();
}

void expect_first_of_each(const std::vector<uint32_t>& values) {
  const std::vector<uint32_t> first = first_equal(
      static_cast<uint32_t>(values.size()), [&](uint32_t i) { return hash_of(values[i]); },
      [&](uint32_t i, uint32_t j) { return values[i] == values[j]; });
  ASSERT_EQ(first.size(), values.size());
  std::map<uint32_t, uint32_t> seen;
  for (uint32_t i = 0; i < values.size(); ++i)
    ASSERT_EQ(first[i], seen.try_emplace(values[i], i).first->second) << i;
}

TEST(FirstEqual, FindsTheLowestOfEachClass) {
  std::mt19937 random(5);
  // Beyond one bucket, beyond one block, and beyond the largest number of buckets times what one should hold.
  for (const uint32_t count : {0u, 1u, 2u, 1000u, 65536u, 65537u, 300000u}) {
    for (const uint32_t different : {1u, 7u, 100000u, 0xffffffffu}) {
      std::vector<uint32_t> values(count);
      for (uint32_t& value : values) value = static_cast<uint32_t>(random()) % different;
      expect_first_of_each(values);
    }
  }
}

TEST(FirstEqual, IsRightEvenWhereAllHashesCollide) {
  std::vector<uint32_t> values(500);
  for (uint32_t i = 0; i < values.size(); ++i) values[i] = i % 97;
  for (const uint32_t constant : {0u, 0xffffffffu}) {
    const std::vector<uint32_t> first = first_equal(
        500, [&](uint32_t) { return constant; },
        [&](uint32_t i, uint32_t j) { return values[i] == values[j]; });
    for (uint32_t i = 0; i < 500; ++i) EXPECT_EQ(first[i], i % 97);
  }
}

TEST(WordHash, TakesMinusZeroForZero) {
  WordHash plus, minus;
  plus.add(0.0f);
  minus.add(-0.0f);
  EXPECT_EQ(plus.value(), minus.value());
}

TEST(WordHash, SpreadsNeighbours) {
  std::map<uint32_t, uint32_t> buckets;
  for (uint64_t i = 0; i < 10240; ++i) ++buckets[hash_of(i) >> 22];
  // 10 a bucket on average: with a fair hash no bucket of 1,024 reaches 40 (a chance below 1e-9).
  for (const auto& [bucket, items] : buckets) EXPECT_LT(items, 40u) << bucket;
}

}  // namespace
}  // namespace lodestone::geometry_image
