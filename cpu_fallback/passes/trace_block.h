// SPDX-License-Identifier: MIT
// A run of rays of one dispatch as the wide traversal sees it: buffers, hierarchies, counters.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "lodestone/cpu_fallback/passes/trace_kernel.h"
#include "lodestone/cpu_fallback/passes/wide_nodes.h"

namespace lodestone::cpu_fallback {

inline constexpr uint32_t packet_rays = 16;
inline constexpr uint32_t trace_grain = 1024;  // rays of a task, at most

// The hierarchy of one object.
class TraceTree {
 public:
  // `nodes_lo`, `nodes_hi`, `wide`, `leaf_map`: of all objects.
  TraceTree(const layout::ObjectRecord& object, const Quads& nodes_lo, const Quads& nodes_hi,
            const WideNode* wide, const Words& leaf_map)
      : nodes_lo_{nodes_lo.words + 4 * uint64_t(object.first_node)},
        nodes_hi_{nodes_hi.words + 4 * uint64_t(object.first_node)},
        wide_(wide + object.first_wide),
        leaf_map_{leaf_map.words + 2 * uint64_t(object.first_slot)},
        depth_(object.depth),
        slots_(object.slots),
        grid_(as_vec3(nodes_lo_.load4(0)), as_vec3(nodes_hi_.load4(0))),
        extent_(object.extent) {
    const render::WideLevels levels(depth_, slots_);
    first_leaf_record_ = render::WideLevels::first(levels.count() - 1);
    end_record_ = levels.end();
  }

  uint32_t depth() const { return depth_; }
  float extent() const { return extent_; }
  const WideGrid& grid() const { return grid_; }

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

  // 8 floats a node in two arrays: lo x y z, order or leaf; hi x y z, stride.
  const float* nodes_lo(uint32_t address) const {
    return reinterpret_cast<const float*>(nodes_lo_.words) + 4 * uint64_t(address);
  }
  const float* nodes_hi(uint32_t address) const {
    return reinterpret_cast<const float*>(nodes_hi_.words) + 4 * uint64_t(address);
  }
  uint32_t leaf_texel(uint32_t address) const { return order(address) & ~layout::leaf_flag; }
  uint32_t leaf_stride(uint32_t address) const { return nodes_hi_.words[4 * uint64_t(address) + 3]; }
  uint32_t order(uint32_t address) const { return nodes_lo_.words[4 * uint64_t(address) + 3]; }

 private:
  Quads nodes_lo_, nodes_hi_;
  const WideNode* wide_;
  Words leaf_map_;
  uint32_t depth_, slots_;
  WideGrid grid_;
  float extent_;
  uint32_t first_leaf_record_, end_record_;
};

template <class Probe>
class TraceBlock : public NodesKernel<Probe, 10> {
 public:
  static constexpr bool counting = Probe::counting;

  explicit TraceBlock(const CpuDispatch& dispatch) : NodesKernel<Probe, 10>(dispatch) {}

  bool any_hit() const { return NodesKernel<Probe, 10>::any_hit(); }

  using Moving = typename NodesKernel<Probe, 10>::Moving;
  using NodesKernel<Probe, 10>::moves;

  // The hierarchy that ray `index` goes through, and when it sees the quads.
  TraceTree tree(uint32_t index, Moving& moving) {
    return TraceTree(this->load_object(this->root(index, moving)), this->nodes_lo_, this->nodes_hi_, wide_,
                     leaf_map_);
  }
  TraceTree tree(uint32_t index) {
    Moving still;
    return tree(index, still);
  }

  // Do these rays go together? All in one object and of one octant, from nearby origins, in a narrow cone.
  bool coherent(uint32_t first, uint32_t count) {
    if (count < 4 || this->push_.resume != layout::resume_nothing || moves()) return false;
    Moving still;
    const uint32_t object = this->root(first, still);
    const glm::vec3 lead = direction(first);
    const uint32_t octant = octant_of(lead);
    glm::vec3 lo = origin(first), hi = lo;
    for (uint32_t i = first; i < first + count; ++i) {
      const glm::vec3 other = direction(i);
      if (this->root(i, still) != object || octant_of(other) != octant ||
          !(layout::dot3(lead, other) >= 0.98f))
        return false;
      lo = layout::min3(lo, origin(i));
      hi = layout::max3(hi, origin(i));
    }
    return layout::max_component(hi - lo) < tree(first).extent() * (1.0f / 64);
  }

  // Whether it is worth a look if 64 rays from `first` on go together, through one object and to their
  // nearest hits.
  bool may_be_a_beam(uint32_t first) const {
    return this->push_.resume == layout::resume_nothing && !any_hit() && !this->instanced() && !moves() &&
           origin(first) == origin(first + 1);
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
    for (uint32_t i = 0; Probe::counting && i < count; ++i) this->probe.ray();
    return this->hits_.words + 4 * uint64_t(first);
  }

  // One node was read and tested against the `rays` rays of a packet, of which `active` enter it.
  void count_step(uint32_t rays, uint32_t active) {
    if constexpr (Probe::counting) {
      render::Counters& c = this->probe.counts;
      c.node_visits += rays;
      c.box_tests += rays;
      c.bytes_read += 32;
      c.lane_steps += active;
      c.subgroup_steps += packet_rays;
    }
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
  static uint32_t octant_of(const glm::vec3& direction) {
    return (direction.x < 0 ? 1 : 0) | (direction.y < 0 ? 2 : 0) | (direction.z < 0 ? 4 : 0);
  }

  const WideNode* wide_ = reinterpret_cast<const WideNode*>(this->words(8).words);
  Words leaf_map_ = this->words(9);
};

}  // namespace lodestone::cpu_fallback
