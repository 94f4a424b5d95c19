// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/objects.h"

namespace lodestone::cpu_fallback {
void scan_blocks(const CpuDispatch& dispatch) {
  layout::CountPush push;
  std::memcpy(&push, dispatch.push.data(), sizeof(push));
  uint32_t* counts = dispatch.buffers[0];
  uint32_t sum = 0;
  for (uint32_t block = 0; block < push.count; ++block) {
    dispatch.buffers[1][block] = sum;
    sum += counts[block];
    counts[block] = 0;
  }
  dispatch.buffers[2][0] = sum;
  if (dispatch.counting) dispatch.counters->bytes_written += 4 * uint64_t(push.count);
}

}  // namespace lodestone::cpu_fallback
