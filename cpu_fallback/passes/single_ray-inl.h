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
#include <optional>

#include "lodestone/cpu_fallback/passes/lanes-inl.h"
#include "lodestone/cpu_fallback/passes/trace_block.h"
#include "lodestone/cpu_fallback/passes/wide_nodes.h"
#include "lodestone/layout/bounds.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Boxes = hn::CappedTag<float, wide_fan>;

// A ray made ready, its axes in lanes.
//
// The distance to plane q of an axis is q * scale + offset, and no sharper than layout's slab distance to the
// plane that q was rounded from: the offsets have slack for the rounding on both sides, which is below 2^-22
// of the largest terms.
struct SingleRay {
  layout::Ray ray;
  float extent;   // of the hierarchy
  uint32_t next;  // layout::accept_triangle
  alignas(16) float scale[4], near_offset[4], far_offset[4];
  uint32_t near_plane[3];  // 0: the low one comes first along the ray
  layout::Shear shear;
  alignas(16) float turned_origin[4];  // in the order of coordinates that shear.axis gives
};

// For each shear axis: which coordinates become x, y and z (layout::sheared).
alignas(16) inline constexpr int32_t shear_turns[3][4] = {{1, 2, 0, 3}, {2, 0, 1, 3}, {0, 1, 2, 3}};

// `from`: a ray's two quads.
HWY_ATTR inline void make_ready(const float* from, const TraceTree& tree, SingleRay& ready) {
  const float extent = ready.extent = tree.extent();
  const layout::BoxGrid& grid = tree.grid();
  // In lane w z once more, not tmin and tmax: products with an infinite ray's reciprocal would be denormal,
  // and some processors take a hundred cycles for each.
  const Lanes4 origin = permuted<0, 1, 2, 2>(load_lanes(from)),
               along = permuted<0, 1, 2, 2>(load_lanes(from + 4));
  const Lanes4 size = abs(along), height = abs(origin);
  ready.ray = {{from[0], from[1], from[2]}, from[3], {from[4], from[5], from[6]}, from[7]};

  // layout::make_slabs
  const Lanes4 positive = all_lanes(1) / max(size, all_lanes(0x1p-40f));
  const Lanes4 inverse = where_negative(along, all_lanes(0) - positive, positive);
  const Lanes4 reach = max(max(all_lanes(extent), lane<0>(height)), max(lane<1>(height), lane<2>(height)));
  const Lanes4 margin = reach * all_lanes(layout::slab_margin);
  const Lanes4 outwards = where_negative(along, all_lanes(0) - margin, margin);

  const Lanes4 base = load_lanes(&grid.base.x), slack = all_lanes(0x1p-21f);
  const Lanes4 scale = load_lanes(&grid.step.x) * inverse, range = abs(scale) * all_lanes(65536);
  const Lanes4 near_offset = (base - (origin + outwards)) * inverse,
               far_offset = (base - (origin - outwards)) * inverse;
  store_lanes(scale, ready.scale);
  store_lanes(near_offset - (range + abs(near_offset)) * slack, ready.near_offset);
  store_lanes(far_offset + (range + abs(far_offset)) * slack, ready.far_offset);
  for (int i = 0; i < 3; ++i) ready.near_plane[i] = from[4 + i] < 0 ? 1 : 0;

  // layout::make_shear
  const float x = std::abs(from[4]), y = std::abs(from[5]), z = std::abs(from[6]);
  const uint32_t axis = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
  const Lanes4 turned = permuted(along, shear_turns[axis]), depth = lane<2>(turned);
  const Lanes4 shear = turned / depth;
  ready.shear = {axis, first_lane(shear), first_lane(lane<1>(shear)), first_lane(all_lanes(1) / depth)};
  store_lanes(permuted(origin, shear_turns[axis]), ready.turned_origin);
}

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
  HWY_ALIGN float enter[wide_fan];  // how far away each is at least; infinity: not entered
  uint32_t hits;                    // their bits

  HWY_ATTR uint32_t nearest() const {
    if ((hits & (hits - 1)) == 0) return static_cast<uint32_t>(std::countr_zero(hits));
    const Boxes d;
    auto least = hn::Load(d, enter);
    for (uint32_t i = static_cast<uint32_t>(hn::Lanes(d)); i < wide_fan;
         i += static_cast<uint32_t>(hn::Lanes(d)))
      least = hn::Min(least, hn::Load(d, enter + i));
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
  const auto& [scale_x, scale_y, scale_z, scale_w] = ray.scale;
  const auto& [near_x, near_y, near_z, near_w] = ray.near_offset;
  const auto& [far_x, far_y, far_z, far_w] = ray.far_offset;
  const auto& [x, y, z] = ray.near_plane;
  const auto nowhere = hn::Set(d, std::numeric_limits<float>::infinity());
  entered.hits = 0;
  for (uint32_t i = 0; i < wide_fan; i += static_cast<uint32_t>(hn::Lanes(d))) {
    const auto enter_x = plane_distances(node.planes[0][x] + i, scale_x, near_x);
    const auto enter_y = plane_distances(node.planes[1][y] + i, scale_y, near_y);
    const auto enter_z = plane_distances(node.planes[2][z] + i, scale_z, near_z);
    const auto exit_x = plane_distances(node.planes[0][x ^ 1] + i, scale_x, far_x);
    const auto exit_y = plane_distances(node.planes[1][y ^ 1] + i, scale_y, far_y);
    const auto exit_z = plane_distances(node.planes[2][z ^ 1] + i, scale_z, far_z);
    const auto from = hn::Max(hn::Max(enter_x, enter_y), hn::Max(enter_z, hn::Set(d, ray.ray.tmin)));
    const auto to = hn::Min(hn::Min(exit_x, exit_y), hn::Min(exit_z, hn::Set(d, tmax)));
    const auto inside = hn::Le(from, to);
    hn::Store(hn::IfThenElse(inside, from, nowhere), d, entered.enter + i);
    entered.hits |= mask_bits(d, inside) << i;
  }
}

// The exact test of one quad whose edge functions have let the ray through.
template <class Block>
HWY_ATTR HWY_FLATTEN HWY_NOINLINE void accept_quad(Block& block, const SingleRay& ray,
                                                   const typename Block::Moving& moving, uint32_t texel,
                                                   uint32_t stride, layout::Hit& best) {
  const glm::vec3 a = block.texel(texel, moving), b = block.texel(texel + 1, moving);
  const glm::vec3 c = block.texel(texel + stride, moving), e = block.texel(texel + stride + 1, moving);
  const layout::Bound bound = layout::quad_bound(a, b, c, e);
  const layout::Slabs slabs = layout::make_slabs(ray.ray, ray.extent);
  const float enter = layout::slab_enter(slabs, bound.lo, bound.hi, ray.ray.tmin);
  if (!(enter <= layout::slab_exit(slabs, bound.lo, bound.hi, best.t))) return;
  layout::intersect_quad(a, b, c, e, ray.ray, ray.shear, ray.next, enter, texel, best);
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

// layout::intersect_quad's edge functions for up to `quads_at_once` quads; returns a bit a quad, four apart:
// the ray passes one of its triangles.
template <class Block>
HWY_ATTR inline uint32_t pass_edges(Block& block, const SingleRay& ray, const typename Block::Moving& moving,
                                    const uint32_t* texels, const uint32_t* strides, QuadLanes& lanes) {
  const Corners d;
  const hn::Repartition<uint64_t, Corners> pairs;
  const float* from[4][quads_at_once];
  float moved[quads_at_once][16];
  for (uint32_t i = 0; i < quads_at_once; ++i) {
    if (block.moves()) {
      block.moved_corners(texels[i], strides[i], moving, moved[i]);
      for (uint32_t corner = 0; corner < 4; ++corner) from[corner][i] = moved[i] + 4 * corner;
      continue;
    }
    from[0][i] = block.texels(texels[i]);
    from[1][i] = from[0][i] + 4;
    from[2][i] = block.texels(texels[i] + strides[i]);
    from[3][i] = from[2][i] + 4;
  }
  // A corner a block, coordinates in the order that shears it, relative to the origin.
  static constexpr Indices turns[3] = {in_blocks(1, 2, 0, 3), in_blocks(2, 0, 1, 3), in_blocks(0, 1, 2, 3)};
  const auto turn = hn::SetTableIndices(d, turns[ray.shear.axis].lane);
  const auto origin = hn::LoadDup128(d, ray.turned_origin);
  const auto corner = [&](const float* const* blocks) HWY_ATTR {
    return hn::Sub(hn::TableLookupLanes(load_blocks<corner_lanes>(blocks), turn), origin);
  };
  const auto a = corner(from[0]), b = corner(from[1]), c = corner(from[2]), e = corner(from[3]);
  // Coordinates side by side, a corner a lane.
  const auto ab = hn::BitCast(pairs, hn::InterleaveLower(d, a, b)),
             ce = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
  const auto ab_z = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b)),
             ce_z = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
  const auto x = hn::BitCast(d, hn::InterleaveLower(pairs, ab, ce)),
             y = hn::BitCast(d, hn::InterleaveUpper(pairs, ab, ce)),
             depth = hn::BitCast(d, hn::InterleaveLower(pairs, ab_z, ce_z));
  const auto px = hn::Sub(x, hn::Mul(hn::Set(d, ray.shear.x), depth));
  const auto py = hn::Sub(y, hn::Mul(hn::Set(d, ray.shear.y), depth));
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
  // At the first bit of each block: a b c has its first three edges on one side; d c b has the edge b c the
  // other way round, whose function has the other sign.
  const uint32_t first = (plus & plus >> 1 & plus >> 2) | (minus & minus >> 1 & minus >> 2);
  const uint32_t second = (minus >> 1 & plus >> 3 & bd_plus) | (plus >> 1 & minus >> 3 & bd_minus);
  return (first | second) & 0x1111;
}

// Whether a ray that passes a triangle of the quad meets it at tmin or beyond and no farther than `best`.
// Most do not: a ray passes the quad that it starts on.
HWY_ATTR inline bool may_hit(const QuadLanes& lanes, uint32_t quad, float tmin, float tmax) {
  const float* w = lanes.edges + 4 * quad;
  const float* t = lanes.t + 4 * quad;
  const float bd = lanes.bd[4 * quad];
  const float t_first = (w[1] * t[0] + w[2] * t[1] + w[0] * t[2]) / (w[1] + w[2] + w[0]);
  const float t_second = (-w[1] * t[3] + bd * t[2] + w[3] * t[1]) / (-w[1] + bd + w[3]);
  return (t_first >= tmin && t_first <= tmax) || (t_second >= tmin && t_second <= tmax);
}
#endif

// The quads of a record's children `hits`.
template <class Block>
HWY_ATTR inline void test_quads(Block& block, const TraceTree& tree, const SingleRay& ray,
                                const typename Block::Moving& moving, uint32_t first_slot, uint32_t hits,
                                const float* enter, layout::Hit& best) {
#if HWY_TARGET == HWY_SCALAR
  constexpr uint32_t quads_at_once = 1;
#endif
  uint32_t texels[quads_at_once], strides[quads_at_once];
  while (hits != 0) {
    uint32_t count = 0;
    for (; hits != 0 && count < quads_at_once; hits &= hits - 1) {
      const auto child = static_cast<uint32_t>(std::countr_zero(hits));
      if (enter[child] > best.t || !tree.leaf(first_slot + child, texels[count], strides[count])) continue;
      ++count;
    }
    if (count == 0) return;
    block.count_quads(count);
#if HWY_TARGET == HWY_SCALAR
    accept_quad(block, ray, moving, texels[0], strides[0], best);
#else
    for (uint32_t i = count; i < quads_at_once; ++i) {
      texels[i] = texels[0];
      strides[i] = strides[0];
    }
    QuadLanes lanes;
    uint32_t passed = pass_edges(block, ray, moving, texels, strides, lanes) & ((1u << 4 * count) - 1);
    for (; passed != 0; passed &= passed - 1) {
      const auto i = static_cast<uint32_t>(std::countr_zero(passed)) / 4;
      if (may_hit(lanes, i, ray.ray.tmin, best.t))
        accept_quad(block, ray, moving, texels[i], strides[i], best);
    }
#endif
  }
}

// The set bits of each byte, lowest first.
struct BitPlaces {
  alignas(64) uint8_t places[256][8];
};
constexpr BitPlaces find_bit_places() {
  BitPlaces table{};
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t size = 0;
    for (uint8_t bit = 0; bit < 8; ++bit) {
      if ((byte >> bit & 1u) != 0) table.places[byte][size++] = bit;
    }
  }
  return table;
}

// The lanes of `v` whose bits are set, side by side. Compress without compilers' copying its table each time.
template <class D>
HWY_ATTR inline hn::Vec<D> packed(D d, hn::Vec<D> v, uint32_t bits) {
#if HWY_MAX_BYTES / 4 > 8
  return hn::Compress(v, bit_mask(d, bits));
#elif HWY_TARGET == HWY_SCALAR
  (void)d, (void)bits;
  return v;
#else
  static constexpr BitPlaces table = find_bit_places();
  const hn::RebindToSigned<D> di;
  const hn::Rebind<uint8_t, D> du8;
  const auto places = hn::PromoteTo(di, hn::LoadU(du8, table.places[bits & ((1u << hn::Lanes(d)) - 1)]));
  return hn::TableLookupLanes(v, hn::IndicesFromVec(d, places));
#endif
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
      const uint32_t chosen = rest >> i & ((uint32_t(1) << hn::Lanes(d)) - 1);
      // In a register, then a plain store: compressing stores take a hundred cycles on some processors.
      hn::StoreU(packed(d, hn::Load(d, entered.enter + i), chosen), d, enter + size);
      hn::StoreU(packed(du, hn::Iota(du, first_child + i), chosen), du, record + size);
      size += static_cast<uint32_t>(std::popcount(chosen));
    }
  }

  // From record `at` to the nearest child that was entered; the others wait. False: it is an empty one,
  // entered by rounding. `end`: of the records.
  HWY_ATTR bool descend(const Entered& entered, uint32_t end, uint32_t& at) {
    const uint32_t child = entered.nearest(), first_child = wide_fan * at + 1;
    if (const uint32_t rest = entered.hits & ~(1u << child); rest != 0) push(entered, rest, first_child);
    at = first_child + child;
    return at < end;
  }

  // The same, and those that wait do so in order, the nearest on top. One by one to their places, which takes
  // less than vectors do where few are entered; single rays, several of which are on their way at once, would
  // have more branches foretold wrongly than the order saves.
  HWY_ATTR bool descend_in_order(const Entered& entered, uint32_t end, uint32_t& at) {
    const uint32_t first_child = wide_fan * at + 1, bottom = size;
    for (uint32_t hits = entered.hits; hits != 0; hits &= hits - 1) {
      const auto child = static_cast<uint32_t>(std::countr_zero(hits));
      const float distance = entered.enter[child];
      uint32_t place = size++;
      for (; place > bottom && enter[place - 1] < distance; --place) {
        enter[place] = enter[place - 1];
        record[place] = record[place - 1];
      }
      enter[place] = distance;
      record[place] = first_child + child;
    }
    at = record[--size];
    return at < end;
  }

  // To what waits and lies before `tmax`; false: nothing does.
  bool climb(float tmax, uint32_t end, uint32_t& at) {
    do {
      if (!pop(tmax, at)) return false;
    } while (at >= end);
    return true;
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
template <class Block>
struct Flight {
  std::optional<TraceTree> tree;
  SingleRay ray;
  typename Block::Moving moving;
  layout::Hit best;
  uint32_t index, record, visits;
  Stack stack;
};

// Starts ray `index`; false: it needs no step.
template <class Block>
HWY_ATTR inline bool start(Block& block, uint32_t index, Flight<Block>& flight) {
  if (!block.wanted(index)) return false;
  const layout::Ray ray = block.ray(index);
  flight.best = {ray.tmax, 0, 0, layout::no_index};
  if (ray.tmax < 0.0f) {
    block.finish(index, false, flight.best, 0);
    return false;
  }
  flight.tree = block.tree(index, flight.moving);
  make_ready(block.ray_quads(index), *flight.tree, flight.ray);
  flight.ray.next = block.next(index);
  flight.index = index;
  flight.record = flight.visits = 0;
  flight.stack.size = 0;
  return true;
}

// Visits a record and finds the next; false: there is none.
template <class Block>
HWY_ATTR inline bool step(Block& block, Flight<Block>& flight) {
  const TraceTree& tree = *flight.tree;
  const uint32_t first_leaf = tree.first_leaf_record(), end = tree.end_record();
  const uint32_t record = flight.record;
  Entered entered;
  test_boxes(tree.wide_node(record), flight.ray, flight.best.t, entered);
  block.count_record(1);
  ++flight.visits;
  if (record >= first_leaf) {
    if (entered.hits != 0) {
      test_quads(block, tree, flight.ray, flight.moving, (record - first_leaf) * wide_fan, entered.hits,
                 entered.enter, flight.best);
      if (block.any_hit() && flight.best.primitive != layout::no_index) return false;
    }
  } else if (entered.hits != 0 && flight.stack.descend(entered, end, flight.record)) {
    return true;
  }
  return flight.stack.climb(flight.best.t, end, flight.record);
}

// Each ray waits for one record after the other: so several are on their way, a step of one while the caches
// fetch what the others need.
constexpr uint32_t flights_at_once = 4;

template <class Block>
HWY_ATTR inline void trace_singles(Block& block, const uint32_t* indices, uint32_t count) {
  Flight<Block> flights[flights_at_once];
  Flight<Block>* active[flights_at_once];
  uint32_t next = 0, size = 0;
  const auto fill = [&](Flight<Block>& flight) HWY_ATTR {
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
      Flight<Block>& flight = *active[i];
      if (step(block, flight)) {
        const TraceTree& tree = *flight.tree;
        hwy::Prefetch(&tree.wide_node(flight.record).planes[0]);
        hwy::Prefetch(&tree.wide_node(flight.record).planes[1]);
        hwy::Prefetch(&tree.wide_node(flight.record).planes[2]);
        // Without a branch: where the record is no leaf, the first one's, which is near.
        const uint32_t first = tree.first_leaf_record();
        const uint32_t* leaves = tree.leaves((std::max(flight.record, first) - first) * wide_fan);
        hwy::Prefetch(leaves);
        hwy::Prefetch(leaves + wide_fan);
        continue;
      }
      block.finish(flight.index, true, flight.best, flight.visits);
      if (!fill(flight)) active[i] = active[--size];
    }
  }
}

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
