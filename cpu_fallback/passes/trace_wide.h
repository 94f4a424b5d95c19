// SPDX-License-Identifier: MIT
// The CPU's fast traversal: rays that go together as beams of 64, others one by one against 16 bounds at
// once. SIMD by run-time dispatch; the same hits as `threaded` and `octant`, to the bit, at every vector
// width.
#pragma once

#include "lodestone/cpu_fallback/kernel.h"

namespace lodestone::cpu_fallback {

void trace_wide(const CpuDispatch& dispatch);

}  // namespace lodestone::cpu_fallback
