// SPDX-License-Identifier: MIT
#include "lodestone/layout/bounds.h"

#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/frame.h"

namespace lodestone::cpu_fallback {
namespace {

using layout::Bound;

template <class Probe>
class Bounds : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    if (push_.written_above == 0) {
      if (index < push_.written) bound_parent(index);
      return;
    }
    const Bound p0 = bound_parent(4 * index), p1 = bound_parent(4 * index + 1),
                p2 = bound_parent(4 * index + 2), p3 = bound_parent(4 * index + 3);
    store_node(2, index, p0, p1, p2, p3);
  }

 private:
  Bound load_bound(uint32_t index) {
    Bound bound = layout::empty_bound();
    if (index < push_.count) {
      bound.lo = as_vec3(this->load(nodes_lo_, layout::level_base(push_.depth) + index));
      bound.hi = as_vec3(this->load(nodes_hi_, layout::level_base(push_.depth) + index));
    }
    return bound;
  }

  Bound bound_parent(uint32_t index) {
    const Bound c0 = load_bound(4 * index), c1 = load_bound(4 * index + 1), c2 = load_bound(4 * index + 2),
                c3 = load_bound(4 * index + 3);
    if (index < push_.written) store_node(1, index, c0, c1, c2, c3);
    return layout::join(layout::join(c0, c1), layout::join(c2, c3));
  }

  // The parent of c0 to c3, `levels` above the level that was read.
  void store_node(uint32_t levels, uint32_t index, const Bound& c0, const Bound& c1, const Bound& c2,
                  const Bound& c3) {
    const Bound node = layout::join(layout::join(c0, c1), layout::join(c2, c3));
    const uint32_t address = layout::level_base(push_.depth - levels) + index;
    this->store(nodes_lo_, address, as_bits(node.lo, layout::child_order(c0, c1, c2, c3)));
    this->store(nodes_hi_, address, as_bits(node.hi, 0));
  }

  Quads nodes_lo_ = this->quads(0), nodes_hi_ = this->quads(1);
  layout::BoundsPush push_ = this->template push<layout::BoundsPush>();
};

}  // namespace

void bounds(const CpuDispatch& dispatch) {
  run_pass<Bounds>(dispatch, 256);
}

}  // namespace lodestone::cpu_fallback
