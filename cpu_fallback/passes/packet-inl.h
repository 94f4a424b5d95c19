// SPDX-License-Identifier: MIT
// Sixteen rays of one octant together through the tree, in the order of that octant; a node is read once for
// all of them. Lane by lane the arithmetic is that of layout/trace.h. Included once a SIMD target.

#if defined(LODESTONE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LODESTONE_PACKET_INL_H_
#undef LODESTONE_PACKET_INL_H_
#else
#define LODESTONE_PACKET_INL_H_
#endif

#include <hwy/highway.h>

#include "lodestone/cpu_fallback/passes/trace_block.h"

HWY_BEFORE_NAMESPACE();
namespace lodestone::cpu_fallback::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, packet_rays>;
using Floats = hn::Vec<Lanes>;
using Mask = hn::Mask<Lanes>;
using Ids = hn::Vec<hn::RebindToUnsigned<Lanes>>;

struct Vec3 {
  Floats x, y, z;
};

HWY_ATTR inline Vec3 sub(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_ATTR inline Floats edge_function(const Vec3& p, const Vec3& q) {
  return hn::Sub(hn::Mul(p.x, q.y), hn::Mul(p.y, q.x));
}

// Hits of `rays` rays so far, structure of arrays; u and v are these over `sum`, which one division in the
// end says as well as one a hit.
template <uint32_t rays>
struct BestHits {
  alignas(64) float t[rays], u[rays], v[rays], sum[rays];
  alignas(64) uint32_t primitive[rays];

  HWY_ATTR void begin(uint32_t lane, Floats tmax) {
    const Lanes d;
    const hn::RebindToUnsigned<Lanes> du;
    hn::Store(tmax, d, t + lane);
    hn::Store(hn::Zero(d), d, u + lane);
    hn::Store(hn::Zero(d), d, v + lane);
    hn::Store(hn::Set(d, 1.0f), d, sum + lane);
    hn::Store(hn::Set(du, layout::no_index), du, primitive + lane);
  }
};

// The packet's rays and best hits, structure of arrays.
struct Packet {
  alignas(64) float origin[3][packet_rays], shear[3][packet_rays], inverse[3][packet_rays];
  alignas(64) float near_origin[3][packet_rays], far_origin[3][packet_rays];
  alignas(64) float tmin[packet_rays];
  BestHits<packet_rays> best;
  alignas(64) uint32_t axis[packet_rays];
  bool is_ray[packet_rays];
};

HWY_ATTR inline Vec3 load3(const float (&a)[3][packet_rays], uint32_t lane) {
  const Lanes d;
  return {hn::Load(d, a[0] + lane), hn::Load(d, a[1] + lane), hn::Load(d, a[2] + lane)};
}

// Both triangles of a quad for the lanes from `lane` on that entered its bound.
struct QuadTest {
  const Lanes d;
  const hn::RebindToUnsigned<Lanes> du;
  Floats tmin, enter, best_t, best_u, best_v, best_sum;
  Ids best_primitive;

  template <uint32_t rays>
  HWY_ATTR QuadTest(const BestHits<rays>& best, uint32_t lane, Floats ray_tmin, Floats quad_enter)
      : tmin(ray_tmin),
        enter(quad_enter),
        best_t(hn::Load(d, best.t + lane)),
        best_u(hn::Load(d, best.u + lane)),
        best_v(hn::Load(d, best.v + lane)),
        best_sum(hn::Load(d, best.sum + lane)),
        best_primitive(hn::Load(du, best.primitive + lane)) {}

  template <uint32_t rays>
  HWY_ATTR void store(BestHits<rays>& best, uint32_t lane) const {
    hn::Store(best_t, d, best.t + lane);
    hn::Store(best_u, d, best.u + lane);
    hn::Store(best_v, d, best.v + lane);
    hn::Store(best_sum, d, best.sum + lane);
    hn::Store(best_primitive, du, best.primitive + lane);
  }

  HWY_ATTR void accept(const Vec3& p0, const Vec3& p1, const Vec3& p2, Floats w0, Floats w1, Floats w2,
                       Mask entered, uint32_t primitive) {
    const auto zero = hn::Zero(d);
    const Mask positive = hn::And(hn::And(hn::Ge(w0, zero), hn::Ge(w1, zero)), hn::Ge(w2, zero));
    const Mask negative = hn::And(hn::And(hn::Le(w0, zero), hn::Le(w1, zero)), hn::Le(w2, zero));
    const Floats sum = hn::Add(hn::Add(w0, w1), w2);
    Mask hit = hn::And(hn::And(hn::Or(positive, negative), entered), hn::Ne(sum, zero));
    if (hn::AllFalse(d, hit)) return;
    Floats t = hn::Div(hn::Add(hn::Add(hn::Mul(w0, p0.z), hn::Mul(w1, p1.z)), hn::Mul(w2, p2.z)), sum);
    hit = hn::And(hit, hn::Gt(t, tmin));
    t = hn::IfThenElse(hn::Lt(t, enter), enter, t);
    const Ids ids = hn::Set(du, primitive);
    const Mask lower = hn::RebindMask(d, hn::Lt(ids, best_primitive));
    hit = hn::And(hit, hn::Or(hn::Lt(t, best_t), hn::And(hn::Eq(t, best_t), lower)));
    best_t = hn::IfThenElse(hit, t, best_t);
    best_u = hn::IfThenElse(hit, w1, best_u);
    best_v = hn::IfThenElse(hit, w2, best_v);
    best_sum = hn::IfThenElse(hit, sum, best_sum);
    best_primitive = hn::IfThenElse(hn::RebindMask(du, hit), ids, best_primitive);
  }
};

// layout::sheared for each lane; `along_x`, `along_y`: the lanes whose rays run mostly that way.
struct Shearing {
  Vec3 origin, shear;
  Mask along_x, along_y;

  HWY_ATTR Vec3 operator()(const glm::vec3& point) const {
    const Lanes d;
    const Vec3 p = sub({hn::Set(d, point.x), hn::Set(d, point.y), hn::Set(d, point.z)}, origin);
    const Floats x = hn::IfThenElse(along_x, p.y, hn::IfThenElse(along_y, p.z, p.x));
    const Floats y = hn::IfThenElse(along_x, p.z, hn::IfThenElse(along_y, p.x, p.y));
    const Floats z = hn::IfThenElse(along_x, p.x, hn::IfThenElse(along_y, p.y, p.z));
    return {hn::Sub(x, hn::Mul(shear.x, z)), hn::Sub(y, hn::Mul(shear.y, z)), hn::Mul(shear.z, z)};
  }
};

template <class Block>
HWY_ATTR inline void test_quad(Block& block, const TraceTree& tree, Packet& packet, uint32_t address,
                               uint32_t lane, Mask entered, Floats enter) {
  const Lanes d;
  const hn::RebindToUnsigned<Lanes> du;
  const uint32_t texel = tree.leaf_texel(address), stride = tree.leaf_stride(address);
  const Ids axis = hn::Load(du, packet.axis + lane);
  const Shearing shearing{load3(packet.origin, lane), load3(packet.shear, lane),
                          hn::RebindMask(d, hn::Eq(axis, hn::Set(du, 0))),
                          hn::RebindMask(d, hn::Eq(axis, hn::Set(du, 1)))};
  const Vec3 a = shearing(block.texel(texel)), b = shearing(block.texel(texel + 1));
  const Vec3 c = shearing(block.texel(texel + stride)), e = shearing(block.texel(texel + stride + 1));
  const Floats bc = edge_function(b, c);
  QuadTest test(packet.best, lane, hn::Load(d, packet.tmin + lane), enter);
  test.accept(a, b, c, bc, edge_function(c, a), edge_function(a, b), entered, 2 * texel);
  test.accept(e, c, b, hn::Neg(bc), edge_function(b, e), edge_function(e, c), entered, 2 * texel + 1);
  test.store(packet.best, lane);
  if (Block::counting) block.count_quad(static_cast<uint32_t>(hn::CountTrue(d, entered)));
}

template <class Block>
HWY_ATTR inline void load_packet(const Block& block, float extent, uint32_t first, uint32_t count,
                                 Packet& packet) {
  for (uint32_t lane = 0; lane < packet_rays; ++lane) {
    layout::Ray ray = block.ray(first + std::min(lane, count - 1));
    if (lane >= count) ray.tmax = -1;
    const layout::Slabs slabs = layout::make_slabs(ray, extent);
    const layout::Shear shear = layout::make_shear(ray);
    packet.axis[lane] = shear.axis;
    packet.shear[0][lane] = shear.x;
    packet.shear[1][lane] = shear.y;
    packet.shear[2][lane] = shear.z;
    for (int axis = 0; axis < 3; ++axis) {
      packet.origin[axis][lane] = ray.origin[axis];
      packet.inverse[axis][lane] = slabs.inverse[axis];
      packet.near_origin[axis][lane] = slabs.near_origin[axis];
      packet.far_origin[axis][lane] = slabs.far_origin[axis];
    }
    packet.tmin[lane] = ray.tmin;
    packet.is_ray[lane] = !(ray.tmax < 0.0f);
    packet.best.t[lane] = ray.tmax;
    packet.best.u[lane] = packet.best.v[lane] = 0;
    packet.best.sum[lane] = 1;
    packet.best.primitive[lane] = layout::no_index;
  }
}

template <class Block>
HWY_ATTR inline void trace_packet(Block& block, uint32_t first, uint32_t count) {
  const Lanes d;
  const uint32_t width = static_cast<uint32_t>(hn::Lanes(d));
  const TraceTree tree = block.tree(first);
  Packet packet;
  load_packet(block, tree.extent(), first, count, packet);
  const uint32_t octant = layout::make_slabs(block.ray(first), tree.extent()).octant;
  const bool x = (octant & 1) != 0, y = (octant & 2) != 0, z = (octant & 4) != 0;
  layout::Walk walk{0, 0, 0};
  uint32_t visits = 0;
  while (walk.depth != layout::walk_done) {
    const uint32_t address = layout::walk_address(walk);
    const float* lo = tree.nodes_lo(address);
    const float* hi = tree.nodes_hi(address);
    const Vec3 near_plane{hn::Set(d, x ? hi[0] : lo[0]), hn::Set(d, y ? hi[1] : lo[1]),
                          hn::Set(d, z ? hi[2] : lo[2])};
    const Vec3 far_plane{hn::Set(d, x ? lo[0] : hi[0]), hn::Set(d, y ? lo[1] : hi[1]),
                         hn::Set(d, z ? lo[2] : hi[2])};
    const bool leaf = walk.depth == tree.depth();
    bool inside = false;
    uint32_t active = 0;
    for (uint32_t lane = 0; lane < packet_rays; lane += width) {
      const Vec3 inverse = load3(packet.inverse, lane);
      const Vec3 from3 = sub(near_plane, load3(packet.near_origin, lane));
      const Vec3 to3 = sub(far_plane, load3(packet.far_origin, lane));
      const Floats enter = hn::Max(hn::Max(hn::Mul(from3.x, inverse.x), hn::Mul(from3.y, inverse.y)),
                                   hn::Max(hn::Mul(from3.z, inverse.z), hn::Load(d, packet.tmin + lane)));
      const Floats exit = hn::Min(hn::Min(hn::Mul(to3.x, inverse.x), hn::Mul(to3.y, inverse.y)),
                                  hn::Min(hn::Mul(to3.z, inverse.z), hn::Load(d, packet.best.t + lane)));
      const Mask entered = hn::Le(enter, exit);
      if (hn::AllFalse(d, entered)) continue;
      inside = true;
      if (Block::counting) active += static_cast<uint32_t>(hn::CountTrue(d, entered));
      if (leaf) {
        test_quad(block, tree, packet, address, lane, entered, enter);
      } else if (!Block::counting && lane + width < packet_rays) {
        break;  // one ray that enters takes all of them along
      }
    }
    block.count_step(count, active);
    ++visits;
    walk = inside && !leaf ? layout::walk_down(walk, (tree.order(address) >> (2 * octant)) & 3u)
                           : layout::walk_on(walk);
  }
  for (uint32_t i = 0; i < count; ++i) {
    const auto& best = packet.best;
    block.finish(first + i, packet.is_ray[i],
                 {best.t[i], best.u[i] / best.sum[i], best.v[i] / best.sum[i], best.primitive[i]}, visits);
  }
}

}  // namespace lodestone::cpu_fallback::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
