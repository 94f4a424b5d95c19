// SPDX-License-Identifier: MIT
// A run of rays of one dispatch as the wide traversal sees it: buffers, hierarchies, counters.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "lodestone/cpu_fallback/passes/trace_kernel.h"
#include "lodestone/cpu_fallback/passes/wide_nodes.h"

namespace lodestone::cpu_fallback {

inline constexpr uint32_t trace_grain = 1024;  // rays of a task, at most

// The square of the cosine to one of them, of rays that go the same way.
inline constexpr float narrow_cone = 0.96f;

// The hierarchy of one object.
class TraceTree {
 public:
  // `wide`, `leaf_map`: of all objects.
  TraceTree(const layout::ObjectRecord& object, const WideNode* wide, const Words& leaf_map)
      : wide_(wide + object.first_wide),
        leaf_map_{leaf_map.words + 2 * uint64_t(object.first_slot)},
        slots_(object.slots),
        grid_(layout::object_grid(object)),
        extent_(object.extent) {
    const render::WideLevels levels(object.depth, slots_);
    first_leaf_record_ = render::WideLevels::first(levels.count() - 1);
    end_record_ = levels.end();
  }

  float extent() const { return extent_; }
  const layout::BoxGrid& grid() const { return grid_; }

  const WideNode& wide_node(uint32_t record) const { return wide_[record]; }
  uint32_t first_leaf_record() const { return first_leaf_record_; }
  uint32_t end_record() const { return end_record_; }
  // Where the quads of the slots from `slot` on are found, two words each; for prefetching.
  const uint32_t* leaves(uint32_t slot) const { return leaf_map_.words + 2 * uint64_t(slot); }
  // The quad of a slot; false: there is none.
  bool leaf(uint32_t slot, uint32_t& texel, uint32_t& stride) const {
    if (slot >= slots_) return false;
    texel = leaf_map_.load1(2 * uint64_t(slot));
    stride = leaf_map_.load1(2 * uint64_t(slot) + 1);
    return texel != layout::empty_slot;
  }

 private:
  const WideNode* wide_;
  Words leaf_map_;
  uint32_t slots_;
  layout::BoxGrid grid_;
  float extent_;
  uint32_t first_leaf_record_, end_record_;
};

template <class Probe>
class TraceBlock : public TraceKernel<Probe, 8> {
 public:
  static constexpr bool counting = Probe::counting;

  explicit TraceBlock(const CpuDispatch& dispatch) : TraceKernel<Probe, 8>(dispatch) {}

  bool any_hit() const { return TraceKernel<Probe, 8>::any_hit(); }

  using Moving = typename TraceKernel<Probe, 8>::Moving;
  using TraceKernel<Probe, 8>::moves;

  // The hierarchy that ray `index` goes through, and when it sees the quads.
  TraceTree tree(uint32_t index, Moving& moving) {
    return TraceTree(this->load_object(this->root(index, moving)), wide_, leaf_map_);
  }
  TraceTree tree(uint32_t index) {
    Moving still;
    return tree(index, still);
  }

  // Whether it is worth a look if 64 rays from `first` on go together.
  bool may_be_a_beam(uint32_t first) const {
    if (this->push_.resume != layout::resume_nothing || moves()) return false;
    const glm::vec3 lead = direction(first), other = direction(first + 1);
    const float together = layout::dot3(lead, other);
    return together * together >= narrow_cone * layout::dot3(lead, lead) * layout::dot3(other, other);
  }
  // Whether they all start at one point, as far as the first two say; only nearest hits in one object are
  // looked for in that way.
  bool may_have_one_origin(uint32_t first) const {
    return !any_hit() && !instanced() && origin(first) == origin(first + 1);
  }
  using TraceKernel<Probe, 8>::instanced;
  // Of 64 rays from `first` on the bits of those that go through the same object as ray `index`.
  uint64_t same_root(uint32_t first, uint32_t index) {
    Moving still;
    const uint32_t object = this->root(index, still);
    uint64_t same = 0;
    for (uint32_t i = 0; i < 64; ++i) same |= uint64_t(this->root(first + i, still) == object) << i;
    return same;
  }

  const float* ray_quads(uint32_t index) const {
    return reinterpret_cast<const float*>(this->rays_.words) + 8 * uint64_t(index);
  }
  // Counted together with its hit, so that the loops above stay free of it.
  layout::Ray ray(uint32_t index) const {
    const glm::uvec4 from = this->rays_.load4(2 * uint64_t(index)),
                     along = this->rays_.load4(2 * uint64_t(index) + 1);
    return layout::stored_ray(from, along);
  }

  // Whether ray `index` is to be traced in this dispatch, always from the root: nothing is left unfinished
  // here.
  bool wanted(uint32_t index) {
    if (this->push_.resume == layout::resume_nothing) return true;
    return layout::trace_goes_on(this->states_.load4(index));
  }
  // layout::accept_triangle's `next`, of a ray that the mask has let through.
  uint32_t next(uint32_t index) {
    return this->push_.resume == layout::resume_nothing ? layout::no_index : this->states_.load4(index).w;
  }

  // `is_ray`: not one whose tmax says that there is none.
  void finish(uint32_t index, bool is_ray, layout::Hit hit, uint32_t visits) {
    if (any_hit() && hit.primitive != layout::no_index) hit = {0, 0, 0, 0};
    this->hits_.store4(index, as_bits({hit.t, hit.u, hit.v}, hit.primitive));
    if (this->resumable()) this->states_.store4(index, {0, 0, layout::trace_finished, layout::no_index});
    if (this->constant(1) != 0) this->steps_.store1(index, visits);
    this->probe.read(8);
    this->probe.write(this->resumable() ? 8 : 4);
    if (!this->instanced() && this->push_.resume == layout::resume_nothing && is_ray) this->probe.ray();
  }

  // What finish does, of `count` rays from `first` on, but for their hits; returns where these are to be
  // stored.
  uint32_t* finish_beam(uint32_t first, uint32_t count, uint32_t visits) {
    for (uint32_t i = first; this->resumable() && i < first + count; ++i)
      this->states_.store4(i, {0, 0, layout::trace_finished, layout::no_index});
    for (uint32_t i = first; this->constant(1) != 0 && i < first + count; ++i) this->steps_.store1(i, visits);
    this->probe.read(8 * count);
    this->probe.write((this->resumable() ? 8 : 4) * count);
    for (uint32_t i = 0; Probe::counting && !instanced() && i < count; ++i) this->probe.ray();
    return this->hits_.words + 4 * uint64_t(first);
  }

  // One record of 16 bounds was read and tested against so many rays at once.
  void count_record(uint32_t rays) {
    if constexpr (Probe::counting) {
      render::Counters& c = this->probe.counts;
      c.node_visits += wide_fan;
      c.box_tests += wide_fan;
      c.bytes_read += sizeof(WideNode);
      c.lane_steps += rays;
      c.subgroup_steps += rays;
    }
  }

  // One quad was read and tested against `rays` rays; `count` quads against one.
  void count_quad(uint32_t rays) {
    this->probe.triangles(2 * rays);
    this->probe.read(18);
  }
  void count_quads(uint32_t count) {
    this->probe.triangles(2 * count);
    this->probe.read((moves() ? 34 : 18) * count);
  }

  // The corners of a quad a, b, c, d, four floats each, at a ray's time.
  void moved_corners(uint32_t first, uint32_t stride, const Moving& moving, float* corners) const {
    const uint32_t at[4] = {first, first + 1, first + stride, first + stride + 1};
    for (int i = 0; i < 4; ++i) {
      const glm::vec3 point = texel(at[i], moving);
      for (int axis = 0; axis < 3; ++axis) corners[4 * i + axis] = point[axis];
      corners[4 * i + 3] = 0;
    }
  }
  glm::vec3 texel(uint32_t index, const Moving& moving) const {
    const glm::vec3 point = as_vec3(this->geometry_.load4(moving.image + index));
    if (!moves()) return point;
    const uint64_t next = moving.image + this->push_.image_texels + index;
    return layout::moved3(point, as_vec3(this->geometry_.load4(next)), moving.passed);
  }
  const float* texels(uint32_t index) const {
    return reinterpret_cast<const float*>(this->geometry_.words) + 4 * uint64_t(index);
  }
  glm::vec3 texel(uint32_t index) const { return as_vec3(this->geometry_.load4(index)); }

 private:
  // As stored: whether these are numbers at all, ray() tells.
  glm::vec3 origin(uint32_t index) const { return as_vec3(this->rays_.load4(2 * uint64_t(index))); }
  glm::vec3 direction(uint32_t index) const { return as_vec3(this->rays_.load4(2 * uint64_t(index) + 1)); }
  const WideNode* wide_ = reinterpret_cast<const WideNode*>(this->words(6).words);
  Words leaf_map_ = this->words(7);
};

}  // namespace lodestone::cpu_fallback
