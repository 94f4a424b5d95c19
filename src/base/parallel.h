// SPDX-License-Identifier: MIT
// Loops over all cores. oneTBB underneath; under the thread sanitizer plain threads, because a TBB that is
// not instrumented hides the order of things from it.
#pragma once

#include <cstdint>
#include <functional>

namespace lodestone {

// How many threads loops use from now on; 0: all cores. Process-wide.
void set_thread_count(uint32_t threads);
uint32_t thread_count();

// Calls body(begin, end) for blocks of about `grain` that cover 0 .. count, in any order, on any thread.
// Blocks do not depend on the number of threads: they start at multiples of `grain`. The first exception is
// rethrown. A loop may run inside a loop; together they have no more threads than one.
void parallel_for(uint64_t count, uint64_t grain, const std::function<void(uint64_t, uint64_t)>& body);

}  // namespace lodestone
