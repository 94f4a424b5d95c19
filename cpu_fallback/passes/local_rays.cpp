// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/objects.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class LocalRays : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    const uint32_t ray = this->load(owners_, index);
    uint32_t instance = this->load(found_, ray);
    const bool paused = instance == layout::enter_paused;
    if (paused) instance = 0;
    const uvec4 from = this->load(rays_, 2 * uint64_t(ray)), along = this->load(rays_, 2 * uint64_t(ray) + 1),
                hit = this->load(hits_, ray), state = this->load(states_, ray),
                place = this->load(places_, ray);
    const uint64_t record = layout::instance_quads * uint64_t(instance);
    const glm::vec4 row0 = as_vec4(this->load(instances_, record)),
                    row1 = as_vec4(this->load(instances_, record + 1)),
                    row2 = as_vec4(this->load(instances_, record + 2));
    const uvec4 rest = this->load(instances_, record + 6);
    const glm::vec3 origin = layout::flush_tiny3(layout::transformed_point(as_vec3(from), row0, row1, row2));
    const glm::vec3 direction =
        layout::flush_tiny3(layout::transformed_direction(as_vec3(along), row0, row1, row2));
    // In an instance behind the one that a mask let the ray through in, everything at tmin is still to be
    // met.
    uint32_t next = state.w;
    if (instance > place.w) next = 0;
    if (instance < place.w) next = layout::no_index;
    this->store(roots_, index, rest.x);
    this->store(local_rays_, 2 * uint64_t(index), as_bits(origin, from.w));
    this->store(local_rays_, 2 * uint64_t(index) + 1,
                as_bits(direction, paused ? layout::floatBitsToUint(-1.0f) : hit.x));
    this->store(local_states_, index, uvec4(0, 0, layout::trace_restart, next));
    if (this->constant(1) != 0) this->store(local_steps_, index, 0);
  }

 private:
  Quads rays_ = this->quads(0), hits_ = this->quads(1), states_ = this->quads(2), places_ = this->quads(3);
  Words found_ = this->words(4);
  Quads instances_ = this->quads(5);
  Words owners_ = this->words(6), roots_ = this->words(7);
  Quads local_rays_ = this->quads(8), local_states_ = this->quads(9);
  Words local_steps_ = this->words(10);
};

LODESTONE_BLOCK_FUNCTION(static, local_rays, LocalRays)

}  // namespace

void local_rays(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, local_rays_block);
}

}  // namespace lodestone::cpu_fallback
