// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/passes/wide_nodes.h"

#include "lodestone/layout/atlas.h"
#include "lodestone/layout/frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lodestone/cpu_fallback/passes/wide_nodes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Planes = hn::CappedTag<float, wide_fan>;

// A plane in steps of the grid is off by less than 65536 * 4 * 2^-24 = 1/64 step: an eighth of slack rounds
// outwards.
HWY_ATTR inline void store_planes(hn::Vec<Planes> low, hn::Vec<Planes> high, float base, float per_step,
                                  uint16_t* HWY_RESTRICT low_to, uint16_t* HWY_RESTRICT high_to) {
  const Planes d;
  const hn::RebindToSigned<Planes> di;
  const hn::Rebind<uint16_t, Planes> du16;
  const auto origin = hn::Set(d, base), scale = hn::Set(d, per_step);
  const auto zero = hn::Zero(d), last = hn::Set(d, 65535.0f);
  const auto low_steps = hn::Sub(hn::Mul(hn::Sub(low, origin), scale), hn::Set(d, 0.125f));
  const auto high_steps = hn::Add(hn::Mul(hn::Sub(high, origin), scale), hn::Set(d, 1.125f));
  // The conversion truncates, and what it truncates is not negative.
  const auto low_q = hn::ConvertTo(di, hn::Min(hn::Max(low_steps, zero), last));
  const auto high_q = hn::ConvertTo(di, hn::Min(hn::Max(high_steps, zero), last));
  hn::StoreU(hn::DemoteTo(du16, low_q), du16, low_to);
  hn::StoreU(hn::DemoteTo(du16, high_q), du16, high_to);
}

// Records [begin, end) of a level whose children are the nodes from `lo` and `hi` on, `children` in all.
HWY_ATTR void quantise(const float* HWY_RESTRICT lo, const float* HWY_RESTRICT hi, uint32_t children,
                       const WideGrid& grid, WideNode* HWY_RESTRICT records, uint32_t begin, uint32_t end) {
  const Planes d;
  const uint32_t lanes = static_cast<uint32_t>(hn::Lanes(d));
  const glm::vec3 per_step = glm::vec3(1, 1, 1) / glm::vec3(grid.step);
  const auto empty = hn::Set(d, layout::infinity_bits_as_max);
  for (uint32_t r = begin; r < end; ++r) {
    WideNode& record = records[r];
    for (uint32_t child = 0; child < wide_fan; child += lanes) {
      const uint32_t node = r * wide_fan + child;
      hn::Vec<Planes> lo_x = empty, lo_y = empty, lo_z = empty, unused;
      hn::Vec<Planes> hi_x = hn::Neg(empty), hi_y = hi_x, hi_z = hi_x;
      if (node + lanes <= children) {
        hn::LoadInterleaved4(d, lo + 4 * uint64_t(node), lo_x, lo_y, lo_z, unused);
        hn::LoadInterleaved4(d, hi + 4 * uint64_t(node), hi_x, hi_y, hi_z, unused);
      } else if (node < children) {  // the last of its level, and not whole
        HWY_ALIGN float from[2][4 * wide_fan];
        for (uint32_t i = 0; i < 4 * lanes; ++i) {
          const bool there = node + i / 4 < children;
          from[0][i] = there ? lo[4 * uint64_t(node) + i] : layout::infinity_bits_as_max;
          from[1][i] = there ? hi[4 * uint64_t(node) + i] : -layout::infinity_bits_as_max;
        }
        hn::LoadInterleaved4(d, from[0], lo_x, lo_y, lo_z, unused);
        hn::LoadInterleaved4(d, from[1], hi_x, hi_y, hi_z, unused);
      }
      auto& p = record.planes;
      store_planes(lo_x, hi_x, grid.base.x, per_step.x, p[0][0] + child, p[0][1] + child);
      store_planes(lo_y, hi_y, grid.base.y, per_step.y, p[1][0] + child, p[1][1] + child);
      store_planes(lo_z, hi_z, grid.base.z, per_step.z, p[2][0] + child, p[2][1] + child);
    }
  }
}

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lodestone::cpu_fallback {

HWY_EXPORT(quantise);

void wide_nodes(const CpuDispatch& dispatch) {
  layout::BoundsPush push;
  std::memcpy(&push, dispatch.push.data(), sizeof(push));
  const uint64_t root = 4 * uint64_t(push.first_node);
  const auto* nodes_lo = reinterpret_cast<const float*>(dispatch.buffers[0]) + root;
  const auto* nodes_hi = reinterpret_cast<const float*>(dispatch.buffers[1]) + root;
  auto* records = reinterpret_cast<WideNode*>(dispatch.buffers[2]) + push.first_wide;
  const WideGrid grid({nodes_lo[0], nodes_lo[1], nodes_lo[2]}, {nodes_hi[0], nodes_hi[1], nodes_hi[2]});
  const render::WideLevels levels(push.depth, push.count);
  const auto quantise_records = HWY_DYNAMIC_DISPATCH(quantise);
  for (uint32_t k = 0; k < levels.count(); ++k) {
    const uint64_t first_node = 4 * uint64_t(layout::level_base(levels.child_level(k)));
    parallel_for(levels.records(k), 1024, [&](uint64_t begin, uint64_t end) {
      quantise_records(nodes_lo + first_node, nodes_hi + first_node, levels.children(k), grid,
                       records + render::WideLevels::first(k), static_cast<uint32_t>(begin),
                       static_cast<uint32_t>(end));
    });
    if (dispatch.counting) {
      dispatch.counters->bytes_read += 32 * uint64_t(levels.children(k));
      dispatch.counters->bytes_written += sizeof(WideNode) * uint64_t(levels.records(k));
    }
  }
}

}  // namespace lodestone::cpu_fallback
#endif
