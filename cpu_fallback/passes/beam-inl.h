// SPDX-License-Identifier: MIT
// Sixty-four rays from one origin, as the camera's are. Those of one octant and mostly along one axis go
// together through the tree of 16 boxes a record (wide_nodes.h), as an interval of directions
// (layout/tile.h); at a leaf first those of each bundle of 16 are looked at, then the rays. A block of
// several kinds is taken through once for each. Lane by lane the arithmetic is that of layout/trace.h.
// Included once a SIMD target.

#if defined(LODESTONE_BEAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_BEAM_INL_H_
#undef LODESTONE_BEAM_INL_H_
#else
#define LODESTONE_BEAM_INL_H_
#endif

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/packet-inl.h"
#include "lodestone/cpu_fallback/passes/single_ray-inl.h"
#include "lodestone/layout/tile.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

template <class Block>
inline bool trace_beams(Block&, uint32_t, uint32_t*, uint32_t&) {
  return false;  // a ray is as wide as a vector
}

#else

constexpr uint32_t beam_rays = layout::tile_rays, beam_bundles = beam_rays / packet_rays;
constexpr int fewest_together = 8;  // rays; fewer go each by itself

// What layout::Cone is made of, and the farthest hit; of some of a beam's rays.
struct Reach {
  layout::Cone cone;
  float tmax;
};

struct Bundle {
  alignas(64) float inverse[3][packet_rays], shear[3][packet_rays];
  BestHits<packet_rays> best;
  Reach reach;
};

struct Beam {
  glm::vec3 origin, near_origin, far_origin;
  float tmin;
  uint32_t octant, axis;
  layout::TileAxes axes;
  Reach reach;
  Bundle bundles[beam_bundles];
};

// So many rays, structure of arrays.
struct RayLanes {
  Vec3 origin, direction;
  Floats tmin, tmax;
};
HWY_ATTR inline RayLanes load_rays(const float* quads) {
  const Lanes d;
  Vec3 a, b;
  Floats a_w, b_w;
  hn::LoadInterleaved4(d, quads, a.x, a.y, a.z, a_w);
  hn::LoadInterleaved4(d, quads + 4 * hn::Lanes(d), b.x, b.y, b.z, b_w);
  return {{hn::ConcatEven(d, b.x, a.x), hn::ConcatEven(d, b.y, a.y), hn::ConcatEven(d, b.z, a.z)},
          {hn::ConcatOdd(d, b.x, a.x), hn::ConcatOdd(d, b.y, a.y), hn::ConcatOdd(d, b.z, a.z)},
          hn::ConcatEven(d, b_w, a_w),
          hn::ConcatOdd(d, b_w, a_w)};
}

// Coordinates in the order that makes `axis` the last (layout::turned).
HWY_ATTR inline Vec3 turned(const Vec3& v, uint32_t axis) {
  return axis == 0 ? Vec3{v.y, v.z, v.x} : axis == 1 ? Vec3{v.z, v.x, v.y} : v;
}

// Which of these are rays that go with the first one of the beam.
HWY_ATTR inline Mask alike(const RayLanes& rays, const layout::Ray& lead, const Beam& beam) {
  const Lanes d;
  const auto zero = hn::Zero(d);
  const Vec3 size{hn::Abs(rays.direction.x), hn::Abs(rays.direction.y), hn::Abs(rays.direction.z)};
  Mask good = hn::And(hn::Eq(rays.tmin, hn::Set(d, lead.tmin)), hn::Ge(rays.tmax, zero));
  good = hn::And(good, hn::And(hn::Eq(rays.origin.x, hn::Set(d, lead.origin.x)),
                               hn::And(hn::Eq(rays.origin.y, hn::Set(d, lead.origin.y)),
                                       hn::Eq(rays.origin.z, hn::Set(d, lead.origin.z)))));
  // layout::stored_ray
  const glm::vec3 height = glm::abs(lead.origin);
  const auto sum =
      hn::Add(hn::Add(hn::Add(hn::Set(d, height.x + height.y + height.z), size.x), size.y), size.z);
  good = hn::And(good, hn::Le(sum, hn::Set(d, layout::infinity_bits_as_max)));
  const auto signed_alike = [&](Floats v, uint32_t bit) HWY_ATTR {
    const Mask negative = hn::Lt(v, zero);
    return (beam.octant & bit) != 0 ? negative : hn::Not(negative);
  };
  good =
      hn::And(good, hn::And(signed_alike(rays.direction.x, 1),
                            hn::And(signed_alike(rays.direction.y, 2), signed_alike(rays.direction.z, 4))));
  // layout::make_shear takes the first of the largest.
  const Mask x = hn::And(hn::Ge(size.x, size.y), hn::Ge(size.x, size.z)), y = hn::Ge(size.y, size.z);
  return hn::And(good, beam.axis == 0   ? x
                       : beam.axis == 1 ? hn::AndNot(x, y)
                                        : hn::AndNot(hn::Or(x, y), hn::Eq(zero, zero)));
}

// Of rays first + 0..63 those of the bits `waiting` that go together with the lowest of them; returns their
// bits, none where that is no ray.
template <class Block>
HWY_ATTR inline uint64_t load_beam(const Block& block, const TraceTree& tree, uint32_t first,
                                   uint64_t waiting, Beam& beam) {
  const Lanes d;
  const auto width = static_cast<uint32_t>(hn::Lanes(d));
  const layout::Ray lead = block.ray(first + static_cast<uint32_t>(std::countr_zero(waiting)));
  if (!(lead.tmax >= 0.0f && lead.tmin >= 0.0f)) return 0;
  const layout::Slabs slabs = layout::make_slabs(lead, tree.extent());
  beam.origin = lead.origin;
  beam.near_origin = slabs.near_origin;
  beam.far_origin = slabs.far_origin;
  beam.tmin = lead.tmin;
  beam.octant = slabs.octant;
  beam.axis = layout::make_shear(lead).axis;
  const auto one = hn::Set(d, 1.0f), zero = hn::Zero(d), least_size = hn::Set(d, 0x1p-40f);
  const auto largest = hn::Set(d, layout::infinity_bits_as_max), nothing = hn::Set(d, -1.0f);
  uint64_t going = 0;
  beam.reach = {{glm::vec3(layout::infinity_bits_as_max), glm::vec3(0)}, -1};
  for (uint32_t b = 0; b < beam_bundles; ++b) {
    Bundle& bundle = beam.bundles[b];
    auto lo_x = largest, lo_y = largest, lo_z = largest, hi_x = zero, hi_y = zero, hi_z = zero,
         tmax = nothing;
    for (uint32_t lane = 0; lane < packet_rays; lane += width) {
      const uint32_t number = b * packet_rays + lane;
      const float* quads = block.ray_quads(first + number);
      for (uint32_t i = 0; i < width; i += 2) hwy::Prefetch(quads + 8 * (beam_rays + i));  // the next block's
      const RayLanes rays = load_rays(quads);
      const Mask goes = hn::And(alike(rays, lead, beam), bit_mask(d, waiting >> number));
      going |= uint64_t(mask_bits(d, goes)) << number;
      const auto along = [&](Floats direction, int axis, auto& lo, auto& hi) HWY_ATTR {
        const auto size = hn::Div(one, hn::Max(hn::Abs(direction), least_size));
        lo = hn::Min(lo, hn::IfThenElse(goes, size, largest));
        hi = hn::Max(hi, hn::IfThenElse(goes, size, zero));
        hn::Store(hn::IfThenElse(hn::Lt(direction, zero), hn::Neg(size), size), d,
                  bundle.inverse[axis] + lane);
      };
      along(rays.direction.x, 0, lo_x, hi_x);
      along(rays.direction.y, 1, lo_y, hi_y);
      along(rays.direction.z, 2, lo_z, hi_z);
      const Vec3 to = turned(rays.direction, beam.axis);
      hn::Store(hn::Div(to.x, to.z), d, bundle.shear[0] + lane);
      hn::Store(hn::Div(to.y, to.z), d, bundle.shear[1] + lane);
      hn::Store(hn::Div(one, to.z), d, bundle.shear[2] + lane);
      // The others enter nothing: tmin is not negative.
      const auto end = hn::IfThenElse(goes, rays.tmax, nothing);
      tmax = hn::Max(tmax, end);
      bundle.best.begin(lane, end);
    }
    const auto least = [&](Floats v) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(d, v)); };
    const auto most = [&](Floats v) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(d, v)); };
    bundle.reach = {{{least(lo_x), least(lo_y), least(lo_z)}, {most(hi_x), most(hi_y), most(hi_z)}},
                    most(tmax)};
    beam.reach.cone.lo = layout::min3(beam.reach.cone.lo, bundle.reach.cone.lo);
    beam.reach.cone.hi = layout::max3(beam.reach.cone.hi, bundle.reach.cone.hi);
    beam.reach.tmax = layout::max2(beam.reach.tmax, bundle.reach.tmax);
  }
  const WideGrid& grid = tree.grid();
  beam.axes = layout::make_tile_axes(slabs, {glm::vec3(grid.base), 0, glm::vec3(grid.step), 0});
  return going;
}

// layout::cone_enters, of a record's children.
HWY_ATTR inline void test_cone(const WideNode& node, const Beam& beam, const Reach& reach, Entered& entered) {
  const Boxes d;
  const hn::RebindToSigned<Boxes> di;
  const hn::Rebind<uint16_t, Boxes> du16;
  const auto zero = hn::Zero(d), nowhere = hn::Set(d, std::numeric_limits<float>::infinity());
  entered.hits = 0;
  for (uint32_t i = 0; i < wide_fan; i += static_cast<uint32_t>(hn::Lanes(d))) {
    auto from = hn::Set(d, beam.tmin), to = hn::Set(d, reach.tmax);
    auto there = hn::Eq(zero, zero);
    for (int axis = 0; axis < 3; ++axis) {
      const uint32_t close = beam.octant >> axis & 1;
      const auto plane = [&](uint32_t side) HWY_ATTR {
        return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(du16, node.planes[axis][side] + i)));
      };
      const auto near_plane = plane(close), far_plane = plane(close ^ 1);
      const auto step = hn::Set(d, beam.axes.step[axis]);
      const auto near_side = hn::MulAdd(near_plane, step, hn::Set(d, beam.axes.near_offset[axis]));
      const auto far_side = hn::MulAdd(far_plane, step, hn::Set(d, beam.axes.far_offset[axis]));
      const auto lo = hn::Set(d, reach.cone.lo[axis]), hi = hn::Set(d, reach.cone.hi[axis]);
      from = hn::Max(from, hn::Mul(near_side, hn::IfThenElse(hn::Lt(near_side, zero), hi, lo)));
      to = hn::Min(to, hn::Mul(far_side, hn::IfThenElse(hn::Lt(far_side, zero), lo, hi)));
      if (axis == 0) there = close != 0 ? hn::Le(far_plane, near_plane) : hn::Le(near_plane, far_plane);
    }
    const auto inside = hn::And(there, hn::Le(from, to));
    hn::Store(hn::IfThenElse(inside, from, nowhere), d, entered.enter + i);
    entered.hits |= mask_bits(d, inside) << i;
  }
}

// A quad as all rays of a beam see it: how far its bound and its corners are from their origin.
struct BeamQuad {
  glm::vec3 from, to;  // the near planes and the far ones
  uint32_t texel, stride;
  bool has_corners = false;  // few bounds have any ray in them where quads are small
  glm::vec3 corner[4];
};

HWY_ATTR inline BeamQuad beam_quad(const TraceTree& tree, const Beam& beam, uint32_t slot, uint32_t texel,
                                   uint32_t stride) {
  const uint32_t address = layout::level_base(tree.depth()) + slot;
  const float* lo = tree.nodes_lo(address);
  const float* hi = tree.nodes_hi(address);
  BeamQuad quad;
  for (int axis = 0; axis < 3; ++axis) {
    const bool down = (beam.octant >> axis & 1) != 0;
    quad.from[axis] = (down ? hi : lo)[axis] - beam.near_origin[axis];
    quad.to[axis] = (down ? lo : hi)[axis] - beam.far_origin[axis];
  }
  quad.texel = texel;
  quad.stride = stride;
  return quad;
}

template <class Block>
HWY_ATTR inline void find_corners(const Block& block, const Beam& beam, BeamQuad& quad) {
  const uint32_t below = quad.texel + quad.stride, at[4] = {quad.texel, quad.texel + 1, below, below + 1};
  for (int i = 0; i < 4; ++i) quad.corner[i] = layout::turned(block.texel(at[i]) - beam.origin, beam.axis);
  quad.has_corners = true;
}

template <class Block>
HWY_ATTR inline void test_quad(Block& block, const Beam& beam, BeamQuad& quad, Bundle& bundle) {
  const Lanes d;
  const auto times = [&](float distance, Floats by) HWY_ATTR { return hn::Mul(hn::Set(d, distance), by); };
  const Floats tmin = hn::Set(d, beam.tmin);
  for (uint32_t lane = 0; lane < packet_rays; lane += static_cast<uint32_t>(hn::Lanes(d))) {
    const Vec3 inverse = load3(bundle.inverse, lane);
    const Floats enter = hn::Max(hn::Max(times(quad.from.x, inverse.x), times(quad.from.y, inverse.y)),
                                 hn::Max(times(quad.from.z, inverse.z), tmin));
    const Floats exit = hn::Min(hn::Min(times(quad.to.x, inverse.x), times(quad.to.y, inverse.y)),
                                hn::Min(times(quad.to.z, inverse.z), hn::Load(d, bundle.best.t + lane)));
    const Mask entered = hn::Le(enter, exit);
    if (hn::AllFalse(d, entered)) continue;
    if (!quad.has_corners) find_corners(block, beam, quad);
    const Vec3 shear = load3(bundle.shear, lane);
    const auto sheared = [&](const glm::vec3& p) HWY_ATTR {
      return Vec3{hn::Sub(hn::Set(d, p.x), times(p.z, shear.x)),
                  hn::Sub(hn::Set(d, p.y), times(p.z, shear.y)), times(p.z, shear.z)};
    };
    const Vec3 a = sheared(quad.corner[0]), b = sheared(quad.corner[1]), c = sheared(quad.corner[2]),
               e = sheared(quad.corner[3]);
    const Floats bc = edge_function(b, c);
    QuadTest test(bundle.best, lane, tmin, enter);
    test.accept(a, b, c, bc, edge_function(c, a), edge_function(a, b), entered, 2 * quad.texel);
    test.accept(e, c, b, hn::Neg(bc), edge_function(b, e), edge_function(e, c), entered, 2 * quad.texel + 1);
    test.store(bundle.best, lane);
    if (Block::counting) block.count_quad(static_cast<uint32_t>(hn::CountTrue(d, entered)));
  }
}

// The quads of a record's children `hits`.
template <class Block>
HWY_ATTR inline void test_leaves(Block& block, const TraceTree& tree, Beam& beam, const WideNode& node,
                                 uint32_t first_slot, uint32_t hits) {
  const Lanes d;
  const uint32_t address = layout::level_base(tree.depth()) + first_slot;
  for (uint32_t i = 0; i < wide_fan; i += 4) {  // four to a cache line
    hwy::Prefetch(tree.nodes_lo(address + i));
    hwy::Prefetch(tree.nodes_hi(address + i));
  }
  hwy::Prefetch(tree.leaves(first_slot));
  hwy::Prefetch(tree.leaves(first_slot + wide_fan / 2));
  uint32_t of_bundle[beam_bundles], any = 0;
  for (uint32_t b = 0; b < beam_bundles; ++b) {
    Entered entered;
    test_cone(node, beam, beam.bundles[b].reach, entered);
    of_bundle[b] = entered.hits & hits;
    any |= of_bundle[b];
  }
  if (any == 0) return;
  uint32_t children[wide_fan], texels[wide_fan], strides[wide_fan], count = 0;
  for (; any != 0; any &= any - 1) {
    children[count] = static_cast<uint32_t>(std::countr_zero(any));
    if (!tree.leaf(first_slot + children[count], texels[count], strides[count])) continue;
    hwy::Prefetch(block.texels(texels[count]));
    hwy::Prefetch(block.texels(texels[count] + strides[count]));
    ++count;
  }
  for (uint32_t i = 0; i < count; ++i) {
    BeamQuad quad = beam_quad(tree, beam, first_slot + children[i], texels[i], strides[i]);
    for (uint32_t b = 0; b < beam_bundles; ++b)
      if ((of_bundle[b] >> children[i] & 1) != 0) test_quad(block, beam, quad, beam.bundles[b]);
  }
  beam.reach.tmax = -1;
  for (Bundle& bundle : beam.bundles) {
    auto farthest = hn::Load(d, bundle.best.t);
    for (uint32_t lane = static_cast<uint32_t>(hn::Lanes(d)); lane < packet_rays;
         lane += static_cast<uint32_t>(hn::Lanes(d)))
      farthest = hn::Max(farthest, hn::Load(d, bundle.best.t + lane));
    bundle.reach.tmax = hn::GetLane(hn::MaxOfLanes(d, farthest));
    beam.reach.tmax = layout::max2(beam.reach.tmax, bundle.reach.tmax);
  }
}

// Through the tree; returns how many records were read.
template <class Block>
HWY_ATTR inline uint32_t trace_beam(Block& block, const TraceTree& tree, Beam& beam) {
  const uint32_t first_leaf = tree.first_leaf_record(), end = tree.end_record();
  Stack stack;
  uint32_t record = 0, visits = 0;
  for (;;) {
    Entered entered;
    const WideNode& node = tree.wide_node(record);
    test_cone(node, beam, beam.reach, entered);
    block.count_record(beam_rays);
    ++visits;
    if (record >= first_leaf) {
      if (entered.hits != 0)
        test_leaves(block, tree, beam, node, (record - first_leaf) * wide_fan, entered.hits);
    } else if (entered.hits != 0) {
      const uint32_t first_child = wide_fan * record + 1;
      for (uint32_t waiting = entered.hits; waiting != 0; waiting &= waiting - 1) {
        const uint32_t child = first_child + static_cast<uint32_t>(std::countr_zero(waiting));
        for (const auto& planes : tree.wide_node(std::min(child, end - 1)).planes) hwy::Prefetch(&planes);
      }
      if (stack.descend(entered, end, record)) continue;
    }
    if (!stack.climb(beam.reach.tmax, end, record)) return visits;
  }
}

// The hits of rays first + 0..63, all of which have gone together.
HWY_ATTR inline void store_hits(const Beam& beam, uint32_t* hits) {
  const Lanes d;
  const hn::RebindToUnsigned<Lanes> du;
  for (const Bundle& bundle : beam.bundles) {
    const BestHits<packet_rays>& best = bundle.best;
    for (uint32_t lane = 0; lane < packet_rays; lane += static_cast<uint32_t>(hn::Lanes(d))) {
      const auto sum = hn::Load(d, best.sum + lane);
      const auto over_sum = [&](const float* from)
                                HWY_ATTR { return hn::BitCast(du, hn::Div(hn::Load(d, from), sum)); };
      hn::StoreInterleaved4(hn::BitCast(du, hn::Load(d, best.t + lane)), over_sum(best.u + lane),
                            over_sum(best.v + lane), hn::Load(du, best.primitive + lane), du, hits);
      hits += 4 * hn::Lanes(d);
    }
  }
}

// Rays first + 0..63 to their end, but for those that go with few others: these are added to `singles`.
// False: most do not go together, and nothing is done.
template <class Block>
HWY_ATTR inline bool trace_beams(Block& block, uint32_t first, uint32_t* singles, uint32_t& size) {
  if (!block.may_be_a_beam(first)) return false;
  const TraceTree tree = block.tree(first);
  Beam beam;
  uint64_t waiting = ~uint64_t{0};
  const auto go_alone = [&](uint64_t rays) {
    for (; rays != 0; rays &= rays - 1)
      singles[size++] = first + static_cast<uint32_t>(std::countr_zero(rays));
  };
  for (uint32_t kind = 0; kind < layout::tile_kinds && waiting != 0; ++kind) {
    uint64_t going = load_beam(block, tree, first, waiting, beam);
    if (kind == 0 && std::popcount(going) < 2 * fewest_together) return false;
    if (going == 0) going = waiting & (~waiting + 1);
    waiting &= ~going;
    if (std::popcount(going) < fewest_together) {
      go_alone(going);
      continue;
    }
    const uint32_t visits = trace_beam(block, tree, beam);
    if (going == ~uint64_t{0}) {
      store_hits(beam, block.finish_beam(first, beam_rays, visits));
      return true;
    }
    for (; going != 0; going &= going - 1) {
      const auto number = static_cast<uint32_t>(std::countr_zero(going)), lane = number % packet_rays;
      const BestHits<packet_rays>& best = beam.bundles[number / packet_rays].best;
      block.finish(
          first + number, true,
          {best.t[lane], best.u[lane] / best.sum[lane], best.v[lane] / best.sum[lane], best.primitive[lane]},
          visits);
    }
  }
  go_alone(waiting);
  return true;
}

#endif

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
