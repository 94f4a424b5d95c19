// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/atlas.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class Accumulate : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    if (this->load(shadow_hits_, index).w != layout::no_index) return;
    const glm::uvec4 contribution = this->load(contributions_, index), before = this->load(radiance_, index);
    this->store(radiance_, index, as_bits(as_vec3(before) + as_vec3(contribution), before.w));
  }

 private:
  Quads shadow_hits_ = this->quads(0), contributions_ = this->quads(1), radiance_ = this->quads(2);
};

}  // namespace

void accumulate(const CpuDispatch& dispatch) {
  run_pass<Accumulate>(dispatch, 4096);
}

}  // namespace lodestone::cpu_fallback
