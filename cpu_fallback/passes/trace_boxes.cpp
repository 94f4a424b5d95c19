// SPDX-License-Identifier: MIT
// What `wide` does on devices, step by step, for comparison; the CPU's own `wide` is trace_wide.
#include "lodestone/cpu_fallback/passes/trace_kernel.h"
#include "lodestone/layout/boxes.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class TraceBoxes : public TraceKernel<Probe, 9> {
 public:
  using TraceKernel<Probe, 9>::TraceKernel;

  void operator()(uint32_t invocation) {
    const uint32_t index = this->ray_index(invocation);
    const layout::Ray ray = this->load_ray(index);
    const uint32_t root = this->root(index, moving_);
    object_ = this->load_object(root);
    const layout::Slabs slabs = layout::make_slabs(ray, object_.extent);
    const layout::Shear shear = layout::make_shear(ray);
    const layout::BoxRay box_ray = layout::make_box_ray(slabs, layout::object_grid(object_));
    this->load_tolerance(index);
    typename TraceKernel<Probe, 9>::State state;
    if (!this->begin_ray(index, ray, state)) return;
    layout::Hit& best = state.best;
    layout::BoxWalk walk{layout::trace_depth(state.place), state.place.x, state.place.y, uvec4(0)};
    if (walk.levels != 0) walk.trail = this->load(trails_, index);
    if (!(ray.tmax < 0.0f)) {
      for (uint32_t budget = this->push_.budget; walk.depth != layout::walk_done && budget != 0; --budget) {
        layout::BoxRay against = box_ray;
        if (this->detailed()) {
          const uint64_t number =
              uint64_t(object_.first_detail) + layout::level_base(walk.depth) + walk.index;
          const layout::NodeDetail detail = this->load_detail(number);
          if (layout::is_whole(detail, this->tolerance())) {
            this->count_step(4);
            this->test_whole(number, moving_, ray, slabs, shear, state.place.w, best);
            if (this->any_hit() && best.primitive != layout::no_index) walk.levels = 0;
            walk = layout::box_walk_on(walk);
            continue;
          }
          against = layout::widened(box_ray, slabs, layout::child_margin(detail, this->tolerance()));
        }
        const uint32_t list = visit(walk, against, slabs.octant, ray.tmin, best.t);
        const bool entered = list >> 8 != 0;
        if (entered && walk.depth + 1 != object_.depth) {
          walk = layout::box_walk_down(walk, list);
          continue;
        }
        if (entered) test_leaves(walk, list, ray, slabs, shear, state.place.w, best);
        if (this->any_hit() && best.primitive != layout::no_index) walk.levels = 0;
        walk = layout::box_walk_on(walk);
      }
    }
    const bool finished = walk.depth == layout::walk_done || ray.tmax < 0.0f;
    if (this->resumable()) this->store(trails_, index, walk.trail);
    state.place =
        uvec4(walk.index, walk.levels,
              4 * walk.depth + (finished ? layout::trace_finished : layout::trace_unfinished), state.place.w);
    this->end_ray(index, state);
  }

 private:
  uint32_t visit(const layout::BoxWalk& walk, const layout::BoxRay& box_ray, uint32_t octant, float tmin,
                 float tmax) {
    const uint64_t record = 3 * (uint64_t(object_.first_node) + layout::level_base(walk.depth) + walk.index);
    const uvec4 x = this->load(boxes_, record), y = this->load(boxes_, record + 1),
                z = this->load(boxes_, record + 2);
    this->count_step(4);
    return layout::box_list(layout::box_keys(x, y, z, box_ray, octant, tmin, tmax));
  }

  void test_leaves(const layout::BoxWalk& walk, uint32_t list, const layout::Ray& ray,
                   const layout::Slabs& slabs, const layout::Shear& shear, uint32_t next, layout::Hit& best) {
    for (uint32_t i = 0; i < list >> 8; ++i) {
      const uint64_t slot = object_.first_slot + 4 * uint64_t(walk.index) + (list >> 2 * i & 3u);
      const uint32_t texel = this->load(leaf_map_, 2 * slot), stride = this->load(leaf_map_, 2 * slot + 1);
      this->test_quad(texel, stride, moving_, ray, slabs, shear, next, best);
      if (this->any_hit() && best.primitive != layout::no_index) return;
    }
  }

  layout::ObjectRecord object_{};
  typename TraceKernel<Probe, 9>::Moving moving_;
  Quads boxes_ = this->quads(6);
  Words leaf_map_ = this->words(7);
  Quads trails_ = this->quads(8);
};

LODESTONE_BLOCK_FUNCTION(static, trace_boxes, TraceBoxes)

}  // namespace

void trace_boxes(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, trace_boxes_block);
}

}  // namespace lodestone::cpu_fallback
