// SPDX-License-Identifier: MIT
// Sixty-four rays that go the same way, from one origin as the camera's or from near by as shadow rays to one
// light. Those of one octant and mostly along one axis go together through the tree of 16 boxes a record
// (wide_nodes.h), as an interval of directions (layout/tile.h) and of origins; at a leaf first those of each
// bundle of 16 are looked at, then the rays. A block of several kinds is taken through once for each. Lane by
// lane the arithmetic is that of layout/trace.h.
// Included once a SIMD target.

#if defined(LODESTONE_BEAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_BEAM_INL_H_
#undef LODESTONE_BEAM_INL_H_
#else
#define LODESTONE_BEAM_INL_H_
#endif

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/ray_lanes-inl.h"
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

constexpr uint32_t beam_rays = layout::tile_rays, beam_bundles = beam_rays / bundle_rays;
constexpr int fewest_together = 8;  // rays; fewer go each by itself

// What some of a beam's rays have in common.
struct Reach {
  layout::Cone cone;
  layout::TileAxes axes;  // no sharper than those of any of their origins
  float tmin, tmax;       // the least, and the farthest that any has still to look
};

struct Bundle {
  alignas(64) float inverse[3][bundle_rays], shear[3][bundle_rays];
  BestHits best;
  Reach reach;
  // Where they start, if not all at one point.
  alignas(64) float turned_origin[3][bundle_rays], near_origin[3][bundle_rays], far_origin[3][bundle_rays];
  alignas(64) float tmin[bundle_rays];
};

struct Beam {
  layout::Ray lead;  // its lowest ray: the origin of all, if they have one
  alignas(16) float origin[4], near_origin[4], far_origin[4], lead_direction[4];
  uint32_t octant, axis;
  bool any_hit;
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

HWY_ATTR inline Mask all_of(Mask a, Mask b, Mask c) {
  return hn::And(hn::And(a, b), c);
}

// Which of these are rays (layout::stored_ray) that have something to look for.
HWY_ATTR inline Mask are_rays(const RayLanes& rays) {
  const Lanes d;
  const auto size = [](Floats v) HWY_ATTR { return hn::Abs(v); };
  auto sum = hn::Add(hn::Add(size(rays.origin.x), size(rays.origin.y)), size(rays.origin.z));
  sum =
      hn::Add(hn::Add(hn::Add(sum, size(rays.direction.x)), size(rays.direction.y)), size(rays.direction.z));
  return hn::And(hn::Le(sum, hn::Set(d, layout::infinity_bits_as_max)), hn::Ge(rays.tmax, hn::Zero(d)));
}

// Which of these rays go the way of the beam's lead.
HWY_ATTR inline Mask alike(const RayLanes& rays, const Beam& beam) {
  const Lanes d;
  const auto zero = hn::Zero(d);
  const Vec3 size{hn::Abs(rays.direction.x), hn::Abs(rays.direction.y), hn::Abs(rays.direction.z)};
  const auto signed_alike = [&](Floats v, uint32_t bit) HWY_ATTR {
    const Mask negative = hn::Lt(v, zero);
    return (beam.octant & bit) != 0 ? negative : hn::Not(negative);
  };
  const Mask octant = all_of(signed_alike(rays.direction.x, 1), signed_alike(rays.direction.y, 2),
                             signed_alike(rays.direction.z, 4));
  // layout::make_shear takes the first of the largest.
  const Mask x = hn::And(hn::Ge(size.x, size.y), hn::Ge(size.x, size.z)), y = hn::Ge(size.y, size.z);
  const Mask axis = beam.axis == 0   ? x
                    : beam.axis == 1 ? hn::AndNot(x, y)
                                     : hn::AndNot(hn::Or(x, y), hn::Eq(zero, zero));
  return hn::And(octant, axis);
}

HWY_ATTR inline Mask from_one_origin(const RayLanes& rays, const layout::Ray& lead) {
  const Lanes d;
  return hn::And(hn::Eq(rays.tmin, hn::Set(d, lead.tmin)),
                 all_of(hn::Eq(rays.origin.x, hn::Set(d, lead.origin.x)),
                        hn::Eq(rays.origin.y, hn::Set(d, lead.origin.y)),
                        hn::Eq(rays.origin.z, hn::Set(d, lead.origin.z))));
}

// Within `reach` of the lead's origin along each axis, and in a narrow cone round its direction.
HWY_ATTR inline Mask from_near_by(const RayLanes& rays, const layout::Ray& lead, float reach) {
  const Lanes d;
  const auto within = [&](Floats v, float of_lead) HWY_ATTR {
    return hn::Le(hn::Abs(hn::Sub(v, hn::Set(d, of_lead))), hn::Set(d, reach));
  };
  const auto times = [&](Floats v, float by) HWY_ATTR { return hn::Mul(v, hn::Set(d, by)); };
  const Vec3& to = rays.direction;
  const auto along = hn::Add(hn::Add(times(to.x, lead.direction.x), times(to.y, lead.direction.y)),
                             times(to.z, lead.direction.z));
  const auto size = hn::Add(hn::Add(hn::Mul(to.x, to.x), hn::Mul(to.y, to.y)), hn::Mul(to.z, to.z));
  const float least = narrow_cone * layout::dot3(lead.direction, lead.direction);
  const Mask direction =
      hn::And(hn::Ge(hn::Mul(along, along), times(size, least)), hn::Ge(rays.tmin, hn::Zero(d)));
  return hn::And(direction, all_of(within(rays.origin.x, lead.origin.x), within(rays.origin.y, lead.origin.y),
                                   within(rays.origin.z, lead.origin.z)));
}

// Of rays first + 0..63 the bits of those that are any (layout::stored_ray).
template <class Block>
HWY_ATTR inline uint64_t find_rays(const Block& block, uint32_t first) {
  const Lanes d;
  uint64_t found = 0;
  for (uint32_t i = 0; i < beam_rays; i += static_cast<uint32_t>(hn::Lanes(d)))
    found |= uint64_t(mask_bits(d, are_rays(load_rays(block.ray_quads(first + i))))) << i;
  return found;
}

// The least and the greatest value of some lanes, over several vectors.
struct Range {
  Floats lo, hi;

  HWY_ATTR Range()
      : lo(hn::Set(Lanes(), layout::infinity_bits_as_max)),
        hi(hn::Set(Lanes(), -layout::infinity_bits_as_max)) {}
  HWY_ATTR void add(Floats v, Mask of) {
    lo = hn::Min(lo, hn::IfThenElse(of, v, lo));
    hi = hn::Max(hi, hn::IfThenElse(of, v, hi));
  }
  HWY_ATTR void add(const Range& other) {
    lo = hn::Min(lo, other.lo);
    hi = hn::Max(hi, other.hi);
  }
  HWY_ATTR float least() const { return hn::GetLane(hn::MinOfLanes(Lanes(), lo)); }
  HWY_ATTR float most() const { return hn::GetLane(hn::MaxOfLanes(Lanes(), hi)); }
};

// The axes of all origins whose near and far ones are in these ranges.
HWY_ATTR inline layout::TileAxes axes_of(const Range (&near)[3], const Range (&far)[3], uint32_t octant,
                                         const layout::BoxGrid& grid) {
  layout::Slabs slabs{};
  slabs.octant = octant;
  for (int axis = 0; axis < 3; ++axis) {
    const bool down = (octant >> axis & 1) != 0;
    slabs.near_origin[axis] = down ? near[axis].least() : near[axis].most();
    slabs.far_origin[axis] = down ? far[axis].most() : far[axis].least();
  }
  return layout::make_tile_axes(slabs, grid);
}

// Of rays first + 0..63 those of the bits `waiting` that go together with the lowest of them, all from one
// origin (`common`) or from near by; returns their bits, none where that is no ray.
template <bool common, class Block>
HWY_ATTR HWY_FLATTEN inline uint64_t load_beam(Block& block, const TraceTree& tree, uint32_t first,
                                               uint64_t waiting, Beam& beam) {
  const Lanes d;
  const auto width = static_cast<uint32_t>(hn::Lanes(d));
  const uint32_t lowest = first + static_cast<uint32_t>(std::countr_zero(waiting));
  beam.lead = block.ray(lowest);
  if (!(beam.lead.tmax >= 0.0f && beam.lead.tmin >= 0.0f)) return 0;
  const layout::Slabs slabs = layout::make_slabs(beam.lead, tree.extent());
  const auto store = [](const glm::vec3& v, float* to) {
    for (int axis = 0; axis < 3; ++axis) to[axis] = v[axis];
    to[3] = 1;  // w of a texel is a denormal, and some processors take a hundred cycles for a difference that
                // is one
  };
  store(beam.lead.origin, beam.origin);
  store(slabs.near_origin, beam.near_origin);
  store(slabs.far_origin, beam.far_origin);
  store(beam.lead.direction, beam.lead_direction);
  beam.octant = slabs.octant;
  beam.axis = layout::make_shear(beam.lead).axis;
  beam.any_hit = block.any_hit();
  if (!common && block.instanced()) waiting &= block.same_root(first, lowest);
  const layout::BoxGrid& grid = tree.grid();
  const float near_by = layout::max_component(grid.step) * 1024;  // a 64th of the object's size
  const layout::TileAxes axes = layout::make_tile_axes(slabs, grid);
  const auto one = hn::Set(d, 1.0f), zero = hn::Zero(d), least_size = hn::Set(d, 0x1p-40f);
  const auto nothing = hn::Set(d, -1.0f);
  uint64_t going = 0;
  beam.reach = {{glm::vec3(layout::infinity_bits_as_max), glm::vec3(0)}, axes, beam.lead.tmin, -1};
  Range all_near[3], all_far[3];
  for (uint32_t b = 0; b < beam_bundles; ++b) {
    Bundle& bundle = beam.bundles[b];
    Range sizes[3], near[3], far[3], tmin;
    auto tmax = nothing;
    for (uint32_t lane = 0; lane < bundle_rays; lane += width) {
      const uint32_t number = b * bundle_rays + lane;
      const float* quads = block.ray_quads(first + number);
      for (uint32_t i = 0; i < width; i += 2) hwy::Prefetch(quads + 8 * (beam_rays + i));  // the next block's
      const RayLanes rays = load_rays(quads);
      const Mask goes =
          hn::And(all_of(are_rays(rays), alike(rays, beam), bit_mask(d, waiting >> number)),
                  common ? from_one_origin(rays, beam.lead) : from_near_by(rays, beam.lead, near_by));
      going |= uint64_t(mask_bits(d, goes)) << number;
      const auto along = [&](Floats direction, int axis) HWY_ATTR {
        const auto size = hn::Div(one, hn::Max(hn::Abs(direction), least_size));
        sizes[axis].add(size, goes);
        hn::Store(hn::IfThenElse(hn::Lt(direction, zero), hn::Neg(size), size), d,
                  bundle.inverse[axis] + lane);
      };
      along(rays.direction.x, 0);
      along(rays.direction.y, 1);
      along(rays.direction.z, 2);
      const Vec3 to = turned(rays.direction, beam.axis);
      hn::Store(hn::Div(to.x, to.z), d, bundle.shear[0] + lane);
      hn::Store(hn::Div(to.y, to.z), d, bundle.shear[1] + lane);
      hn::Store(hn::Div(one, to.z), d, bundle.shear[2] + lane);
      // The others enter nothing: tmin is not negative.
      const auto end = hn::IfThenElse(goes, rays.tmax, nothing);
      tmax = hn::Max(tmax, end);
      bundle.best.begin(lane, end);
      if (common) continue;
      // layout::make_slabs
      const Vec3& from = rays.origin;
      const auto margin = hn::Mul(hn::Max(hn::Max(hn::Set(d, tree.extent()), hn::Abs(from.x)),
                                          hn::Max(hn::Abs(from.y), hn::Abs(from.z))),
                                  hn::Set(d, layout::slab_margin));
      const auto apart = [&](Floats origin, int axis) HWY_ATTR {
        const auto outwards = (beam.octant >> axis & 1) != 0 ? hn::Neg(margin) : margin;
        const auto close = hn::Add(origin, outwards), distant = hn::Sub(origin, outwards);
        near[axis].add(close, goes);
        far[axis].add(distant, goes);
        hn::Store(close, d, bundle.near_origin[axis] + lane);
        hn::Store(distant, d, bundle.far_origin[axis] + lane);
      };
      apart(from.x, 0);
      apart(from.y, 1);
      apart(from.z, 2);
      const Vec3 start = turned(from, beam.axis);
      hn::Store(start.x, d, bundle.turned_origin[0] + lane);
      hn::Store(start.y, d, bundle.turned_origin[1] + lane);
      hn::Store(start.z, d, bundle.turned_origin[2] + lane);
      tmin.add(rays.tmin, goes);
      hn::Store(hn::Max(rays.tmin, zero), d, bundle.tmin + lane);
    }
    bundle.reach = {{{sizes[0].least(), sizes[1].least(), sizes[2].least()},
                     {sizes[0].most(), sizes[1].most(), sizes[2].most()}},
                    axes,
                    beam.lead.tmin,
                    hn::GetLane(hn::MaxOfLanes(d, tmax))};
    if (!common) {
      bundle.reach.tmin = tmin.least();
      bundle.reach.axes = axes_of(near, far, beam.octant, grid);
      for (int axis = 0; axis < 3; ++axis) {
        all_near[axis].add(near[axis]);
        all_far[axis].add(far[axis]);
      }
    }
    beam.reach.cone.lo = layout::min3(beam.reach.cone.lo, bundle.reach.cone.lo);
    beam.reach.cone.hi = layout::max3(beam.reach.cone.hi, bundle.reach.cone.hi);
    beam.reach.tmin = layout::min2(beam.reach.tmin, bundle.reach.tmin);
    beam.reach.tmax = layout::max2(beam.reach.tmax, bundle.reach.tmax);
  }
  if (!common) beam.reach.axes = axes_of(all_near, all_far, beam.octant, grid);
  return going;
}

// layout::cone_enters, of a record's children.
HWY_ATTR inline void test_cone(const WideNode& node, uint32_t octant, const Reach& reach, Entered& entered) {
  const Boxes d;
  const hn::RebindToSigned<Boxes> di;
  const hn::Rebind<uint16_t, Boxes> du16;
  const auto zero = hn::Zero(d), nowhere = hn::Set(d, std::numeric_limits<float>::infinity());
  entered.hits = 0;
  for (uint32_t i = 0; i < wide_fan; i += static_cast<uint32_t>(hn::Lanes(d))) {
    auto from = hn::Set(d, reach.tmin), to = hn::Set(d, reach.tmax);
    auto there = hn::Eq(zero, zero);
    for (int axis = 0; axis < 3; ++axis) {
      const uint32_t close = octant >> axis & 1;
      const auto plane = [&](uint32_t side) HWY_ATTR {
        return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(du16, node.planes[axis][side] + i)));
      };
      const auto near_plane = plane(close), far_plane = plane(close ^ 1);
      const auto step = hn::Set(d, reach.axes.step[axis]);
      const auto near_side = hn::MulAdd(near_plane, step, hn::Set(d, reach.axes.near_offset[axis]));
      const auto far_side = hn::MulAdd(far_plane, step, hn::Set(d, reach.axes.far_offset[axis]));
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

// A quad of a beam: its bound and corners as seen from the rays' one origin, or as they are.
template <bool common>
struct BeamQuad {
  alignas(16) float near[4], far[4];  // planes
  alignas(16) float corner[4][4];     // turned; few bounds have any ray in them where quads are small
  const float* texels[4];
  uint32_t texel;
  bool has_corners = false;

  template <class Block>
  HWY_ATTR BeamQuad(const Block& block, const Beam& beam, uint32_t quad, uint32_t stride) : texel(quad) {
    texels[0] = block.texels(quad);
    texels[1] = texels[0] + 4;
    texels[2] = block.texels(quad + stride);
    texels[3] = texels[2] + 4;
    const Lanes4 a = load_lanes(texels[0]), b = load_lanes(texels[1]), c = load_lanes(texels[2]),
                 e = load_lanes(texels[3]);
    const Lanes4 lo = min(min(a, b), min(c, e)), hi = max(max(a, b), max(c, e));
    const Lanes4 way = load_lanes(beam.lead_direction);
    Lanes4 first = where_negative(way, hi, lo), second = where_negative(way, lo, hi);
    if (common) {
      first = first - load_lanes(beam.near_origin);
      second = second - load_lanes(beam.far_origin);
    }
    store_lanes(first, near);
    store_lanes(second, far);
  }

  HWY_ATTR void find_corners(const Beam& beam) {
    for (int i = 0; i < 4; ++i) {
      Lanes4 point = load_lanes(texels[i]);
      if (common) point = point - load_lanes(beam.origin);
      store_lanes(permuted(point, shear_turns[beam.axis]), corner[i]);
    }
    has_corners = true;
  }
};

template <bool common, class Block>
HWY_ATTR inline void test_quad(Block& block, const Beam& beam, BeamQuad<common>& quad, Bundle& bundle) {
  const Lanes d;
  const auto splat = [&](float v) HWY_ATTR { return hn::Set(d, v); };
  // From the origin of each lane.
  const auto seen_from = [&](const float* p, const float(&origins)[3][bundle_rays], uint32_t lane) HWY_ATTR {
    const Vec3 point{splat(p[0]), splat(p[1]), splat(p[2])};
    return common ? point : sub(point, load3(origins, lane));
  };
  for (uint32_t lane = 0; lane < bundle_rays; lane += static_cast<uint32_t>(hn::Lanes(d))) {
    const Vec3 inverse = load3(bundle.inverse, lane);
    const Floats tmin = common ? splat(beam.lead.tmin) : hn::Load(d, bundle.tmin + lane);
    const Vec3 from = seen_from(quad.near, bundle.near_origin, lane),
               to = seen_from(quad.far, bundle.far_origin, lane);
    const Floats enter = hn::Max(hn::Max(hn::Mul(from.x, inverse.x), hn::Mul(from.y, inverse.y)),
                                 hn::Max(hn::Mul(from.z, inverse.z), tmin));
    const Floats exit = hn::Min(hn::Min(hn::Mul(to.x, inverse.x), hn::Mul(to.y, inverse.y)),
                                hn::Min(hn::Mul(to.z, inverse.z), hn::Load(d, bundle.best.t + lane)));
    const Mask entered = hn::Le(enter, exit);
    if (hn::AllFalse(d, entered)) continue;
    if (!quad.has_corners) quad.find_corners(beam);
    const Vec3 shear = load3(bundle.shear, lane);
    const auto sheared = [&](const float* point) HWY_ATTR {
      const Vec3 p = seen_from(point, bundle.turned_origin, lane);
      return Vec3{hn::Sub(p.x, hn::Mul(p.z, shear.x)), hn::Sub(p.y, hn::Mul(p.z, shear.y)),
                  hn::Mul(p.z, shear.z)};
    };
    const Vec3 a = sheared(quad.corner[0]), b = sheared(quad.corner[1]), c = sheared(quad.corner[2]),
               e = sheared(quad.corner[3]);
    const Floats bc = edge_function(b, c);
    QuadTest test(bundle.best, lane, tmin, enter);
    test.accept(a, b, c, bc, edge_function(c, a), edge_function(a, b), entered, 2 * quad.texel);
    test.accept(e, c, b, hn::Neg(bc), edge_function(b, e), edge_function(e, c), entered, 2 * quad.texel + 1);
    test.store(bundle.best, lane, beam.any_hit);
    if (Block::counting) block.count_quad(static_cast<uint32_t>(hn::CountTrue(d, entered)));
  }
}

// The quads of a record's children `hits`.
template <bool common, class Block>
HWY_ATTR inline void test_leaves(Block& block, const TraceTree& tree, Beam& beam, const WideNode& node,
                                 uint32_t first_slot, uint32_t hits) {
  const Lanes d;
  hwy::Prefetch(tree.leaves(first_slot));
  hwy::Prefetch(tree.leaves(first_slot + wide_fan / 2));
  uint32_t of_bundle[beam_bundles], any = 0;
  for (uint32_t b = 0; b < beam_bundles; ++b) {
    Entered entered;
    test_cone(node, beam.octant, beam.bundles[b].reach, entered);
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
    BeamQuad<common> quad(block, beam, texels[i], strides[i]);
    for (uint32_t b = 0; b < beam_bundles; ++b)
      if ((of_bundle[b] >> children[i] & 1) != 0) test_quad(block, beam, quad, beam.bundles[b]);
  }
  beam.reach.tmax = -1;
  for (Bundle& bundle : beam.bundles) {
    auto farthest = hn::Load(d, bundle.best.t);
    for (uint32_t lane = static_cast<uint32_t>(hn::Lanes(d)); lane < bundle_rays;
         lane += static_cast<uint32_t>(hn::Lanes(d)))
      farthest = hn::Max(farthest, hn::Load(d, bundle.best.t + lane));
    bundle.reach.tmax = hn::GetLane(hn::MaxOfLanes(d, farthest));
    beam.reach.tmax = layout::max2(beam.reach.tmax, bundle.reach.tmax);
  }
}

// Through the tree; returns how many records were read.
template <bool common, class Block>
HWY_ATTR inline uint32_t trace_beam(Block& block, const TraceTree& tree, Beam& beam) {
  const uint32_t first_leaf = tree.first_leaf_record(), end = tree.end_record();
  Stack stack;
  uint32_t record = 0, visits = 0;
  for (;;) {
    Entered entered;
    const WideNode& node = tree.wide_node(record);
    test_cone(node, beam.octant, beam.reach, entered);
    block.count_record(beam_rays);
    ++visits;
    if (record >= first_leaf) {
      if (entered.hits != 0)
        test_leaves<common>(block, tree, beam, node, (record - first_leaf) * wide_fan, entered.hits);
    } else if (entered.hits != 0) {
      const uint32_t first_child = wide_fan * record + 1;
      for (uint32_t waiting = entered.hits; waiting != 0; waiting &= waiting - 1) {
        const uint32_t child = first_child + static_cast<uint32_t>(std::countr_zero(waiting));
        for (const auto& planes : tree.wide_node(std::min(child, end - 1)).planes) hwy::Prefetch(&planes);
      }
      if (stack.descend_in_order(entered, end, record)) continue;
    }
    if (!stack.climb(beam.reach.tmax, end, record)) return visits;
  }
}

// The hits of rays first + 0..63, all of which have gone together.
HWY_ATTR inline void store_hits(const Beam& beam, uint32_t* hits) {
  const Lanes d;
  const hn::RebindToUnsigned<Lanes> du;
  for (const Bundle& bundle : beam.bundles) {
    const BestHits& best = bundle.best;
    for (uint32_t lane = 0; lane < bundle_rays; lane += static_cast<uint32_t>(hn::Lanes(d))) {
      const auto sum = hn::Load(d, best.sum + lane);
      auto t = hn::BitCast(du, hn::Load(d, best.t + lane)),
           u = hn::BitCast(du, hn::Div(hn::Load(d, best.u + lane), sum)),
           v = hn::BitCast(du, hn::Div(hn::Load(d, best.v + lane), sum)),
           primitive = hn::Load(du, best.primitive + lane);
      if (beam.any_hit) {  // which one does not matter
        const auto missed = hn::Eq(primitive, hn::Set(du, layout::no_index));
        t = hn::IfThenElseZero(missed, t);
        u = hn::IfThenElseZero(missed, u);
        v = hn::IfThenElseZero(missed, v);
        primitive = hn::IfThenElseZero(missed, primitive);
      }
      hn::StoreInterleaved4(t, u, v, primitive, du, hits);
      hits += 4 * hn::Lanes(d);
    }
  }
}

// Those of rays first + 0..63 that are `waiting` to their end, but for rays that go with few others: these
// are added to `singles`. False: most do not go together, and nothing is done.
template <bool common, class Block>
HWY_ATTR inline bool trace_kinds(Block& block, uint32_t first, uint64_t waiting, uint32_t* singles,
                                 uint32_t& size) {
  Beam beam;
  const uint64_t all = waiting;
  const auto go_alone = [&](uint64_t rays) {
    for (; rays != 0; rays &= rays - 1)
      singles[size++] = first + static_cast<uint32_t>(std::countr_zero(rays));
  };
  for (uint32_t kind = 0; kind < layout::tile_kinds && waiting != 0; ++kind) {
    const TraceTree tree = block.tree(first + static_cast<uint32_t>(std::countr_zero(waiting)));
    uint64_t going = load_beam<common>(block, tree, first, waiting, beam);
    if (kind == 0 && 4 * std::popcount(going) < std::popcount(all)) return false;
    if (going == 0) going = waiting & (~waiting + 1);
    waiting &= ~going;
    if (std::popcount(going) < fewest_together) {
      go_alone(going);
      continue;
    }
    const uint32_t visits = trace_beam<common>(block, tree, beam);
    if (going == ~uint64_t{0}) {
      store_hits(beam, block.finish_beam(first, beam_rays, visits));
      return true;
    }
    for (; going != 0; going &= going - 1) {
      const auto number = static_cast<uint32_t>(std::countr_zero(going)), lane = number % bundle_rays;
      const BestHits& best = beam.bundles[number / bundle_rays].best;
      block.finish(
          first + number, true,
          {best.t[lane], best.u[lane] / best.sum[lane], best.v[lane] / best.sum[lane], best.primitive[lane]},
          visits);
    }
  }
  go_alone(waiting);
  return true;
}

// Rays first + 0..63: as trace_kinds.
template <class Block>
HWY_ATTR inline bool trace_beams(Block& block, uint32_t first, uint32_t* singles, uint32_t& size) {
  if (!block.may_be_a_beam(first)) return false;
  if (block.may_have_one_origin(first)) return trace_kinds<true>(block, first, ~uint64_t{0}, singles, size);
  const uint64_t rays = find_rays(block, first);
  if (std::popcount(rays) < fewest_together || !trace_kinds<false>(block, first, rays, singles, size))
    return false;
  for (uint64_t none = ~rays; none != 0; none &= none - 1) {
    const uint32_t index = first + static_cast<uint32_t>(std::countr_zero(none));
    block.finish(index, false, {block.ray(index).tmax, 0, 0, layout::no_index}, 0);
  }
  return true;
}

#endif

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
