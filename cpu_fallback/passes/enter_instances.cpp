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
        ray_, layout::max2(push_.extent, layout::largest_abs(ray_.origin)) * push_.rounding);
    layout::BoxWalk walk{place_.z & 255, place_.x, place_.y, uvec4(0)};
    if (walk.levels != 0) walk.trail = this->load(trails_, ray_index_);
    if (push_.round != 0 && (place_.z & layout::place_paused) == 0) {
      take_hit(index, walk.index);
      walk = layout::box_walk_on(walk);
    }
    if ((any_hit_ && best_.primitive != layout::no_index) || ray_.tmax < 0.0f) walk.depth = layout::walk_done;
    const uint32_t instance = next_instance(walk);
    this->store(found_, ray_index_, instance);
    if (instance != layout::no_index) {
      const uint32_t paused = instance == layout::enter_paused ? layout::place_paused : 0;
      this->store(places_, ray_index_, uvec4(walk.index, walk.levels, walk.depth | paused, place_.w));
      this->store(trails_, ray_index_, walk.trail);
      state_.z = layout::trace_unfinished;
      this->add(block_counts_, index / push_.block, 1);
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
  // The instance of a leaf, and where the ray enters its bound.
  struct Entry {
    uint32_t instance;
    float enter;
    bool inside;
  };
  Entry enter_leaf(uint32_t leaf) {
    const uint32_t instance = this->load(keys_, 2 * uint64_t(leaf) + 1);
    const glm::vec3 lo = as_vec3(this->load(instance_lo_, instance)),
                    hi = as_vec3(this->load(instance_hi_, instance));
    const float enter = layout::slab_enter(slabs_, lo, hi, ray_.tmin);
    return {instance, enter, enter <= layout::slab_exit(slabs_, lo, hi, best_.t)};
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

  // What was met in the instance at a leaf, if it is nearer than all before.
  void take_hit(uint32_t index, uint32_t leaf) {
    const uvec4 met = this->load(local_hits_, index);
    const Entry entry = enter_leaf(leaf);
    const float t = layout::max2(layout::uintBitsToFloat(met.x), entry.enter);
    if (met.w == layout::no_index || !(t < best_.t || (t == best_.t && entry.instance < best_instance_)))
      return;
    best_ = {t, layout::uintBitsToFloat(met.y), layout::uintBitsToFloat(met.z), met.w};
    best_instance_ = entry.instance;
  }

  // From the place `walk` on, which goes to that instance's leaf. no_index: there is none; enter_paused: the
  // budget is spent.
  uint32_t next_instance(layout::BoxWalk& walk) {
    const layout::BoxRay box_ray = layout::make_box_ray(slabs_, push_.grid);
    for (uint32_t budget = push_.budget; walk.depth != layout::walk_done && budget != 0; --budget) {
      if (walk.depth == push_.depth) {
        const Entry entry = enter_leaf(walk.index);
        if (entry.inside) return entry.instance;
        walk = layout::box_walk_on(walk);
        continue;
      }
      const uint64_t record = 3 * (uint64_t(layout::level_base(walk.depth)) + walk.index);
      const uvec4 x = this->load(boxes_, record), y = this->load(boxes_, record + 1),
                  z = this->load(boxes_, record + 2);
      ++visits_;
      this->probe.step(4);
      const uint32_t list =
          layout::box_list(layout::box_keys(x, y, z, box_ray, slabs_.octant, ray_.tmin, best_.t));
      walk = list >> 8 != 0 ? layout::box_walk_down(walk, list) : layout::box_walk_on(walk);
    }
    return walk.depth == layout::walk_done ? layout::no_index : layout::enter_paused;
  }

  Quads rays_ = this->quads(0), hits_ = this->quads(1);
  Words hit_instances_ = this->words(2);
  Quads states_ = this->quads(3), places_ = this->quads(4), trails_ = this->quads(5);
  Words steps_ = this->words(6);
  Quads boxes_ = this->quads(7);
  Words keys_ = this->words(8);
  Quads instance_lo_ = this->quads(9), instance_hi_ = this->quads(10);
  Words owners_ = this->words(11);
  Quads local_hits_ = this->quads(12);
  Words local_steps_ = this->words(13), found_ = this->words(14), block_counts_ = this->words(15);
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
