// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/trace_kernel.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class TraceOctant : public NodesKernel<Probe, 8> {
 public:
  using NodesKernel<Probe, 8>::NodesKernel;

  void operator()(uint32_t invocation) {
    const uint32_t index = this->ray_index(invocation);
    const layout::Ray ray = this->load_ray(index);
    typename NodesKernel<Probe, 8>::Moving moving;
    const layout::ObjectRecord object = this->load_object(this->root(index, moving));
    const layout::Slabs slabs = layout::make_slabs(ray, object.extent);
    const layout::Shear shear = layout::make_shear(ray);
    this->load_tolerance(index);
    typename NodesKernel<Probe, 8>::State state;
    if (!this->begin_ray(index, ray, state)) return;
    layout::Hit& best = state.best;
    layout::Walk walk{layout::trace_depth(state.place), state.place.x, state.place.y};
    bool finished = ray.tmax < 0.0f;
    if (!finished) {
      for (uint32_t budget = this->push_.budget; budget != 0; --budget) {
        const uint32_t address = object.first_node + layout::walk_address(walk);
        const uvec4 lo = this->load(this->nodes_lo_, address), hi = this->load(this->nodes_hi_, address);
        this->count_step();
        const uint64_t number = object.first_detail + layout::walk_address(walk);
        const uint64_t above = walk.depth == 0 ? 0
                                               : object.first_detail + layout::level_base(walk.depth - 1) +
                                                     ((walk.order ^ walk.turns) >> 2);
        const auto [enter, inside] =
            this->enter_node(lo, hi, slabs, ray.tmin, best.t, walk.depth == 0 ? nullptr : &above);
        const bool whole = inside && walk.depth != object.depth && this->is_whole(number);
        if (inside && walk.depth != object.depth && !whole) {
          walk = layout::walk_down(walk, (lo.w >> (2 * slabs.octant)) & 3u);
          continue;
        }
        if (whole) {
          this->test_whole(number, moving, ray, slabs, shear, state.place.w, best);
        } else if (inside) {
          this->test_leaf(lo.w & ~layout::leaf_flag, hi.w, moving, ray, slabs, shear, state.place.w, enter,
                          best);
        }
        walk = layout::walk_on(walk);
        if (this->any_hit() && best.primitive != layout::no_index) walk.depth = layout::walk_done;
        if (walk.depth == layout::walk_done) break;
      }
      finished = walk.depth == layout::walk_done;
    }
    const uint32_t status = finished ? layout::trace_finished : layout::trace_unfinished;
    state.place = uvec4(walk.order, walk.turns, 4 * walk.depth + status, state.place.w);
    this->end_ray(index, state);
  }
};

LODESTONE_BLOCK_FUNCTION(static, trace_octant, TraceOctant)

}  // namespace

void trace_octant(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, trace_octant_block);
}

}  // namespace lodestone::cpu_fallback
