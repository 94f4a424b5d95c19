// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/objects.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class SortKeys : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const uint32_t key = this->load(keys_, 2 * uint64_t(index)),
                   instance = this->load(keys_, 2 * uint64_t(index) + 1);
    const uint64_t place = push_.run == 0 ? place_in_block(key, index) : place_in_runs(key, index);
    this->store(sorted_, 2 * place, key);
    this->store(sorted_, 2 * place + 1, instance);
  }

 private:
  uint64_t place_in_block(uint32_t key, uint32_t index) {
    const uint32_t begin = index & ~(layout::sort_run - 1);
    uint64_t place = begin;
    for (uint32_t i = begin; i < std::min(begin + layout::sort_run, push_.count); ++i) {
      const uint32_t other = this->load(keys_, 2 * uint64_t(i));
      if (other < key || (other == key && i < index)) ++place;
    }
    return place;
  }

  uint64_t place_in_runs(uint32_t key, uint32_t index) {
    const uint64_t own = index / push_.run * uint64_t(push_.run);
    const bool second = (index / push_.run & 1) != 0;
    const uint64_t other = second ? own - push_.run : own + push_.run;
    const uint64_t before = count_before(key, second, std::min<uint64_t>(other, push_.count),
                                         std::min<uint64_t>(other + push_.run, push_.count));
    return std::min(own, other) + (index - own) + before;
  }

  // How many of a run's first keys come before `key`: those below it, and equal ones where `equal`.
  uint64_t count_before(uint32_t key, bool equal, uint64_t begin, uint64_t end) {
    uint64_t low = begin, high = end;
    while (low < high) {
      const uint64_t middle = (low + high) / 2;
      const uint32_t other = this->load(keys_, 2 * middle);
      if (other < key || (equal && other == key)) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low - begin;
  }

  Words keys_ = this->words(0), sorted_ = this->words(1);
  layout::SortPush push_ = this->template push<layout::SortPush>();
};

LODESTONE_BLOCK_FUNCTION(static, sort_keys, SortKeys)

}  // namespace

void sort_keys(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 1024, sort_keys_block);
}

}  // namespace lodestone::cpu_fallback
