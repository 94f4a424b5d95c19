// SPDX-License-Identifier: MIT
#include "uniform_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "lodestone/base/parallel.h"

namespace lodestone::test {
namespace {

using glm::ivec3, glm::uvec3, glm::vec3;

constexpr float infinity = std::numeric_limits<float>::infinity();
// Of the size of the whole: the grid is larger than the triangles by this, and a triangle is in the cells
// that its box enlarged by this touches, so that rounding loses none.
constexpr float margin = 1e-5f;

}  // namespace

template <class Visit>
void UniformGrid::visit_cells(const Triangle& triangle, const Visit& visit) const {
  const vec3 slack = (hi_ - lo_) * margin;
  const vec3 lo = glm::min(glm::min(triangle.a, triangle.b), triangle.c) - slack;
  const vec3 hi = glm::max(glm::max(triangle.a, triangle.b), triangle.c) + slack;
  const vec3 last = vec3(cells_) - 1.0f;
  const uvec3 from(glm::clamp(glm::floor((lo - lo_) / cell_), vec3(0), last));
  const uvec3 to(glm::clamp(glm::floor((hi - lo_) / cell_), vec3(0), last));
  const vec3 normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
  for (uint32_t z = from.z; z <= to.z; ++z) {
    for (uint32_t y = from.y; y <= to.y; ++y) {
      for (uint32_t x = from.x; x <= to.x; ++x) {
        // The cells that the triangle's plane passes by hold nothing of it.
        const vec3 centre = lo_ + (vec3(x, y, z) + 0.5f) * cell_;
        const float reach = glm::dot(glm::abs(normal), 0.5f * cell_ + slack);
        if (std::abs(glm::dot(normal, centre - triangle.a)) <= reach)
          visit(x + cells_.x * (y + cells_.y * z));
      }
    }
  }
}

UniformGrid::UniformGrid(std::vector<Triangle> triangles, float density) : triangles_(std::move(triangles)) {
  if (triangles_.empty()) throw std::invalid_argument("a grid needs triangles");
  lo_ = vec3(infinity);
  hi_ = vec3(-infinity);
  for (const Triangle& t : triangles_) {
    lo_ = glm::min(lo_, glm::min(glm::min(t.a, t.b), t.c));
    hi_ = glm::max(hi_, glm::max(glm::max(t.a, t.b), t.c));
  }
  const float longest = std::max(std::max(hi_.x - lo_.x, hi_.y - lo_.y), hi_.z - lo_.z);
  if (!(longest > 0)) throw std::invalid_argument("all triangles lie in one point");
  lo_ -= longest * margin;
  hi_ += longest * margin;
  const vec3 size = hi_ - lo_;
  const float side = std::cbrt(size.x * size.y * size.z / (density * static_cast<float>(triangles_.size())));
  cells_ = uvec3(glm::clamp(glm::round(size / side), vec3(1), vec3(512)));
  cell_ = size / vec3(cells_);
  first_.assign(size_t(cells_.x) * cells_.y * cells_.z + 1, 0);
  for (const Triangle& t : triangles_) visit_cells(t, [&](size_t cell) { ++first_[cell + 1]; });
  for (size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  references_.resize(first_.back());
  std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
  for (uint32_t i = 0; i < triangles_.size(); ++i)
    visit_cells(triangles_[i], [&](size_t cell) { references_[next[cell]++] = i; });
}

template <class Count>
TriangleHit UniformGrid::trace(const glm::vec4& from, const glm::vec4& along, Count& count) const {
  const vec3 origin(from), direction(along), inverse = 1.0f / direction;
  TriangleHit hit{along.w, 0, 0, no_triangle};
  const vec3 to_lo = (lo_ - origin) * inverse, to_hi = (hi_ - origin) * inverse;
  const vec3 near = glm::min(to_lo, to_hi), far = glm::max(to_lo, to_hi);
  const float enter = std::max(std::max(near.x, near.y), std::max(near.z, from.w));
  const float exit = std::min(std::min(far.x, far.y), std::min(far.z, along.w));
  if (!(enter <= exit)) return hit;
  const vec3 place =
      glm::clamp(glm::floor((origin + enter * direction - lo_) / cell_), vec3(0), vec3(cells_) - 1.0f);
  ivec3 at(place);
  ivec3 step, end;
  vec3 next, on;  // where each axis's next plane is met, and from one to the next
  for (int axis = 0; axis < 3; ++axis) {
    const bool forward = direction[axis] > 0;
    step[axis] = forward ? 1 : -1;
    end[axis] = forward ? static_cast<int>(cells_[axis]) : -1;
    on[axis] = direction[axis] == 0 ? infinity : cell_[axis] * std::abs(inverse[axis]);
    const float plane = lo_[axis] + (place[axis] + (forward ? 1.0f : 0.0f)) * cell_[axis];
    next[axis] = direction[axis] == 0 ? infinity : (plane - origin[axis]) * inverse[axis];
  }
  for (;;) {
    count.step();
    const size_t cell = size_t(at.x) + cells_.x * (size_t(at.y) + cells_.y * size_t(at.z));
    for (uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
      count.test();
      if (test::intersect(triangles_[references_[i]], origin, direction, from.w, hit))
        hit.triangle = references_[i];
    }
    const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    // What was hit may lie behind this cell, where nearer ones of other cells come first.
    if (hit.t <= next[axis]) return hit;
    at[axis] += step[axis];
    if (at[axis] == end[axis]) return hit;
    next[axis] += on[axis];
  }
}

void UniformGrid::intersect(const Rays& rays, std::vector<TriangleHit>& hits) const {
  hits.resize(rays.size() / 2);
  parallel_for(hits.size(), 1024, [&](uint64_t begin, uint64_t end) {
    NoCounts none;
    for (uint64_t i = begin; i < end; ++i) hits[i] = trace(rays[2 * i], rays[2 * i + 1], none);
  });
}

TraceCounts UniformGrid::count(const Rays& rays) const {
  TraceCounts counts;
  for (size_t i = 0; i < rays.size(); i += 2) trace(rays[i], rays[i + 1], counts);
  return counts;
}

}  // namespace lodestone::test
