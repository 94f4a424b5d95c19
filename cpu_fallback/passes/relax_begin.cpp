// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/cpu_fallback/passes/texel_point.h"
#include "lodestone/layout/atlas.h"
#include "lodestone/layout/frame.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class RelaxBegin : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t texel) {
    const glm::uvec4 source = this->load(texel_map_, texel);
    this->store(relaxed_map_, texel, source);
    if (source.w == 0) return;
    const glm::uvec4 triangle = this->load(triangles_, source.x);
    const glm::vec3 now = texel_point(*this, positions_, triangle, source),
                    was = texel_point(*this, rest_positions_, triangle, source);
    this->store(sites_, texel, this->load(map_sites_, texel));
    this->store(now_, texel, as_bits(now, 0));
    this->store(was_, texel, as_bits(was, 0));
  }
  using Kernel<Probe>::load;

 private:
  Quads texel_map_ = this->quads(0), triangles_ = this->quads(1), positions_ = this->quads(2),
        rest_positions_ = this->quads(3), map_sites_ = this->quads(4);
  Quads relaxed_map_ = this->quads(5), sites_ = this->quads(6), now_ = this->quads(7), was_ = this->quads(8);
};

LODESTONE_BLOCK_FUNCTION(static, relax_begin, RelaxBegin)

}  // namespace

void relax_begin(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 4096, relax_begin_block);
}

}  // namespace lodestone::cpu_fallback
