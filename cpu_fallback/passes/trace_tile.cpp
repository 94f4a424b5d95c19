// SPDX-License-Identifier: MIT
// What `tile` does on devices, step by step, for comparison. An invocation is a lane there; here the first
// lane of each eight does the work of all.
#include <bit>

#include "lodestone/cpu_fallback/passes/trace_kernel.h"
#include "lodestone/layout/tile.h"

namespace lodestone::cpu_fallback {
namespace {

using glm::uvec4;
using layout::tile_fan, layout::tile_lanes, layout::tile_rays;

constexpr uint32_t tile_groups = tile_rays / tile_lanes;

struct Group {
  layout::Ray rays[tile_lanes];
  bool waits[tile_lanes], active[tile_lanes];
  layout::Hit best[tile_lanes];
  layout::Cone cone;
  float tmax;
};

template <class Probe>
class TraceTile : public TraceKernel<Probe, 8> {
 public:
  using TraceKernel<Probe, 8>::TraceKernel;

  void operator()(uint32_t invocation) {
    first_ = tile_rays * (invocation / tile_lanes);
    if (invocation % tile_lanes != 0 || first_ >= this->push_.rays) return;
    for (uint32_t i = 0; i < tile_rays; ++i) {
      Group& group = groups_[i / tile_lanes];
      group.rays[i % tile_lanes] = this->load_ray(std::min(first_ + i, this->push_.rays - 1));
      group.waits[i % tile_lanes] = first_ + i < this->push_.rays;
      group.best[i % tile_lanes] = {-1, 0, 0, layout::no_index};
    }
    left_ = int64_t(tile_lanes) * this->push_.budget;
    uint32_t lead = 0;
    for (uint32_t kind = 0; kind < layout::tile_kinds && lead < tile_rays && left_ > 0; ++kind) {
      lead_ = groups_[lead / tile_lanes].rays[lead % tile_lanes];
      slabs_ = layout::make_slabs(lead_, object_.extent);
      axes_ = layout::make_tile_axes(slabs_, layout::object_grid(object_));
      for (Group& group : groups_) activate(group);
      join_groups();
      if (!(tmax_ < 0.0f)) walk();
      for (lead = 0; lead < tile_rays && !groups_[lead / tile_lanes].waits[lead % tile_lanes];) ++lead;
    }
    store(left_ > 0);
  }

 private:
  // Those rays become active that go together with the leading one.
  void activate(Group& group) {
    const uint32_t axis = layout::make_shear(lead_).axis;
    group.cone = {glm::vec3(layout::infinity_bits_as_max), glm::vec3(0)};
    group.tmax = -1;
    for (uint32_t lane = 0; lane < tile_lanes; ++lane) {
      const layout::Ray& ray = group.rays[lane];
      const layout::Slabs slabs = layout::make_slabs(ray, object_.extent);
      const bool alike = ray.origin == lead_.origin && ray.tmin == lead_.tmin && !std::signbit(lead_.tmin) &&
                         slabs.octant == slabs_.octant && layout::make_shear(ray).axis == axis;
      group.active[lane] = group.waits[lane] && ray.tmax >= 0.0f && alike;
      if (group.active[lane] || (group.waits[lane] && ray.tmax < 0.0f)) {
        group.best[lane].t = ray.tmax;
        group.waits[lane] = false;
      }
      if (!group.active[lane]) continue;
      const glm::vec3 size = glm::abs(slabs.inverse);
      group.cone.lo = layout::min3(group.cone.lo, size);
      group.cone.hi = layout::max3(group.cone.hi, size);
      group.tmax = layout::max2(group.tmax, ray.tmax);
      this->probe.ray();
    }
  }

  void join_groups() {
    cone_ = groups_[0].cone;
    for (const Group& group : groups_) {
      cone_.lo = layout::min3(cone_.lo, group.cone.lo);
      cone_.hi = layout::max3(cone_.hi, group.cone.hi);
    }
    join_tmax();
  }

  void walk() {
    struct Level {
      uint32_t node;  // that the keys are the children of
      uint32_t keys[tile_fan];
    };
    Level levels[layout::max_depth / 2 + 2];
    uint32_t height = 0;
    levels[0].node = 0;
    std::fill_n(levels[0].keys, tile_fan, layout::box_missed);
    levels[0].keys[0] = 0;
    while (left_ > 0) {
      Level& top = levels[height];
      uint32_t* nearest = std::min_element(top.keys, top.keys + tile_fan);
      if (layout::key_beyond(*nearest, tmax_)) {  // nothing is left here
        --left_;
        if (height-- != 0) continue;
        left_ -= 2;
        return;
      }
      const uint32_t node = 16 * top.node + (*nearest & 15);
      *nearest = layout::box_missed;
      left_ -= 2;
      this->count_step(tile_fan);
      const uint32_t level = layout::tile_first_level(object_.depth) + 2 * height;
      layout::BoxSides boxes[tile_fan];
      load_boxes(level, node, boxes);
      if (level == object_.depth) {
        test_leaves(node, boxes);
        left_ -= 9;
        continue;
      }
      Level& next = levels[++height];
      next.node = node;
      for (uint32_t child = 0; child < tile_fan; ++child)
        next.keys[child] = layout::tile_key(boxes[child], cone_, lead_.tmin, tmax_, child);
    }
  }

  // The 16 nodes of a level that are grandchildren of `node`; of an odd tree's root, its 4 children.
  void load_boxes(uint32_t level, uint32_t node, layout::BoxSides (&boxes)[tile_fan]) {
    for (layout::BoxSides& box : boxes) box = {glm::vec3(0), glm::vec3(0), false};
    const uint32_t records = level == 1 ? 1 : 4;
    for (uint32_t r = 0; r < records; ++r) {
      const uint64_t record = 3 * (uint64_t(layout::level_base(level - 1)) + (level == 1 ? 0 : 4 * node) + r);
      const uvec4 planes[3] = {this->load(boxes_, record), this->load(boxes_, record + 1),
                               this->load(boxes_, record + 2)};
      for (int child = 0; child < 4; ++child) {
        glm::uvec3 lo, hi;
        for (int axis = 0; axis < 3; ++axis) {
          lo[axis] = planes[axis][child / 2] >> 16 * (child % 2) & 0xffff;
          hi[axis] = planes[axis][2 + child / 2] >> 16 * (child % 2) & 0xffff;
        }
        boxes[4 * r + static_cast<uint32_t>(child)] = layout::make_box_sides(lo, hi, axes_, slabs_.octant);
      }
    }
  }

  void test_leaves(uint32_t node, const layout::BoxSides (&boxes)[tile_fan]) {
    for (Group& group : groups_) {
      uint32_t quads = 0;
      for (uint32_t child = 0; child < tile_fan; ++child) {
        if (layout::cone_enters(boxes[child], group.cone, lead_.tmin, group.tmax)) quads |= 1u << child;
      }
      for (; quads != 0; quads &= quads - 1) {
        const uint64_t slot = tile_fan * uint64_t(node) + static_cast<uint32_t>(std::countr_zero(quads));
        test_group(group, this->load(leaf_map_, 2 * slot), this->load(leaf_map_, 2 * slot + 1));
        --left_;
      }
      group.tmax = -1;
      for (uint32_t lane = 0; lane < tile_lanes; ++lane) {
        if (group.active[lane]) group.tmax = layout::max2(group.tmax, group.best[lane].t);
      }
    }
    join_tmax();
  }

  void test_group(Group& group, uint32_t texel, uint32_t stride) {
    for (uint32_t lane = 0; lane < tile_lanes; ++lane) {
      if (!group.active[lane]) continue;
      const layout::Ray& ray = group.rays[lane];
      this->test_quad(texel, stride, {}, ray, layout::make_slabs(ray, object_.extent),
                      layout::make_shear(ray), layout::no_index, group.best[lane]);
    }
  }

  void join_tmax() {
    tmax_ = groups_[0].tmax;
    for (const Group& group : groups_) tmax_ = layout::max2(tmax_, group.tmax);
  }

  void store(bool in_time) {
    using Base = TraceKernel<Probe, 8>;
    uint32_t again = 0;
    for (uint32_t i = 0; i < tile_rays && first_ + i < this->push_.rays; ++i) {
      const Group& group = groups_[i / tile_lanes];
      const layout::Hit& hit = group.best[i % tile_lanes];
      const bool done = in_time && !group.waits[i % tile_lanes];
      const uint32_t primitive = this->resumable() || done ? hit.primitive : layout::unanswered;
      Base::store(this->hits_, first_ + i, as_bits({hit.t, hit.u, hit.v}, primitive));
      if (this->resumable()) {
        Base::store(this->states_, first_ + i,
                    uvec4(0, 0, done ? layout::trace_finished : layout::trace_restart, layout::no_index));
      }
      if (!done) ++again;
    }
    if (again != 0) this->add(this->pending_, 0, again);
  }

  Quads boxes_ = this->quads(6);
  Words leaf_map_ = this->words(7);
  layout::ObjectRecord object_ = this->load_object(0);  // the only one

  uint32_t first_ = 0;  // ray of the tile
  layout::Ray lead_{};
  layout::Slabs slabs_{};
  layout::TileAxes axes_{};
  Group groups_[tile_groups];
  layout::Cone cone_{};
  float tmax_ = 0;
  int64_t left_ = 0;  // loop iterations of the budget
};

LODESTONE_BLOCK_FUNCTION(static, trace_tile, TraceTile)

}  // namespace

void trace_tile(const CpuDispatch& dispatch) {
  run_blocks(dispatch, 64, trace_tile_block);
}

}  // namespace lodestone::cpu_fallback
