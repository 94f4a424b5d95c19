// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/atlas.h"
#include "lodestone/layout/relax.h"

namespace lodestone::cpu_fallback {
namespace {

template <class Probe>
class RelaxMeasure : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const uint32_t texel = this->load(inner_texels_, push_.first + index);
    const uint32_t chart = this->load(relaxed_map_, texel).w - 1;
    const uint32_t width = this->load(charts_, 2 * uint64_t(chart)).y;
    const layout::RelaxRing now = ring(now_, texel, width), was = ring(was_, texel, width);
    glm::uvec4 site = this->load(sites_, texel);
    site.w = layout::floatBitsToUint(layout::relax_weight(now, was));
    this->store(sites_, texel, site);
  }

 private:
  layout::RelaxRing ring(const Quads& texels, uint32_t texel, uint32_t width) {
    glm::vec3 points[layout::relax_neighbors];
    for (uint32_t k = 0; k < layout::relax_neighbors; ++k)
      points[k] = as_vec3(this->load(texels, layout::relax_neighbor(texel, width, k)));
    return layout::relax_ring(as_vec3(this->load(texels, texel)), points);
  }

  Words inner_texels_ = this->words(0);
  Quads charts_ = this->quads(1), relaxed_map_ = this->quads(2), now_ = this->quads(3), was_ = this->quads(4),
        sites_ = this->quads(5);
  layout::RelaxPush push_ = this->template push<layout::RelaxPush>();
};

LODESTONE_BLOCK_FUNCTION(static, relax_measure, RelaxMeasure)

}  // namespace

void relax_measure(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 1024, relax_measure_block);
}

}  // namespace lodestone::cpu_fallback
