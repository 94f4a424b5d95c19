// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/objects.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class GatherRays : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t block) {
    const uint64_t begin = uint64_t(block) * push_.block;
    const uint64_t end = std::min<uint64_t>(begin + push_.block, push_.count);
    if (begin >= end) return;
    uint32_t place = this->load(block_starts_, block);
    for (uint64_t i = begin; i < end; ++i) {
      const uint32_t ray = push_.round != 0 ? this->load(owners_, i) : static_cast<uint32_t>(i);
      if (this->load(found_, ray) != layout::no_index) this->store(next_owners_, place++, ray);
    }
  }

 private:
  Words found_ = this->words(0), block_starts_ = this->words(1), owners_ = this->words(2),
        next_owners_ = this->words(3);
  layout::GatherPush push_ = this->template push<layout::GatherPush>();
};

LODESTONE_BLOCK_FUNCTION(static, gather_rays, GatherRays)

}  // namespace

void gather_rays(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 64, gather_rays_block);
}

}  // namespace lodestone::cpu_fallback
