// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/trace_wide.h"

#include <algorithm>
#include <bit>

#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/cpu_fallback/passes/trace_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/trace_wide.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/beam-inl.h"
#include "lodestone/cpu_fallback/passes/single_ray-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {

// Rays [begin, end) of the dispatch; `begin` is a multiple of 64.
template <class Block>
HWY_ATTR void trace_rays(Block& block, uint32_t begin, uint32_t end) {
  uint32_t singles[trace_grain];
  uint32_t size = 0;
  for (uint32_t first = begin; first < end; first += layout::tile_rays) {
    const bool whole = first + layout::tile_rays <= end;
    if (whole && trace_beams(block, first, singles, size)) continue;
    for (uint32_t i = first; i < std::min(first + layout::tile_rays, end); ++i) singles[size++] = i;
  }
  trace_singles(block, singles, size);
}

// A BlockFunction (kernel.h).
HWY_ATTR void trace_block(const CpuDispatch& dispatch, uint32_t begin, uint32_t end,
                          render::Counters* counters) {
  if (counters == nullptr) {
    TraceBlock<EmptyProbe> block(dispatch);
    trace_rays(block, begin, end);
  } else {
    TraceBlock<CountingProbe> block(dispatch);
    trace_rays(block, begin, end);
    *counters = block.probe.counts;
  }
}

const char* target_name() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(trace_block);
HWY_EXPORT(target_name);

std::string simd_target() {
  return HWY_DYNAMIC_DISPATCH(target_name)();
}

void trace_wide(const CpuDispatch& dispatch) {
  run_blocks(dispatch, trace_grain, HWY_DYNAMIC_DISPATCH(trace_block));
}

}  // namespace lodestone::cpu_fallback
#endif
