// SPDX-License-Identifier: MIT
#include "threaded_bvh.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "lodestone/base/parallel.h"

namespace lodestone::test {
namespace {

using glm::vec3;

constexpr uint32_t bin_count = 32;
constexpr float infinity = std::numeric_limits<float>::infinity();
// So that rounding does not close a box before a ray that touches it (T. Ize, "Robust BVH Ray Traversal",
// 2013).
constexpr float slack = 1 + 6 * std::numeric_limits<float>::epsilon() / 2;

struct Box {
  vec3 lo{infinity}, hi{-infinity};
  void include(const Box& other) {
    lo = glm::min(lo, other.lo);
    hi = glm::max(hi, other.hi);
  }
  float half_area() const {
    const vec3 size = hi - lo;
    return size.x < 0 ? 0 : size.x * size.y + size.y * size.z + size.z * size.x;
  }
};

struct Item {
  Box box;
  vec3 centre;
  uint32_t triangle;
};

struct Split {
  float cost = infinity;
  int axis = 0;
  uint32_t bin = 0;  // those below go first
};

using Items = std::vector<Item>::iterator;

// Which bin of an axis a centre is in.
struct Binning {
  float lo, scale;
  uint32_t bin_of(float centre) const {
    return std::min(static_cast<uint32_t>((centre - lo) * scale), bin_count - 1);
  }
};

Split best_split(Items begin, Items end, int axis, const Binning& binning) {
  std::array<Box, bin_count> boxes;
  std::array<uint32_t, bin_count> counts{};
  for (Items item = begin; item != end; ++item) {
    const uint32_t bin = binning.bin_of(item->centre[axis]);
    boxes[bin].include(item->box);
    ++counts[bin];
  }
  std::array<float, bin_count> above{};  // the cost of bins from here on
  Box box;
  uint32_t count = 0;
  for (uint32_t bin = bin_count; bin-- > 1;) {
    box.include(boxes[bin]);
    count += counts[bin];
    above[bin] = box.half_area() * static_cast<float>(count);
  }
  Split best;
  box = {};
  count = 0;
  for (uint32_t bin = 1; bin < bin_count; ++bin) {
    box.include(boxes[bin - 1]);
    count += counts[bin - 1];
    const float cost = box.half_area() * static_cast<float>(count) + above[bin];
    if (count > 0 && count < static_cast<uint32_t>(end - begin) && cost < best.cost) best = {cost, axis, bin};
  }
  return best;
}

Items divide(Items begin, Items end) {
  Box centres;
  for (Items item = begin; item != end; ++item) centres.include({item->centre, item->centre});
  const vec3 size = centres.hi - centres.lo;
  std::array<Binning, 3> binnings{};
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] > 0)) continue;
    binnings[axis] = {centres.lo[axis], static_cast<float>(bin_count) / size[axis]};
    const Split split = best_split(begin, end, axis, binnings[axis]);
    if (split.cost < best.cost) best = split;
  }
  if (best.cost == infinity) return begin + (end - begin) / 2;
  return std::partition(begin, end, [&](const Item& item) {
    return binnings[best.axis].bin_of(item.centre[best.axis]) < best.bin;
  });
}

// The nodes over [begin, end), behind those that are there.
void add_nodes(Items begin, Items end, std::vector<ThreadedBvh::Node>& nodes) {
  Box box;
  for (Items item = begin; item != end; ++item) box.include(item->box);
  const size_t self = nodes.size();
  const bool leaf = end - begin == 1;
  nodes.push_back({box.lo, 0, box.hi, leaf ? begin->triangle : no_triangle});
  if (!leaf) {
    const Items middle = divide(begin, end);
    add_nodes(begin, middle, nodes);
    add_nodes(middle, end, nodes);
  }
  nodes[self].miss = static_cast<uint32_t>(nodes.size());
}

}  // namespace

ThreadedBvh::ThreadedBvh(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  if (triangles_.empty()) throw std::invalid_argument("a hierarchy needs triangles");
  std::vector<Item> items;
  for (uint32_t i = 0; i < triangles_.size(); ++i) {
    const Triangle& t = triangles_[i];
    const Box box{glm::min(glm::min(t.a, t.b), t.c), glm::max(glm::max(t.a, t.b), t.c)};
    items.push_back({box, 0.5f * (box.lo + box.hi), i});
  }
  nodes_.reserve(2 * items.size() - 1);
  add_nodes(items.begin(), items.end(), nodes_);
}

template <class Count>
TriangleHit ThreadedBvh::trace(const glm::vec4& from, const glm::vec4& along, Count& count) const {
  const vec3 origin(from), direction(along), inverse = 1.0f / direction;
  TriangleHit hit{along.w, 0, 0, no_triangle};
  const auto end = static_cast<uint32_t>(nodes_.size());
  for (uint32_t at = 0; at < end;) {
    const Node& node = nodes_[at];
    count.step();
    const vec3 to_lo = (node.lo - origin) * inverse, to_hi = (node.hi - origin) * inverse;
    const vec3 near = glm::min(to_lo, to_hi), far = glm::max(to_lo, to_hi);
    const float enter = std::max(std::max(near.x, near.y), std::max(near.z, from.w));
    const float exit = std::min(std::min(far.x, far.y), std::min(far.z, hit.t));
    if (!(enter <= exit * slack)) {
      at = node.miss;
      continue;
    }
    if (node.triangle != no_triangle) {
      count.test();
      if (test::intersect(triangles_[node.triangle], origin, direction, from.w, hit))
        hit.triangle = node.triangle;
    }
    ++at;  // of a leaf that is the miss link as well
  }
  return hit;
}

void ThreadedBvh::intersect(const Rays& rays, std::vector<TriangleHit>& hits) const {
  hits.resize(rays.size() / 2);
  parallel_for(hits.size(), 1024, [&](uint64_t begin, uint64_t end) {
    NoCounts none;
    for (uint64_t i = begin; i < end; ++i) hits[i] = trace(rays[2 * i], rays[2 * i + 1], none);
  });
}

TraceCounts ThreadedBvh::count(const Rays& rays) const {
  TraceCounts counts;
  for (size_t i = 0; i < rays.size(); i += 2) trace(rays[i], rays[i + 1], counts);
  return counts;
}

}  // namespace lodestone::test
