// SPDX-License-Identifier: MIT
#include "lodestone/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#ifndef LODESTONE_STD_THREADS
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>
#endif

namespace lodestone {
namespace {

std::atomic<uint32_t> threads_wanted{0};

using Block = std::function<void(uint64_t)>;

#ifdef LODESTONE_STD_THREADS

void tell_pool(uint32_t /*threads*/) {}

// Whether this thread works in a loop that others share.
thread_local bool shared = false;

// A loop inside a loop stays on its thread: the others are at work already.
void share(uint64_t blocks, uint32_t threads, const Block& run_block) {
  std::atomic<uint64_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    const bool before = std::exchange(shared, true);
    try {
      for (uint64_t block = next++; block < blocks; block = next++) run_block(block);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = blocks;
    }
    shared = before;
  };
  std::vector<std::thread> workers;
  for (uint32_t i = 1; i < threads && !shared; ++i) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  if (failure) std::rethrow_exception(failure);
}

#else

// TBB has as many threads as there are cores unless it is told; they are shared by loops inside loops.
void tell_pool(uint32_t threads) {
  static std::mutex mutex;
  static std::optional<tbb::global_control> limit;
  const std::lock_guard lock(mutex);
  limit.reset();
  if (threads != 0) limit.emplace(tbb::global_control::max_allowed_parallelism, threads);
}

void share(uint64_t blocks, uint32_t threads, const Block& run_block) {
  // A loop inside a loop does not end because another block of the outer one has failed.
  tbb::task_group_context context(tbb::task_group_context::isolated);
  const auto run = [&] {
    tbb::parallel_for(
        tbb::blocked_range<uint64_t>(0, blocks, 1),
        [&](const tbb::blocked_range<uint64_t>& range) {
          for (uint64_t block = range.begin(); block != range.end(); ++block) run_block(block);
        },
        context);
  };
  // The thread's own arena has a place a core; to make another takes as long as a short loop. While the
  // thread waits there for an inner loop it takes up no block of the outer one.
  if (threads <= static_cast<uint32_t>(tbb::this_task_arena::max_concurrency()))
    return tbb::this_task_arena::isolate(run);
  tbb::task_arena(static_cast<int>(threads)).execute(run);
}

#endif

}  // namespace

void set_thread_count(uint32_t threads) {
  threads_wanted = threads;
  tell_pool(threads);
}

uint32_t thread_count() {
  // Asked once: the answer comes from a file.
  static const uint32_t cores = std::max(1u, std::thread::hardware_concurrency());
  const uint32_t wanted = threads_wanted;
  return wanted != 0 ? wanted : cores;
}

void parallel_for(uint64_t count, uint64_t grain, const std::function<void(uint64_t, uint64_t)>& body) {
  const uint64_t blocks = (count + grain - 1) / grain;
  const auto run_block = [&](uint64_t block) { body(block * grain, std::min(count, (block + 1) * grain)); };
  const uint32_t threads = static_cast<uint32_t>(std::min<uint64_t>(thread_count(), blocks));
  if (threads > 1) {
    share(blocks, threads, run_block);
  } else {
    for (uint64_t block = 0; block < blocks; ++block) run_block(block);
  }
}

}  // namespace lodestone
