// SPDX-License-Identifier: MIT
#include "lodestone/mesh/distance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/mesh/triangle_points.h"

namespace lodestone::mesh {
namespace {

// Samples that are measured, and summed, one after the other.
constexpr uint64_t block = 2048;

// More than anybody waits for, and few enough for a double to count.
constexpr uint64_t most_samples = uint64_t(1) << 50;

double area(const Surface& surface, uint64_t triangle) {
  const glm::uvec3& corners = surface.triangles[triangle];
  const glm::dvec3 a = surface.positions[corners[0]];
  return 0.5 * glm::length(glm::cross(glm::dvec3(surface.positions[corners[1]]) - a,
                                      glm::dvec3(surface.positions[corners[2]]) - a));
}

// Where a surface is measured: triangle by triangle, first the corners that no earlier triangle has, then
// points inside.
class Samples {
 public:
  struct Sample {
    glm::dvec3 point;
    uint32_t triangle;
    double weight;  // the share of the area that it stands for; 0 of a corner
  };

  Samples(const Surface& surface, uint64_t inside)
      : surface_(surface), new_corners_(surface.triangles.size()), first_(surface.triangles.size() + 1) {
    find_new_corners();
    for (uint64_t triangle = 0; triangle < surface.triangles.size(); ++triangle)
      total_area_ += area(surface, triangle);
    parallel_for(new_corners_.size(), 1u << 14, [&](uint64_t begin, uint64_t end) {
      for (uint64_t triangle = begin; triangle < end; ++triangle) {
        const double deserved = std::floor(share(triangle) * static_cast<double>(inside) + 0.5);
        first_[triangle + 1] =
            std::max<uint64_t>(static_cast<uint64_t>(deserved), 1) + corner_count(triangle);
      }
    });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }

  uint64_t count() const { return first_.back(); }

  // Calls use(sample) for samples [begin, end).
  template <class Use>
  void visit(uint64_t begin, uint64_t end, const Use& use) const {
    uint64_t triangle = std::upper_bound(first_.begin(), first_.end(), begin) - first_.begin() - 1;
    while (begin < end) {
      const uint64_t here = std::min(end, first_[triangle + 1]);
      visit_triangle(static_cast<uint32_t>(triangle), begin - first_[triangle], here - first_[triangle], use);
      begin = here;
      ++triangle;
    }
  }

 private:
  void find_new_corners() {
    std::vector<bool> known(surface_.positions.size());
    for (uint64_t triangle = 0; triangle < surface_.triangles.size(); ++triangle) {
      for (int corner = 0; corner < 3; ++corner) {
        const uint32_t vertex = surface_.triangles[triangle][corner];
        if (!known[vertex]) new_corners_[triangle] |= static_cast<uint8_t>(1u << corner);
        known[vertex] = true;
      }
    }
  }

  uint32_t corner_count(uint64_t triangle) const { return std::popcount(new_corners_[triangle]); }

  // Of the whole area.
  double share(uint64_t triangle) const {
    return total_area_ > 0 ? area(surface_, triangle) / total_area_
                           : 1.0 / static_cast<double>(surface_.triangles.size());
  }

  template <class Use>
  void visit_triangle(uint32_t triangle, uint64_t begin, uint64_t end, const Use& use) const {
    glm::dvec3 corners[3];
    uint64_t index = 0;  // of the sample in the triangle
    for (int corner = 0; corner < 3; ++corner) {
      corners[corner] = surface_.positions[surface_.triangles[triangle][corner]];
      if ((new_corners_[triangle] >> corner & 1u) == 0) continue;
      if (index >= begin && index < end) use(Sample{corners[corner], triangle, 0});
      ++index;
    }
    const uint64_t first_inside = index, all = first_[triangle + 1] - first_[triangle];
    const double weight = share(triangle) / static_cast<double>(all - first_inside);
    for (index = std::max(begin, first_inside); index < end; ++index) {
      const glm::dvec3 at = triangle_point(index - first_inside);
      use(Sample{at[0] * corners[0] + at[1] * corners[1] + at[2] * corners[2], triangle, weight});
    }
  }

  Surface surface_;
  std::vector<uint8_t> new_corners_;  // a bit a corner
  std::vector<uint64_t> first_;       // sample of each triangle
  double total_area_ = 0;
};

// What samples one after the other gave.
struct Part {
  double maximum = -1, sum = 0, square_sum = 0;
  FarPlace farthest;

  void add(const Samples::Sample& sample, const Nearest& nearest) {
    if (sample.weight > 0) {
      sum += sample.weight * nearest.distance;
      square_sum += sample.weight * nearest.distance * nearest.distance;
    }
    if (nearest.distance <= maximum) return;
    maximum = nearest.distance;
    farthest = {sample.point, sample.triangle, nearest.point, nearest.triangle};
  }
  void add(const Part& next) {
    sum += next.sum;
    square_sum += next.square_sum;
    if (next.maximum <= maximum) return;
    maximum = next.maximum;
    farthest = next.farthest;
  }
};

// The distance changes by no more than the way from sample to sample, which bounds the next search.
Part measure(const Samples& samples, uint64_t begin, uint64_t end, const TriangleTree& to) {
  constexpr double more_than_rounding = 1 + 1e-9;
  Part part;
  Nearest last;
  glm::dvec3 last_point(0);
  samples.visit(begin, end, [&](const Samples::Sample& sample) {
    const double within = (last.distance + glm::distance(last_point, sample.point)) * more_than_rounding;
    const Nearest nearest = to.nearest(sample.point, within);
    last = nearest.triangle != none ? nearest : to.nearest(sample.point);
    last_point = sample.point;
    part.add(sample, last);
  });
  return part;
}

}  // namespace

OneSidedDistance one_sided(const Surface& from, const TriangleTree& to, uint64_t samples) {
  check(from);
  OneSidedDistance result;
  if (from.triangles.empty()) return result;
  if (to.empty()) {
    result.maximum = result.mean = result.root_mean_square = std::numeric_limits<double>::infinity();
    return result;
  }
  const Samples points(from, std::min(samples, most_samples));
  std::vector<Part> parts((points.count() + block - 1) / block);
  parallel_for(points.count(), block,
               [&](uint64_t begin, uint64_t end) { parts[begin / block] = measure(points, begin, end, to); });
  Part whole;
  for (const Part& part : parts) whole.add(part);
  result.maximum = whole.maximum;
  result.mean = whole.sum;
  result.root_mean_square = std::sqrt(whole.square_sum);
  result.farthest = whole.farthest;
  result.samples = points.count();
  return result;
}

OneSidedDistance one_sided(const Surface& from, const Surface& to, uint64_t samples) {
  return one_sided(from, TriangleTree(to), samples);
}

SymmetricDistance symmetric(const Surface& a, const Surface& b, uint64_t samples) {
  return {one_sided(a, b, samples), one_sided(b, a, samples)};
}

}  // namespace lodestone::mesh
