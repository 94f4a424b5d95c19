// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/layout/objects.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;

template <class Probe>
class EnterInstances : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  void operator()(uint32_t index) {
    ray_index_ = push_.round != 0 ? this->load(owners_, index) : index;
    ray_ = layout::stored_ray(this->load(rays_, 2 * uint64_t(ray_index_)),
                              this->load(rays_, 2 * uint64_t(ray_index_) + 1));
    state_ = {0, 0, layout::trace_unfinished, layout::no_index};
    place_ = {0, 0, 0, layout::no_index};
    best_ = {ray_.tmax, 0, 0, layout::no_index};
    best_instance_ = layout::no_index;
    steps_before_ = visits_ = 0;
    if (push_.round == 0 && push_.resume != 0) {
      state_ = this->load(states_, index);
      if (layout::trace_status(state_) != layout::trace_restart) return;
      if (write_steps_) steps_before_ = this->load(steps_, index);
      place_.w = state_.y;
    }
    if (push_.round != 0) load_progress(index);
    if (push_.round == 0 && push_.resume == 0 && !(ray_.tmax < 0.0f)) this->probe.ray();
    slabs_ = layout::make_slabs(
        ray_, layout::max2(upper_extent(), layout::largest_abs(ray_.origin)) * push_.rounding);
    layout::Walk walk{place_.z & 255, place_.x, place_.y};
    if (push_.round != 0 && (place_.z & layout::place_paused) == 0) {
      take_hit(index, layout::walk_address(walk));
      walk = layout::walk_on(walk);
    }
    if ((any_hit_ && best_.primitive != layout::no_index) || ray_.tmax < 0.0f) walk.depth = layout::walk_done;
    const uint32_t instance = next_instance(walk);
    this->store(found_, ray_index_, instance);
    if (instance != layout::no_index) {
      const uint32_t paused = instance == layout::enter_paused ? layout::place_paused : 0;
      this->store(places_, ray_index_, uvec4(walk.order, walk.turns, walk.depth | paused, place_.w));
      state_.z = layout::trace_unfinished;
      this->add(block_counts_, index / layout::compact_block, 1);
    } else {
      state_.z = layout::trace_finished;
      if (any_hit_ && best_.primitive != layout::no_index) {
        best_ = {0, 0, 0, 0};
        best_instance_ = 0;
      }
    }
    this->store(hits_, ray_index_, as_bits({best_.t, best_.u, best_.v}, best_.primitive));
    this->store(hit_instances_, ray_index_, best_instance_);
    this->store(states_, ray_index_, state_);
    if (write_steps_) this->store(steps_, ray_index_, steps_before_ + visits_);
  }

 private:
  float upper_extent() {
    return layout::max2(layout::largest_abs(as_vec3(this->load(upper_lo_, 0))),
                        layout::largest_abs(as_vec3(this->load(upper_hi_, 0))));
  }

  // Of the rounds before.
  void load_progress(uint32_t index) {
    state_ = this->load(states_, ray_index_);
    place_ = this->load(places_, ray_index_);
    const uvec4 bits = this->load(hits_, ray_index_);
    best_ = {layout::uintBitsToFloat(bits.x), layout::uintBitsToFloat(bits.y),
             layout::uintBitsToFloat(bits.z), bits.w};
    best_instance_ = this->load(hit_instances_, ray_index_);
    if (write_steps_) steps_before_ = this->load(steps_, ray_index_) + this->load(local_steps_, index);
  }

  // What was met in the instance at the leaf `address`, if it is nearer than all before.
  void take_hit(uint32_t index, uint32_t address) {
    const uvec4 met = this->load(local_hits_, index);
    const uvec4 lo = this->load(upper_lo_, address), hi = this->load(upper_hi_, address);
    const uint32_t instance = lo.w & ~layout::leaf_flag;
    const float t = layout::max2(layout::uintBitsToFloat(met.x),
                                 layout::slab_enter(slabs_, as_vec3(lo), as_vec3(hi), ray_.tmin));
    if (met.w == layout::no_index || !(t < best_.t || (t == best_.t && instance < best_instance_))) return;
    best_ = {t, layout::uintBitsToFloat(met.y), layout::uintBitsToFloat(met.z), met.w};
    best_instance_ = instance;
  }

  // From the place `walk` on, which goes to that instance's leaf. no_index: there is none; enter_paused: the
  // budget is spent.
  uint32_t next_instance(layout::Walk& walk) {
    for (uint32_t budget = push_.budget; walk.depth != layout::walk_done;) {
      const uint32_t address = layout::walk_address(walk);
      const uvec4 lo = this->load(upper_lo_, address), hi = this->load(upper_hi_, address);
      ++visits_;
      this->probe.step(1);
      const float enter = layout::slab_enter(slabs_, as_vec3(lo), as_vec3(hi), ray_.tmin);
      const bool inside = enter <= layout::slab_exit(slabs_, as_vec3(lo), as_vec3(hi), best_.t);
      if (inside && walk.depth == push_.depth) return lo.w & ~layout::leaf_flag;
      walk = inside ? layout::walk_down(walk, lo.w >> 2 * slabs_.octant & 3) : layout::walk_on(walk);
      if (--budget == 0) break;
    }
    return walk.depth == layout::walk_done ? layout::no_index : layout::enter_paused;
  }

  Quads rays_ = this->quads(0), hits_ = this->quads(1);
  Words hit_instances_ = this->words(2);
  Quads states_ = this->quads(3), places_ = this->quads(4);
  Words steps_ = this->words(5);
  Quads upper_lo_ = this->quads(6), upper_hi_ = this->quads(7);
  Words owners_ = this->words(9);
  Quads local_hits_ = this->quads(10);
  Words local_steps_ = this->words(11), found_ = this->words(12), block_counts_ = this->words(13);
  layout::EnterPush push_ = this->template push<layout::EnterPush>();
  bool any_hit_ = this->constant(0) != 0, write_steps_ = this->constant(1) != 0;

  uint32_t ray_index_ = 0, best_instance_ = 0, steps_before_ = 0, visits_ = 0;
  layout::Ray ray_{};
  layout::Slabs slabs_{};
  layout::Hit best_{};
  uvec4 state_{}, place_{};
};

LODESTONE_BLOCK_FUNCTION(static, enter_instances, EnterInstances)

}  // namespace

void enter_instances(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 256, enter_instances_block);
}

}  // namespace lodestone::cpu_fallback
