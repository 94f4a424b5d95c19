// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/wide_nodes.h"

#include <algorithm>

#include "lodestone/layout/atlas.h"
#include "lodestone/layout/boxes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/wide_nodes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/bound_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Planes = hn::CappedTag<float, wide_fan>;

// Bounds of the children of a record, in their order; of a corner x, y, z and anything.
struct Children {
  alignas(64) float lo[wide_fan][4], hi[wide_fan][4];
};

HWY_ATTR inline void set_child(Children& children, uint32_t child, const BoundLanes& bound) {
  store_lanes(bound.lo, children.lo[child]);
  store_lanes(bound.hi, children.hi[child]);
}

HWY_ATTR inline BoundLanes joined(const Children& children) {
  const hn::CappedTag<float, 16> d;
  const auto step = static_cast<uint32_t>(hn::Lanes(d));
  if (step < 4) {
    BoundLanes bound = empty_bound();
    for (uint32_t child = 0; child < wide_fan; ++child)
      bound = join(bound, {load_lanes(children.lo[child]), load_lanes(children.hi[child])});
    return bound;
  }
  const float *from_lo = children.lo[0], *from_hi = children.hi[0];
  auto lo = hn::Load(d, from_lo), hi = hn::Load(d, from_hi);
  for (uint32_t i = step; i < 4 * wide_fan; i += step) {
    lo = hn::Min(lo, hn::Load(d, from_lo + i));
    hi = hn::Max(hi, hn::Load(d, from_hi + i));
  }
  alignas(64) float blocks_lo[16], blocks_hi[16];
  hn::Store(lo, d, blocks_lo);
  hn::Store(hi, d, blocks_hi);
  BoundLanes bound{load_lanes(blocks_lo), load_lanes(blocks_hi)};
  for (uint32_t i = 4; i < step; i += 4)
    bound = join(bound, {load_lanes(blocks_lo + i), load_lanes(blocks_hi + i)});
  return bound;
}

// layout::box_low_plane and box_high_plane.
HWY_ATTR inline void store_planes(hn::Vec<Planes> low, hn::Vec<Planes> high, float base, float per_step,
                                  uint16_t* HWY_RESTRICT low_to, uint16_t* HWY_RESTRICT high_to) {
  const Planes d;
  const hn::RebindToSigned<Planes> di;
  const hn::Rebind<uint16_t, Planes> du16;
  const auto origin = hn::Set(d, base), scale = hn::Set(d, per_step);
  const auto zero = hn::Zero(d), last = hn::Set(d, 65535.0f);
  const auto low_steps = hn::Sub(hn::Mul(hn::Sub(low, origin), scale), hn::Set(d, 0.125f));
  const auto high_steps = hn::Add(hn::Mul(hn::Sub(high, origin), scale), hn::Set(d, 1.125f));
  const auto low_q = hn::ConvertTo(di, hn::Min(hn::Max(low_steps, zero), last));
  const auto high_q = hn::ConvertTo(di, hn::Min(hn::Max(high_steps, zero), last));
  hn::StoreU(hn::DemoteTo(du16, low_q), du16, low_to);
  hn::StoreU(hn::DemoteTo(du16, high_q), du16, high_to);
}

HWY_ATTR inline void store_record(const Children& children, const layout::BoxGrid& grid,
                                  const glm::vec3& per_step, WideNode& record) {
  const Planes d;
  for (uint32_t child = 0; child < wide_fan; child += static_cast<uint32_t>(hn::Lanes(d))) {
    hn::Vec<Planes> lo_x, lo_y, lo_z, hi_x, hi_y, hi_z, unused;
    hn::LoadInterleaved4(d, children.lo[child], lo_x, lo_y, lo_z, unused);
    hn::LoadInterleaved4(d, children.hi[child], hi_x, hi_y, hi_z, unused);
    auto& p = record.planes;
    store_planes(lo_x, hi_x, grid.base.x, per_step.x, p[0][0] + child, p[0][1] + child);
    store_planes(lo_y, hi_y, grid.base.y, per_step.y, p[1][0] + child, p[1][1] + child);
    store_planes(lo_z, hi_z, grid.base.z, per_step.z, p[2][0] + child, p[2][1] + child);
  }
}

HWY_ATTR inline BoundLanes quad_bound(const float* texels, uint64_t stride) {
  const Lanes4 a = load_lanes(texels), b = load_lanes(texels + 4), c = load_lanes(texels + 4 * stride),
               e = load_lanes(texels + 4 * stride + 4);
  return {min(min(a, b), min(c, e)), max(max(a, b), max(c, e))};
}

// Which child quad (x, y) of a block is.
constexpr uint32_t child_at(uint32_t x, uint32_t y) {
  return (x & 1) | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2;
}

// The 4 x 4 quads from a texel on.
HWY_ATTR inline void bound_block(const float* texels, uint64_t stride, Children& children) {
#if HWY_TARGET == HWY_SCALAR
  for (uint32_t i = 0; i < wide_fan; ++i) {
    const uint32_t x = i % 4, y = i / 4;
    set_child(children, child_at(x, y), quad_bound(texels + 4 * (x + y * stride), stride));
  }
#else
#if HWY_HAVE_SCALABLE
  constexpr size_t lanes = 4;
#else
  constexpr size_t lanes = HWY_MAX_BYTES / sizeof(float) < 16 ? HWY_MAX_BYTES / sizeof(float) : 16;
#endif
  constexpr uint32_t quads = lanes / 4;  // at once
  const hn::FixedTag<float, lanes> d;
  for (uint32_t x = 0; x < 4; x += quads) {
    const auto row = [&](uint32_t y, auto& lo, auto& hi) HWY_ATTR {
      const float* from = texels + 4 * (x + y * stride);
      const auto left = hn::LoadU(d, from), right = hn::LoadU(d, from + 4);
      lo = hn::Min(left, right);
      hi = hn::Max(left, right);
    };
    hn::Vec<decltype(d)> lo[5], hi[5];
    for (uint32_t y = 0; y < 5; ++y) row(y, lo[y], hi[y]);
    for (uint32_t y = 0; y < 4; ++y) {
      lo[y] = hn::Min(lo[y], lo[y + 1]);
      hi[y] = hn::Max(hi[y], hi[y + 1]);
    }
    for (uint32_t y = 0; y < 4; y += 2) {
      float *to_lo = children.lo[child_at(x, y)], *to_hi = children.hi[child_at(x, y)];
      if constexpr (quads == 4) {
        hn::Store(hn::ConcatLowerLower(d, lo[y + 1], lo[y]), d, to_lo);
        hn::Store(hn::ConcatUpperUpper(d, lo[y + 1], lo[y]), d, to_lo + 16);
        hn::Store(hn::ConcatLowerLower(d, hi[y + 1], hi[y]), d, to_hi);
        hn::Store(hn::ConcatUpperUpper(d, hi[y + 1], hi[y]), d, to_hi + 16);
      } else {  // the row below comes two quads later
        hn::Store(lo[y], d, to_lo);
        hn::Store(lo[y + 1], d, to_lo + 8);
        hn::Store(hi[y], d, to_hi);
        hn::Store(hi[y + 1], d, to_hi + 8);
      }
    }
  }
#endif
}

// An invocation is a record above leaves; whoever makes the last of 16, or of 256, makes the records above
// them as well.
template <class Probe>
class WideNodes : public Kernel<Probe> {
 public:
  using Kernel<Probe>::Kernel;

  HWY_ATTR void operator()(uint32_t index) {
    bound_group(index);
    uint32_t level = levels_.count() - 1;
    for (uint32_t risen = 0;; ++risen, --level, index /= wide_fan) {
      Children& children = children_[risen];
      store_record(children, push_.grid, per_step_, records_[render::WideLevels::first(level) + index]);
      this->probe.write(sizeof(WideNode) / 4);
      if (level == 0 || risen == wide_levels_at_once - 1) return;
      set_child(children_[risen + 1], index % wide_fan, joined(children));
      const bool last = index + 1 == levels_.records(level);
      if (!last && index % wide_fan != wide_fan - 1) return;
      for (uint32_t child = index % wide_fan + 1; child < wide_fan; ++child)
        set_child(children_[risen + 1], child, empty_bound());
    }
  }

 private:
  HWY_ATTR void bound_group(uint32_t index) {
    const glm::uvec4 block = this->load(blocks_, push_.first_item + index);
    // The blocks behind this one come in Morton order, which no processor foresees.
    const glm::uvec4 soon =
        blocks_.load4(push_.first_item + std::min(index + 8, levels_.records(levels_.count() - 1) - 1));
    if (soon.x != 0) {
      for (uint32_t y = 0; y <= 4; ++y)
        hwy::Prefetch(texels(push_.image, soon.y + std::min(y, soon.w >> 8) * soon.z));
    }
    if (block.x == 0) return bound_slots(index);
    const uint32_t width = block.w & 255, height = block.w >> 8;
    if (width == 4 && height == 4) {
      bound_block(texels(push_.image, block.y), block.z, children_[0]);
      this->probe.read(100);
      if (!moving_) return;
      Children next;
      bound_block(texels(push_.next_image, block.y), block.z, next);
      this->probe.read(100);
      for (uint32_t child = 0; child < wide_fan; ++child) {
        set_child(children_[0], child,
                  join({load_lanes(children_[0].lo[child]), load_lanes(children_[0].hi[child])},
                       {load_lanes(next.lo[child]), load_lanes(next.hi[child])}));
      }
      return;
    }
    for (uint32_t y = 0; y < 4; ++y) {
      for (uint32_t x = 0; x < 4; ++x) {
        const bool there = x < width && y < height;
        set_child(children_[0], child_at(x, y),
                  there ? bound_quad(block.y + x + y * block.z, block.z) : empty_bound());
      }
    }
  }

  HWY_ATTR void bound_slots(uint32_t index) {
    for (uint32_t child = 0; child < wide_fan; ++child) {
      const uint32_t slot = index * wide_fan + child;
      uint32_t texel = layout::empty_slot, stride = 0;
      if (slot < push_.count) {
        const uint64_t entry = 2 * (uint64_t(push_.first_slot) + slot);
        texel = this->load(leaf_map_, entry);
        stride = this->load(leaf_map_, entry + 1);
      }
      set_child(children_[0], child, texel == layout::empty_slot ? empty_bound() : bound_quad(texel, stride));
    }
  }

  HWY_ATTR BoundLanes bound_quad(uint32_t texel, uint32_t stride) {
    this->probe.read(16);
    const BoundLanes bound = quad_bound(texels(push_.image, texel), stride);
    if (!moving_) return bound;
    this->probe.read(16);
    return join(bound, quad_bound(texels(push_.next_image, texel), stride));
  }

  const float* texels(uint32_t image, uint32_t texel) const {
    return reinterpret_cast<const float*>(geometry_.words) + 4 * (uint64_t(image) + texel);
  }

  Words leaf_map_ = this->words(0);
  Quads geometry_ = this->quads(1), blocks_ = this->quads(2);
  layout::BoxesPush push_ = this->template push<layout::BoxesPush>();
  WideNode* records_ = reinterpret_cast<WideNode*>(this->words(3).words) + push_.first_node;
  render::WideLevels levels_{push_.depth, push_.count};
  bool moving_ = this->constant(0) != 0;
  glm::vec3 per_step_ = glm::vec3(1, 1, 1) / push_.grid.step;
  Children children_[wide_levels_at_once];
};

LODESTONE_BLOCK_FUNCTION(HWY_ATTR, wide_nodes, WideNodes)

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(wide_nodes_block);

namespace {

// Record `index` of `level` from those below it. All planes are whole numbers already.
void join_records(uint32_t level, uint32_t index, const render::WideLevels& levels, WideNode* records) {
  WideNode& record = records[render::WideLevels::first(level) + index];
  const uint32_t below = levels.records(level + 1);
  for (uint32_t c = 0; c < wide_fan; ++c) {
    const uint32_t child = index * wide_fan + c;
    for (int axis = 0; axis < 3; ++axis) {
      uint16_t lo = layout::box_last_plane, hi = 0;
      if (child < below) {
        const auto& planes = records[render::WideLevels::first(level + 1) + child].planes[axis];
        lo = *std::min_element(planes[0], planes[0] + wide_fan);
        hi = *std::max_element(planes[1], planes[1] + wide_fan);
      }
      record.planes[axis][0][c] = lo;
      record.planes[axis][1][c] = hi;
    }
  }
}

}  // namespace

void wide_nodes(const CpuDispatch& dispatch) {
  run_blocks(dispatch, wide_records_a_task, HWY_DYNAMIC_DISPATCH(wide_nodes_block));
  layout::BoxesPush push;
  std::memcpy(&push, dispatch.push.data(), sizeof(push));
  const render::WideLevels levels(push.depth, push.count);
  auto* records = reinterpret_cast<WideNode*>(dispatch.buffers[3]) + push.first_node;
  for (uint32_t level = levels.count(); level-- > 0;) {
    if (level + wide_levels_at_once >= levels.count()) continue;  // made with the leaves
    const uint32_t count = levels.records(level);
    for (uint32_t i = 0; i < count; ++i) join_records(level, i, levels, records);
    if (!dispatch.counting) continue;
    dispatch.counters->bytes_read += sizeof(WideNode) * uint64_t(levels.records(level + 1));
    dispatch.counters->bytes_written += sizeof(WideNode) * uint64_t(count);
  }
}

}  // namespace lodestone::cpu_fallback
#endif
