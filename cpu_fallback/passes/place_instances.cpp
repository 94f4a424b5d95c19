// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/objects.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class PlaceInstances : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t instance) {
    const uint64_t record = layout::instance_quads * uint64_t(instance);
    const glm::vec4 row0 = as_vec4(this->load(instances_, record + 3)),
                    row1 = as_vec4(this->load(instances_, record + 4)),
                    row2 = as_vec4(this->load(instances_, record + 5));
    const uvec4 rest = this->load(instances_, record + 6);
    const glm::vec3 lo = as_vec3(this->load(objects_, 4 * uint64_t(rest.x) + 1)),
                    hi = as_vec3(this->load(objects_, 4 * uint64_t(rest.x) + 2));
    layout::Bound bound = layout::instance_bound(lo, hi, row0, row1, row2);
    uint32_t key = layout::morton_key((bound.lo + bound.hi) * 0.5f, push_.base, push_.per_step);
    if (layout::uintBitsToFloat(rest.z) < 0.0f) {
      bound = layout::empty_bound();
      key = layout::last_morton_key;
    }
    this->store(instance_lo_, instance, as_bits(bound.lo, 0));
    this->store(instance_hi_, instance, as_bits(bound.hi, 0));
    this->store(keys_, 2 * uint64_t(instance), key);
    this->store(keys_, 2 * uint64_t(instance) + 1, instance);
  }

 private:
  Quads objects_ = this->quads(0), instances_ = this->quads(1);
  Quads instance_lo_ = this->quads(2), instance_hi_ = this->quads(3);
  Words keys_ = this->words(4);
  layout::PlacePush push_ = this->template push<layout::PlacePush>();
};

LODESTONE_BLOCK_FUNCTION(static, place_instances, PlaceInstances)

}  // namespace

void place_instances(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, place_instances_block);
}

}  // namespace lodestone::cpu_fallback
