// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/trace_kernel.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class TraceThreaded : public NodesKernel<Probe, 9> {
 public:
  using NodesKernel<Probe, 9>::NodesKernel;

  void operator()(uint32_t invocation) {
    const uint32_t index = this->ray_index(invocation);
    const layout::Ray ray = this->load_ray(index);
    typename NodesKernel<Probe, 9>::Moving moving;
    const layout::ObjectRecord object = this->load_object(this->root(index, moving));
    const uint32_t first_node = object.first_node;
    const layout::Slabs slabs = layout::make_slabs(ray, object.extent);
    const layout::Shear shear = layout::make_shear(ray);
    this->load_tolerance(index);
    typename NodesKernel<Probe, 9>::State state;
    if (!this->begin_ray(index, ray, state)) return;
    layout::Hit& best = state.best;
    uint32_t link = state.place.x;
    if (!(ray.tmax < 0.0f)) {
      for (uint32_t budget = this->push_.budget; budget != 0; --budget) {
        const uint64_t address = uint64_t(first_node) + link;
        const uvec4 lo = this->load(this->nodes_lo_, address), hi = this->load(this->nodes_hi_, address);
        const uint32_t hit = this->load(links_, 2 * address), miss = this->load(links_, 2 * address + 1);
        this->count_step();
        const uint64_t number = uint64_t(object.first_detail) + link;
        const uint64_t above = link == 0 ? 0 : object.first_detail + layout::node_above(link);
        const auto [enter, inside] =
            this->enter_node(lo, hi, slabs, ray.tmin, best.t, link == 0 ? nullptr : &above);
        const bool at_leaf = inside && (hit & layout::leaf_flag) != 0;
        const bool whole = inside && !at_leaf && this->is_whole(number);
        if (whole) {
          this->test_whole(number, moving, ray, slabs, shear, state.place.w, best);
        } else if (at_leaf) {
          this->test_leaf(hit & ~layout::leaf_flag, hi.w, moving, ray, slabs, shear, state.place.w, enter,
                          best);
        }
        link = inside && !at_leaf && !whole ? hit : miss;
        if (this->any_hit() && best.primitive != layout::no_index) link = 0;
        if (link == 0) break;
      }
    } else {
      link = 0;
    }
    const uint32_t status = link == 0 ? layout::trace_finished : layout::trace_unfinished;
    state.place = uvec4(link, 0, status, state.place.w);
    this->end_ray(index, state);
  }

 private:
  Words links_ = this->words(8);
};

LODESTONE_BLOCK_FUNCTION(static, trace_threaded, TraceThreaded)

}  // namespace

void trace_threaded(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, trace_threaded_block);
}

}  // namespace lodestone::cpu_fallback
