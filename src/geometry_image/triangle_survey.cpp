// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/triangle_survey.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "lodestone/base/parallel.h"
#include "lodestone/geometry_image/collinear.h"
#include "lodestone/geometry_image/edge_use.h"
#include "lodestone/geometry_image/first_equal.h"
#include "lodestone/geometry_image/parallel_collect.h"
#include "lodestone/geometry_image/weld.h"

namespace lodestone::geometry_image {
namespace {

using Corners = std::array<uint32_t, 3>;

constexpr uint64_t grain = 1u << 12;  // triangles a task

// Which of a placement's samples the vertices of grids are, as far as edges are concerned.
enum SampleUse : uint8_t { used = 1, used_often = 2, on_border = 4 };

class Surveyor {
 public:
  Surveyor(const scene::Scene& scene, const scene::Assembly& assembly, const std::vector<uint32_t>& welded,
           const std::vector<bool>& as_grid)
      : scene_(scene), assembly_(assembly), welded_(welded), as_grid_(as_grid) {}

  TriangleSurvey run() {
    survey_.fates.resize(assembly_.triangles.size());
    for (size_t p = 0; p < as_grid_.size(); ++p) {
      const TriangleRange range = triangles_of(p);
      parallel_for(range.count, grain, [&](uint64_t begin, uint64_t end) {
        for (uint64_t i = begin; i < end; ++i) {
          const auto t = static_cast<uint32_t>(range.first + i);
          fate(t) = judge_alone(t, as_grid_[p]);
        }
      });
    }
    drop_duplicates();
    count_edges();
    return std::move(survey_);
  }

 private:
  TriangleFate& fate(uint32_t triangle) { return survey_.fates[triangle]; }

  struct TriangleRange {
    uint32_t first, count;
  };
  TriangleRange triangles_of(size_t placement) const {
    const scene::Placement& placed = assembly_.placements[placement];
    return {placed.first_triangle, static_cast<uint32_t>(scene_.meshes[placed.mesh].triangles.size())};
  }

  Corners corners(uint32_t triangle) const {
    const glm::uvec4& t = assembly_.triangles[triangle];
    return {welded_[t.x], welded_[t.y], welded_[t.z]};
  }

  // What can be said of a triangle without its neighbours; `dropped_flat` may be taken back when they are
  // known.
  TriangleFate judge_alone(uint32_t triangle, bool in_grid) const {
    const auto [a, b, c] = corners(triangle);
    if (a == b || b == c || c == a) return TriangleFate::dropped_collapsed;
    if (!exactly_collinear(assembly_.positions[a], assembly_.positions[b], assembly_.positions[c])) {
      return TriangleFate::kept;
    }
    const bool moves_as_one = same_deformation(assembly_, a, b) && same_deformation(assembly_, b, c);
    return moves_as_one && !in_grid ? TriangleFate::dropped_flat : TriangleFate::kept_flat;
  }

  // Among the triangles that get a chart of their own and are not collapsed.
  void drop_duplicates() {
    for (size_t p = 0; p < as_grid_.size(); ++p) {
      if (as_grid_[p]) continue;
      const TriangleRange range = triangles_of(p);
      const auto more = parallel_collect<uint32_t>(range.count, [&](uint64_t i, auto& list) {
        const auto t = static_cast<uint32_t>(range.first + i);
        if (survey_.fates[t] != TriangleFate::dropped_collapsed) list.push_back(t);
      });
      single_.insert(single_.end(), more.begin(), more.end());
    }
    const auto lowest_corner_first = [&](uint32_t i) {
      Corners c = corners(single_[i]);
      std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
      return c;
    };
    // The same triangle of another material is another one: it may show where the first is cut out.
    const auto material = [&](uint32_t i) {
      return assembly_.parts[assembly_.triangles[single_[i]].w].material;
    };
    const std::vector<uint32_t> first = first_equal(
        static_cast<uint32_t>(single_.size()),
        [&](uint32_t i) {
          WordHash hash;
          for (const uint32_t corner : lowest_corner_first(i)) hash.add(uint64_t(corner));
          return hash.value();
        },
        [&](uint32_t i, uint32_t j) {
          return material(i) == material(j) && lowest_corner_first(i) == lowest_corner_first(j);
        });
    for (uint32_t i = 0; i < first.size(); ++i) {
      if (first[i] != i) fate(single_[i]) = TriangleFate::dropped_duplicate;
    }
    std::erase_if(single_, [&](uint32_t t) { return fate(t) == TriangleFate::dropped_duplicate; });
  }

  // Flat triangles that lie between neighbours on all three sides stay: where they fill the gap between a
  // long edge and two short ones, the midpoints of these edges are rounded, and the surface is tight only
  // with the triangle between.
  void count_edges() {
    std::vector<uint32_t> half_edges;
    half_edges.reserve(3 * single_.size());
    for (const uint32_t t : single_) {
      for (uint32_t k = 0; k < 3; ++k) half_edges.push_back(3 * t + k);
    }
    const std::vector<uint32_t> of_grids = grid_half_edges();
    half_edges.insert(half_edges.end(), of_grids.begin(), of_grids.end());

    EdgeUse edges(assembly_, welded_, half_edges);
    std::vector<size_t> open;
    for (size_t i = 0; i < single_.size(); ++i) {
      TriangleFate& own = fate(single_[i]);
      if (own != TriangleFate::dropped_flat) continue;
      const bool sealed =
          edges.triangles(3 * i) > 1 && edges.triangles(3 * i + 1) > 1 && edges.triangles(3 * i + 2) > 1;
      if (sealed) {
        own = TriangleFate::kept_flat;
      } else {
        open.push_back(i);
      }
    }
    for (const size_t i : open) {
      for (size_t k = 0; k < 3; ++k) edges.remove(3 * i + k);
    }
    survey_.boundary_edges = edges.boundary_edges();
    survey_.non_manifold_edges = edges.non_manifold_edges();
  }

  // The half-edges of grids but for those whose edge has two triangles for certain: an edge from a vertex
  // that is one inner sample and no other to a vertex that is one sample and no other.
  std::vector<uint32_t> grid_half_edges() const {
    std::vector<uint32_t> list;
    if (std::find(as_grid_.begin(), as_grid_.end(), true) == as_grid_.end()) return list;
    const std::vector<uint8_t> uses = sample_uses();
    const auto is_certain = [&](HalfEdge edge) {
      const uint8_t from = uses[edge.from], to = uses[edge.to];
      return ((from | to) & used_often) == 0 && (from & to & on_border) == 0;
    };
    for (size_t p = 0; p < as_grid_.size(); ++p) {
      if (!as_grid_[p]) continue;
      const TriangleRange range = triangles_of(p);
      const auto more = parallel_collect<uint32_t>(range.count, [&](uint64_t i, auto& edges) {
        const auto t = static_cast<uint32_t>(range.first + i);
        if (survey_.fates[t] == TriangleFate::dropped_collapsed) return;
        for (uint32_t k = 0; k < 3; ++k) {
          if (!is_certain(half_edge(assembly_, welded_, 3 * t + k))) edges.push_back(3 * t + k);
        }
      });
      list.insert(list.end(), more.begin(), more.end());
    }
    return list;
  }

  // By welded vertex.
  std::vector<uint8_t> sample_uses() const {
    std::vector<uint8_t> uses(assembly_.positions.size(), 0);
    for (size_t p = 0; p < as_grid_.size(); ++p) {
      if (!as_grid_[p]) continue;
      const scene::Placement& placement = assembly_.placements[p];
      for (const scene::Grid& grid : scene_.meshes[placement.mesh].grids) {
        parallel_for(grid.vertices.size(), grain, [&](uint64_t begin, uint64_t end) {
          for (uint64_t i = begin; i < end; ++i) {
            const uint64_t x = i % grid.width, y = i / grid.width;
            std::atomic_ref<uint8_t> use(uses[welded_[placement.first_vertex + grid.vertices[i]]]);
            if ((use.fetch_or(used, std::memory_order_relaxed) & used) != 0) {
              use.fetch_or(used_often, std::memory_order_relaxed);
            }
            const bool border = x == 0 || y == 0 || x + 1 == grid.width || y + 1 == grid.height;
            if (border) use.fetch_or(on_border, std::memory_order_relaxed);
          }
        });
      }
    }
    return uses;
  }

  const scene::Scene& scene_;
  const scene::Assembly& assembly_;
  const std::vector<uint32_t>& welded_;
  const std::vector<bool>& as_grid_;
  TriangleSurvey survey_;
  std::vector<uint32_t>
      single_;  // triangles that get charts of their own and are neither collapsed nor duplicates
};

}  // namespace

TriangleSurvey survey_triangles(const scene::Scene& scene, const scene::Assembly& assembly,
                                const std::vector<uint32_t>& welded, const std::vector<bool>& as_grid) {
  return Surveyor(scene, assembly, welded, as_grid).run();
}

}  // namespace lodestone::geometry_image
