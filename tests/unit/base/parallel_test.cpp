// SPDX-License-Identifier: MIT
#include "lodestone/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace lodestone {
namespace {

class ParallelFor : public testing::TestWithParam<uint32_t> {
 protected:
  ParallelFor() { set_thread_count(GetParam()); }
  ~ParallelFor() override { set_thread_count(0); }
};

INSTANTIATE_TEST_SUITE_P(Threads, ParallelFor, testing::Values(1u, 2u, 3u, 0u),
                         testing::PrintToStringParamName());

TEST_P(ParallelFor, VisitsEveryPlaceOnceInBlocksOfTheGrain) {
  for (const uint64_t count : {0u, 1u, 7u, 8u, 1000u, 1001u}) {
    std::vector<std::atomic<int>> visits(count);
    parallel_for(count, 8, [&](uint64_t begin, uint64_t end) {
      EXPECT_EQ(begin % 8, 0u);
      EXPECT_EQ(end, std::min(count, begin + 8));
      for (uint64_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](const auto& n) { return n == 1; })) << count;
  }
}

TEST_P(ParallelFor, WhatItsBodiesWroteIsThereAfterwards) {
  std::vector<uint64_t> squares(5000);
  parallel_for(squares.size(), 16, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) squares[i] = i * i;
  });
  for (uint64_t i = 0; i < squares.size(); ++i) ASSERT_EQ(squares[i], i * i);
}

TEST_P(ParallelFor, ThrowsWhatABodyThrewAndWorksAgain) {
  const auto fails = [](uint64_t begin, uint64_t) {
    if (begin == 40) throw std::range_error("of block 40");
  };
  EXPECT_THROW(parallel_for(100, 1, fails), std::range_error);
  std::atomic<int> blocks{0};
  parallel_for(100, 1, [&](uint64_t, uint64_t) { ++blocks; });
  EXPECT_EQ(blocks, 100);
}

TEST_P(ParallelFor, LoopsInsideLoopsHaveNoMoreThreadsThanOne) {
  std::atomic<uint32_t> now{0}, peak{0}, bodies{0};
  parallel_for(6, 1, [&](uint64_t, uint64_t) {
    parallel_for(6, 1, [&](uint64_t, uint64_t) {
      const uint32_t here = ++now;
      uint32_t before = peak;
      while (before < here && !peak.compare_exchange_weak(before, here)) {
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ++bodies;
      --now;
    });
  });
  EXPECT_EQ(bodies, 36u);
  EXPECT_LE(peak, thread_count());
}

TEST(ThreadCount, IsThatOfTheMachineUntilItIsSet) {
  set_thread_count(5);
  EXPECT_EQ(thread_count(), 5u);
  set_thread_count(0);
  EXPECT_EQ(thread_count(), std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace
}  // namespace lodestone
