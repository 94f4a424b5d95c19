// SPDX-License-Identifier: MIT
// One ray against the 16 grandchildren of a node at once (wide_nodes.h), and against the quads it enters
// several at a time. Included once a SIMD target.

#if defined(LODESTONE_SINGLE_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_SINGLE_RAY_INL_H_
#undef LODESTONE_SINGLE_RAY_INL_H_
#else
#define LODESTONE_SINGLE_RAY_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <limits>

#include "lodestone/cpu_fallback/passes/trace_block.h"
#include "lodestone/cpu_fallback/passes/wide_nodes.h"
#include "lodestone/layout/bounds.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Boxes = hn::CappedTag<float, wide_fan>;

// The distance to plane q of an axis is q * scale + offset, and no sharper than layout's slab distance to the
// plane that q was rounded from: `slack` covers the rounding on both sides, which is below 2^-22 of the
// largest terms.
struct SlabLanes {
  float scale, near_offset, far_offset;
  uint32_t near_plane;  // 0: the low one comes first along the ray
};

HWY_ATTR inline SlabLanes slab_lanes(float base, float step, float near_origin, float far_origin,
                                     float inverse) {
  const float scale = step * inverse, near_offset = (base - near_origin) * inverse,
              far_offset = (base - far_origin) * inverse;
  const float reach = std::abs(scale) * 65536.0f;
  return {scale, near_offset - (reach + std::abs(near_offset)) * 0x1p-21f,
          far_offset + (reach + std::abs(far_offset)) * 0x1p-21f, inverse < 0 ? 1u : 0u};
}

// A ray made ready.
struct SingleRay {
  layout::Ray ray;
  layout::Slabs slabs;
  layout::Shear shear;
  SlabLanes axes[3];

  SingleRay() = default;
  HWY_ATTR HWY_FLATTEN SingleRay(const layout::Ray& r, float extent, const WideGrid& grid)
      : ray(r), slabs(layout::make_slabs(r, extent)), shear(layout::make_shear(r)) {
    for (int i = 0; i < 3; ++i) {
      axes[i] =
          slab_lanes(grid.base[i], grid.step[i], slabs.near_origin[i], slabs.far_origin[i], slabs.inverse[i]);
    }
  }
};

// A mask of at most 16 lanes as bits.
template <class D>
HWY_ATTR inline uint32_t mask_bits(D d, hn::Mask<D> mask) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return uint32_t(bytes[0]) | uint32_t(bytes[1]) << 8;
}

template <class D>
HWY_ATTR inline hn::Mask<D> bit_mask(D d, uint64_t bits) {
  return hn::LoadMaskBits(d, reinterpret_cast<const uint8_t*>(&bits));
}

HWY_ATTR inline hn::Vec<Boxes> plane_distances(const uint16_t* HWY_RESTRICT planes, float scale,
                                               float offset) {
  const Boxes d;
  const hn::RebindToSigned<Boxes> di;
  const hn::Rebind<uint16_t, Boxes> du16;
  const auto steps = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(du16, planes)));
  return hn::MulAdd(steps, hn::Set(d, scale), hn::Set(d, offset));
}

// The children of a record that a ray enters.
struct Entered {
  HWY_ALIGN float enter[wide_fan];  // how far away each is at least
  uint32_t hits;                    // their bits

  HWY_ATTR uint32_t nearest() const {
    if ((hits & (hits - 1)) == 0) return static_cast<uint32_t>(std::countr_zero(hits));
    const Boxes d;
    auto least = hn::Set(d, std::numeric_limits<float>::infinity());
    for (uint32_t i = 0; i < wide_fan; i += static_cast<uint32_t>(hn::Lanes(d))) {
      least = hn::Min(least, hn::IfThenElse(bit_mask(d, hits >> i), hn::Load(d, enter + i), least));
    }
    least = hn::MinOfLanes(d, least);
    uint32_t at = 0;
    for (uint32_t i = 0; i < wide_fan; i += static_cast<uint32_t>(hn::Lanes(d))) {
      at |= mask_bits(d, hn::Eq(hn::Load(d, enter + i), least)) << i;
    }
    return static_cast<uint32_t>(std::countr_zero(at & hits));
  }
};

HWY_ATTR inline void test_boxes(const WideNode& node, const SingleRay& ray, float tmax, Entered& entered) {
  const Boxes d;
  const auto& [x, y, z] = ray.axes;
  entered.hits = 0;
  for (uint32_t i = 0; i < wide_fan; i += static_cast<uint32_t>(hn::Lanes(d))) {
    const auto enter_x = plane_distances(node.planes[0][x.near_plane] + i, x.scale, x.near_offset);
    const auto enter_y = plane_distances(node.planes[1][y.near_plane] + i, y.scale, y.near_offset);
    const auto enter_z = plane_distances(node.planes[2][z.near_plane] + i, z.scale, z.near_offset);
    const auto exit_x = plane_distances(node.planes[0][x.near_plane ^ 1] + i, x.scale, x.far_offset);
    const auto exit_y = plane_distances(node.planes[1][y.near_plane ^ 1] + i, y.scale, y.far_offset);
    const auto exit_z = plane_distances(node.planes[2][z.near_plane ^ 1] + i, z.scale, z.far_offset);
    const auto from = hn::Max(hn::Max(enter_x, enter_y), hn::Max(enter_z, hn::Set(d, ray.ray.tmin)));
    const auto to = hn::Min(hn::Min(exit_x, exit_y), hn::Min(exit_z, hn::Set(d, tmax)));
    const auto inside = hn::Le(from, to);
    hn::Store(from, d, entered.enter + i);
    entered.hits |= mask_bits(d, inside) << i;
  }
}

// The exact test of one quad whose edge functions have let the ray through.
template <class Block>
HWY_ATTR HWY_FLATTEN HWY_NOINLINE void accept_quad(const Block& block, const SingleRay& ray, uint32_t texel,
                                                   uint32_t stride, layout::Hit& best) {
  const glm::vec3 a = block.texel(texel), b = block.texel(texel + 1);
  const glm::vec3 c = block.texel(texel + stride), e = block.texel(texel + stride + 1);
  const layout::Bound bound = layout::quad_bound(a, b, c, e);
  const float enter = layout::slab_enter(ray.slabs, bound.lo, bound.hi, ray.ray.tmin);
  if (!(enter <= layout::slab_exit(ray.slabs, bound.lo, bound.hi, best.t))) return;
  layout::intersect_quad(a, b, c, e, ray.ray, ray.shear, enter, texel, best);
}

// Quads are tested in the blocks of four lanes of a vector, a corner a lane. (A vector of unknown length
// counts as one block.)
#if HWY_TARGET != HWY_SCALAR
#if HWY_HAVE_SCALABLE
constexpr size_t corner_lanes = 4;
#else
constexpr size_t corner_lanes = HWY_MAX_BYTES / sizeof(float);
#endif
constexpr uint32_t quads_at_once = corner_lanes / 4;
using Corners = hn::FixedTag<float, corner_lanes>;

template <size_t lanes>
HWY_ATTR inline auto load_blocks(const float* const* from) {
  const hn::FixedTag<float, lanes> d;
  if constexpr (lanes == 4) {
    return hn::LoadU(d, *from);
  } else {
    return hn::Combine(d, load_blocks<lanes / 2>(from + lanes / 8), load_blocks<lanes / 2>(from));
  }
}

struct Indices {
  alignas(64) int32_t lane[corner_lanes];
};
constexpr Indices in_blocks(int32_t a, int32_t b, int32_t c, int32_t e) {
  Indices indices{};
  const int32_t block[4] = {a, b, c, e};
  for (size_t i = 0; i < corner_lanes; ++i) indices.lane[i] = block[i % 4] + static_cast<int32_t>(i / 4 * 4);
  return indices;
}

// Four values a quad. edges: of a b, b c, c a, d c; bd: of b d, four times; t: along the ray, of the corners.
struct QuadLanes {
  alignas(64) float edges[corner_lanes], bd[corner_lanes], t[corner_lanes];
};

// layout::intersect_quad's edge functions for up to `quads_at_once` quads; returns a bit a quad: the ray
// passes one of its triangles.
template <class Block>
HWY_ATTR inline uint32_t pass_edges(const Block& block, const SingleRay& ray, const uint32_t* texels,
                                    const uint32_t* strides, QuadLanes& lanes) {
  const Corners d;
  const hn::Repartition<uint64_t, Corners> pairs;
  const float* from[4][quads_at_once];
  for (uint32_t i = 0; i < quads_at_once; ++i) {
    from[0][i] = block.texels(texels[i]);
    from[1][i] = from[0][i] + 4;
    from[2][i] = block.texels(texels[i] + strides[i]);
    from[3][i] = from[2][i] + 4;
  }
  const auto a = load_blocks<corner_lanes>(from[0]), b = load_blocks<corner_lanes>(from[1]);
  const auto c = load_blocks<corner_lanes>(from[2]), e = load_blocks<corner_lanes>(from[3]);
  const auto ab = hn::BitCast(pairs, hn::InterleaveLower(d, a, b)),
             ce = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
  const auto ab_z = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b)),
             ce_z = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
  const auto x = hn::Sub(hn::BitCast(d, hn::InterleaveLower(pairs, ab, ce)), hn::Set(d, ray.ray.origin.x));
  const auto y = hn::Sub(hn::BitCast(d, hn::InterleaveUpper(pairs, ab, ce)), hn::Set(d, ray.ray.origin.y));
  const auto z =
      hn::Sub(hn::BitCast(d, hn::InterleaveLower(pairs, ab_z, ce_z)), hn::Set(d, ray.ray.origin.z));
  const hn::RebindToUnsigned<Corners> du;
  const auto axis = hn::Set(du, ray.shear.axis);
  const auto along_x = hn::RebindMask(d, hn::Eq(axis, hn::Zero(du))),
             along_y = hn::RebindMask(d, hn::Eq(axis, hn::Set(du, 1)));
  const auto depth = hn::IfThenElse(along_x, x, hn::IfThenElse(along_y, y, z));
  const auto px = hn::Sub(hn::IfThenElse(along_x, y, hn::IfThenElse(along_y, z, x)),
                          hn::Mul(hn::Set(d, ray.shear.x), depth));
  const auto py = hn::Sub(hn::IfThenElse(along_x, z, hn::IfThenElse(along_y, x, y)),
                          hn::Mul(hn::Set(d, ray.shear.y), depth));
  // Edges a b, b c, c a, d c in the block's lanes; b d in all of them.
  static constexpr Indices ends = in_blocks(1, 2, 0, 2), bs = in_blocks(1, 1, 1, 1),
                           ds = in_blocks(3, 3, 3, 3);
  const auto to = hn::SetTableIndices(d, ends.lane), at_b = hn::SetTableIndices(d, bs.lane),
             at_d = hn::SetTableIndices(d, ds.lane);
  const auto edges =
      hn::Sub(hn::Mul(px, hn::TableLookupLanes(py, to)), hn::Mul(py, hn::TableLookupLanes(px, to)));
  const auto bd = hn::Sub(hn::Mul(hn::TableLookupLanes(px, at_b), hn::TableLookupLanes(py, at_d)),
                          hn::Mul(hn::TableLookupLanes(py, at_b), hn::TableLookupLanes(px, at_d)));
  hn::Store(edges, d, lanes.edges);
  hn::Store(bd, d, lanes.bd);
  hn::Store(hn::Mul(hn::Set(d, ray.shear.z), depth), d, lanes.t);
  const auto zero = hn::Zero(d);
  const uint32_t plus = mask_bits(d, hn::Ge(edges, zero)), minus = mask_bits(d, hn::Le(edges, zero));
  const uint32_t bd_plus = mask_bits(d, hn::Ge(bd, zero)), bd_minus = mask_bits(d, hn::Le(bd, zero));
  uint32_t passed = 0;
  for (uint32_t i = 0; i < quads_at_once; ++i) {
    const uint32_t p = plus >> (4 * i), m = minus >> (4 * i);
    const bool first = (p & 7) == 7 || (m & 7) == 7;
    // d c b has the edge b c the other way round: its function has the other sign.
    const bool second = ((m & 2) != 0 && (p & 8) != 0 && (bd_plus >> (4 * i) & 1) != 0) ||
                        ((p & 2) != 0 && (m & 8) != 0 && (bd_minus >> (4 * i) & 1) != 0);
    if (first || second) passed |= 1u << i;
  }
  return passed;
}

// Whether a ray that passes a triangle of the quad meets it beyond tmin and no farther than `best`. Most do
// not: a ray passes the quad that it starts on.
HWY_ATTR inline bool may_hit(const QuadLanes& lanes, uint32_t quad, float tmin, float tmax) {
  const float* w = lanes.edges + 4 * quad;
  const float* t = lanes.t + 4 * quad;
  const float bd = lanes.bd[4 * quad];
  const float t_first = (w[1] * t[0] + w[2] * t[1] + w[0] * t[2]) / (w[1] + w[2] + w[0]);
  const float t_second = (-w[1] * t[3] + bd * t[2] + w[3] * t[1]) / (-w[1] + bd + w[3]);
  return (t_first > tmin && t_first <= tmax) || (t_second > tmin && t_second <= tmax);
}
#endif

// The quads of a record's children `hits`.
template <class Block>
HWY_ATTR inline void test_quads(Block& block, const SingleRay& ray, uint32_t first_slot, uint32_t hits,
                                const float* enter, layout::Hit& best) {
#if HWY_TARGET == HWY_SCALAR
  constexpr uint32_t quads_at_once = 1;
#endif
  uint32_t texels[quads_at_once], strides[quads_at_once];
  while (hits != 0) {
    uint32_t count = 0;
    for (; hits != 0 && count < quads_at_once; hits &= hits - 1) {
      const auto child = static_cast<uint32_t>(std::countr_zero(hits));
      if (enter[child] > best.t || !block.leaf(first_slot + child, texels[count], strides[count])) continue;
      ++count;
    }
    if (count == 0) return;
    block.count_quads(count);
#if HWY_TARGET == HWY_SCALAR
    accept_quad(block, ray, texels[0], strides[0], best);
#else
    for (uint32_t i = count; i < quads_at_once; ++i) {
      texels[i] = texels[0];
      strides[i] = strides[0];
    }
    QuadLanes lanes;
    uint32_t passed = pass_edges(block, ray, texels, strides, lanes) & ((1u << count) - 1);
    for (; passed != 0; passed &= passed - 1) {
      const auto i = static_cast<uint32_t>(std::countr_zero(passed));
      if (may_hit(lanes, i, ray.ray.tmin, best.t)) accept_quad(block, ray, texels[i], strides[i], best);
    }
#endif
  }
}

// What is still to be visited.
struct Stack {
  // A vector may be stored behind the last entry.
  float enter[wide_fan * (layout::max_depth / 2 + 2)];
  uint32_t record[wide_fan * (layout::max_depth / 2 + 2)];
  uint32_t size = 0;

  // The children `rest` of a record, in no order.
  HWY_ATTR void push(const Entered& entered, uint32_t rest, uint32_t first_child) {
    const Boxes d;
    const hn::RebindToUnsigned<Boxes> du;
    for (uint32_t i = 0; i < wide_fan; i += static_cast<uint32_t>(hn::Lanes(d))) {
      const auto chosen = bit_mask(d, rest >> i);
      // In a register, then a plain store: compressing stores take a hundred cycles on some processors.
      hn::StoreU(hn::Compress(hn::Load(d, entered.enter + i), chosen), d, enter + size);
      hn::StoreU(hn::Compress(hn::Iota(du, first_child + i), hn::RebindMask(du, chosen)), du, record + size);
      size += static_cast<uint32_t>(hn::CountTrue(d, chosen));
    }
  }

  // The record on top that lies before `tmax`; false: there is none left.
  bool pop(float tmax, uint32_t& next) {
    while (size != 0) {
      --size;
      if (enter[size] > tmax) continue;
      next = record[size];
      return true;
    }
    return false;
  }
};

// One ray on its way.
struct Flight {
  SingleRay ray;
  layout::Hit best;
  uint32_t index, record, visits;
  Stack stack;
};

// Starts ray `index`; false: it needs no step.
template <class Block>
HWY_ATTR inline bool start(Block& block, uint32_t index, Flight& flight) {
  if (!block.wanted(index)) return false;
  const layout::Ray ray = block.ray(index);
  flight.best = {ray.tmax, 0, 0, layout::no_index};
  if (ray.tmax < 0.0f) {
    block.finish(index, ray, flight.best, 0);
    return false;
  }
  flight.ray = SingleRay(ray, block.extent(), block.grid());
  flight.index = index;
  flight.record = flight.visits = 0;
  flight.stack.size = 0;
  return true;
}

// Visits a record and finds the next; false: there is none.
template <class Block>
HWY_ATTR inline bool step(Block& block, Flight& flight) {
  const uint32_t first_leaf = block.first_leaf_record(), end = block.end_record();
  const uint32_t record = flight.record;
  Entered entered;
  test_boxes(block.wide_node(record), flight.ray, flight.best.t, entered);
  block.count_record();
  ++flight.visits;
  if (record >= first_leaf) {
    if (entered.hits != 0) {
      test_quads(block, flight.ray, (record - first_leaf) * wide_fan, entered.hits, entered.enter,
                 flight.best);
      if (block.any_hit() && flight.best.primitive != layout::no_index) return false;
    }
  } else if (entered.hits != 0) {
    // On to the nearest; the others wait.
    const uint32_t child = entered.nearest();
    const uint32_t first_child = wide_fan * record + 1;
    if (const uint32_t rest = entered.hits & ~(1u << child); rest != 0)
      flight.stack.push(entered, rest, first_child);
    flight.record = first_child + child;
    if (flight.record < end) return true;  // or else an empty child, entered by rounding
  }
  do {
    if (!flight.stack.pop(flight.best.t, flight.record)) return false;
  } while (flight.record >= end);
  return true;
}

// Each ray waits for one record after the other: so several are on their way, a step of one while the caches
// fetch what the others need.
constexpr uint32_t flights_at_once = 6;

template <class Block>
HWY_ATTR inline void trace_singles(Block& block, const uint32_t* indices, uint32_t count) {
  Flight flights[flights_at_once];
  Flight* active[flights_at_once];
  uint32_t next = 0, size = 0;
  const auto fill = [&](Flight& flight) HWY_ATTR {
    while (next < count) {
      if (start(block, indices[next++], flight)) return true;
    }
    return false;
  };
  while (size < flights_at_once && fill(flights[size])) {
    active[size] = &flights[size];
    ++size;
  }
  while (size != 0) {
    for (uint32_t i = 0; i < size; ++i) {
      Flight& flight = *active[i];
      if (step(block, flight)) {
        hwy::Prefetch(&block.wide_node(flight.record).planes[0]);
        hwy::Prefetch(&block.wide_node(flight.record).planes[1]);
        hwy::Prefetch(&block.wide_node(flight.record).planes[2]);
        continue;
      }
      block.finish(flight.index, flight.ray.ray, flight.best, flight.visits);
      if (!fill(flight)) active[i] = active[--size];
    }
  }
}

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
