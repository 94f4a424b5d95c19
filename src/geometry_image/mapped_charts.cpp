// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/mapped_charts.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "lodestone/base/disjoint_sets.h"
#include "lodestone/base/parallel.h"
#include "lodestone/base_complex/base_complex.h"
#include "lodestone/base_complex/dual.h"
#include "lodestone/geometry_image/chart_attempts.h"
#include "lodestone/geometry_image/chart_profile.h"
#include "lodestone/geometry_image/chart_seams.h"
#include "lodestone/geometry_image/chart_sizes.h"
#include "lodestone/geometry_image/profile_maker.h"
#include "lodestone/geometry_image/sampled_charts.h"
#include "lodestone/geometry_image/screen_need.h"
#include "lodestone/geometry_image/shape_metrics.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::BaseComplex;
using base_complex::Cell;
using base_complex::CellOptions;
using base_complex::Cells;
using base_complex::HalfEdgeMesh;
using base_complex::NotMappable;
using base_complex::TriangleShape;

// Charts have about this many triangles at least, and a surface about this many charts at most, but for what
// its shape and its seams demand.
constexpr uint32_t triangles_a_chart = 100, most_cells = 128;
// An edge this much longer than a cell's radius is split first: borders of cells follow edges, and along long
// thin triangles they would be jagged.
constexpr double longest_edge = 0.35;
// What charts need. With Signal::area what a chart's profile says counts so little that it matters only where
// the surface is bent as sharply as its charts are wide; with Signal::curvature it counts, within bounds.
Need need_of(Signal signal) {
  constexpr double flattest = 0.04;
  return signal == Signal::curvature ? Need{flattest, 0.12, 1, {}, {}, {}}
                                     : Need{flattest, 0.5, 0.15, {}, {}, {}};
}
// Charts farther from the surface than this, in diagonals of all, get more texels at the cost of the others.
constexpr double tolerated = 0.004;
// Cells with more arcs are split: a side has a segment for each of its arcs at least, so the fewest quads of
// a cell go with the square of their number.
constexpr size_t most_arcs = 16;
// Even maps, and a proper dual, are cared for only while the budget is so many times what the cells need:
// each has arcs of its own, which cost texels that all others then lack.
constexpr uint64_t plenty_for_evenness = 6, plenty_for_dual = 8;

// In the rest pose. A transform may overflow: such a point lies anywhere, but somewhere.
std::vector<glm::vec3> finite_positions(const scene::Scene& scene, const scene::Assembly& assembly) {
  std::vector<glm::vec3> positions = scene::rest_positions(scene, assembly);
  for (glm::vec3& p : positions)
    for (glm::length_t axis = 0; axis < 3; ++axis)
      if (!std::isfinite(p[axis])) p[axis] = 0;
  return positions;
}

class ChartMaker {
 public:
  ChartMaker(const scene::Scene& scene, const scene::Assembly& assembly, const std::vector<uint32_t>& welded,
             const ChartSettings& settings, const OnStage& on_stage)
      : scene_(scene),
        assembly_(assembly),
        welded_(welded),
        settings_(settings),
        on_stage_(on_stage),
        positions_(finite_positions(scene, assembly)) {
    if (settings.all_shapes) metrics_.emplace(scene, assembly);
    if (settings.signal == Signal::screen) views_ = screen_views(scene);
  }

  MappedCharts run(std::vector<uint32_t> triangles) {
    triangles_ = std::move(triangles);
    budget_ = settings_.texel_budget != 0 ? settings_.texel_budget : default_budget();
    MappedCharts result;
    while (!triangles_.empty() && !make(result)) {
    }
    result.left_out = std::move(left_out_);
    std::sort(result.left_out.begin(), result.left_out.end());
    return result;
  }

 private:
  void stage(const char* name) const {
    if (on_stage_) on_stage_(name);
  }

  // A texel a triangle is twice as fine as the mesh; exact charts have nine.
  uint64_t default_budget() const {
    constexpr uint64_t few = 1u << 14, of_exact = 9;
    const uint64_t triangles = triangles_.size();
    return std::min(of_exact * triangles, std::max(few, triangles));
  }

  // False where something had to be left out, and all begins again without it.
  bool make(MappedCharts& result) {
    constexpr int most_rounds = 24;
    stage("seams");
    corners_.clear();
    for (const uint32_t t : triangles_) corners_.emplace_back(assembly_.triangles[t]);
    tree_.emplace(mesh::Surface{positions_, corners_});
    HalfEdgeMesh mesh = make_mesh();
    mark_seams(scene_, assembly_, triangles_, mesh);
    CellOptions options;
    options.cells =
        static_cast<uint32_t>(std::clamp<size_t>(triangles_.size() / triangles_a_chart, 1, most_cells));
    // However thin and long a surface is, it does not fall apart into more faces than memory holds.
    const uint32_t most_faces = 2 * mesh.faces() + 20000;
    const double radius = base_complex::cell_radius(mesh, options);
    if (radius > 0) mesh.split_longer_than(longest_edge * radius, most_faces);
    stage("cells");
    Cells cells = grow_cells(mesh, options);
    if (leave_out_soup(mesh, cells)) return false;
    Progress progress;
    for (int round = 0;; ++round) {
      const std::vector<uint32_t> to_split = try_cells(mesh, cells, progress);
      const uint32_t stuck =
          to_split.empty() ? base_complex::none : split(mesh, cells, to_split, round < most_rounds);
      if (to_split.empty() || (stuck != base_complex::none && progress.best)) {
        result = progress.best->finish();
        return true;
      }
      if (stuck != base_complex::none) {
        leave_out_cell(mesh, cells, stuck);
        return false;
      }
    }
  }

  // Returns a cell that cannot be split any more, if there is one; then the others may be split or not.
  static uint32_t split(HalfEdgeMesh& mesh, Cells& cells, const std::vector<uint32_t>& to_split, bool may) {
    std::vector<std::vector<uint32_t>> faces = faces_by_cell(cells);
    for (const uint32_t cell : to_split)
      if (!may || !halve_cell(mesh, cells, faces, cell)) return cell;
    make_discs(mesh, cells);
    return base_complex::none;
  }

  HalfEdgeMesh make_mesh() const {
    std::vector<glm::uvec3> corners;
    corners.reserve(triangles_.size());
    for (const uint32_t t : triangles_) {
      const glm::uvec4& triangle = assembly_.triangles[t];
      corners.emplace_back(welded_[triangle.x], welded_[triangle.y], welded_[triangle.z]);
    }
    return HalfEdgeMesh(std::vector<glm::dvec3>(positions_.begin(), positions_.end()), corners);
  }

  // How often cells may still be split that have too many arcs, those for which the dual is not proper, those
  // whose maps are uneven (many are so however small they are), and those that stay too far from the surface.
  struct RoundsLeft {
    int crowded = 6, improper = 6, uneven = 4, far = 6;
  };
  // What rounds leave for later ones.
  struct Progress {
    RoundsLeft left;
    std::unique_ptr<ChartAttempts> best;
    std::vector<double> found;  // of the charts of the last round, as Need::found
  };

  // Makes charts of the cells, the best of all so far. Returns cells to split for a better try: those that
  // could not be mapped, or not well.
  std::vector<uint32_t> try_cells(const HalfEdgeMesh& mesh, const Cells& cells, Progress& progress) const {
    stage("complex");
    auto complex = std::make_unique<const BaseComplex>(build_complex(mesh, cells));
    RoundsLeft& left = progress.left;
    std::vector<uint32_t> crowded = crowded_cells(*complex);
    if (!crowded.empty() && left.crowded-- > 0) return crowded;
    const uint64_t least = least_texels(*complex);
    if (plenty_for_dual * least <= budget_ && left.improper-- > 0) {
      std::vector<uint32_t> improper = cells_against_proper_dual(*complex);
      std::erase_if(improper, [&](uint32_t c) { return complex->cells[c].faces.size() < 2; });
      if (!improper.empty()) return improper;
    }
    const ChartSource source = {
        *complex, assembly_, welded_, triangles_, metrics_ ? &*metrics_ : nullptr, settings_.keep_maps};
    std::vector<std::optional<ChartProfile>> made(complex->cells.size());
    stage("profiles");
    std::vector<uint32_t> failed = profile(source, made);
    if (!failed.empty()) return failed;
    std::vector<ChartProfile> profiles;
    for (std::optional<ChartProfile>& p : made) profiles.push_back(std::move(*p));
    Need to_begin_with = need(source);
    to_begin_with.found = progress.found;
    const mesh::Surface surface = {positions_, corners_};
    const Target target = {positions_, surface, *tree_, tolerated * mesh::diagonal(surface), budget_};
    auto attempts = std::make_unique<ChartAttempts>(std::move(complex), source, std::move(profiles),
                                                    std::move(to_begin_with), target, on_stage_);
    const ChartAttempts::Outcome outcome =
        attempts->run({.even = plenty_for_evenness * least <= budget_ && left.uneven > 0,
                       .near = affordable(least) && left.far > 0});
    if (outcome.fault == ChartAttempts::Fault::uneven) --left.uneven;
    if (outcome.fault == ChartAttempts::Fault::far) {
      --left.far;
      progress.found = attempts->found();
      for (const uint32_t c : outcome.cells) progress.found[c] = 0;
    }
    const bool better = !progress.best || attempts->badness() < progress.best->badness();
    if (attempts->exist() && better) progress.best = std::move(attempts);
    return outcome.cells;
  }

  static std::vector<uint32_t> crowded_cells(const BaseComplex& complex) {
    std::vector<uint32_t> list;
    for (uint32_t c = 0; c < complex.cells.size(); ++c) {
      const Cell& cell = complex.cells[c];
      if (cell.boundary.size() > most_arcs && cell.faces.size() > most_arcs) list.push_back(c);
    }
    return list;
  }

  bool affordable(uint64_t least) const { return 4 * least <= 3 * budget_; }

  Need need(const ChartSource& source) const {
    Need need = need_of(settings_.signal);
    if (metrics_) need.chart_weights = shape_weights(source);
    if (!views_.empty()) {
      const std::vector<double> weights = screen_weights(source.complex, views_);
      need.chart_weights.resize(weights.size(), 1.0);
      for (size_t c = 0; c < weights.size(); ++c) need.chart_weights[c] *= weights[c];
    }
    return need;
  }

  // How much longer each cell is in the shapes that stretch it most.
  static std::vector<double> shape_weights(const ChartSource& source) {
    std::vector<double> weights(source.complex.cells.size(), 1.0);
    for (uint32_t c = 0; c < weights.size(); ++c) {
      double stretched = 0;
      for (const TriangleShape& shape : source.shapes(c)) stretched += shape.area;
      const double area = source.complex.cells[c].area;
      if (area > 0) weights[c] = std::sqrt(stretched / area);
    }
    return weights;
  }

  std::vector<uint32_t> profile(const ChartSource& source,
                                std::vector<std::optional<ChartProfile>>& found) const {
    const ProfileMaker maker(source.complex, budget_);
    std::vector<uint8_t> failed(found.size(), 0);
    parallel_for(found.size(), 1, [&](uint64_t begin, uint64_t end) {
      for (auto c = static_cast<uint32_t>(begin); c < end; ++c) {
        try {
          found[c] = maker.make(c, source.shapes(c));
        } catch (const NotMappable&) {
          failed[c] = 1;
        }
      }
    });
    std::vector<uint32_t> list;
    for (uint32_t c = 0; c < failed.size(); ++c)
      if (failed[c] != 0) list.push_back(c);
    return list;
  }

  // The points of the mesh in groups that edges connect: of each the name of its group.
  static std::vector<uint32_t> connected(const HalfEdgeMesh& mesh) {
    DisjointSets sets(mesh.points());
    for (uint32_t h = 0; h < 3 * mesh.faces(); ++h) sets.join(mesh.from(h), mesh.to(h));
    std::vector<uint32_t> group(mesh.points());
    for (uint32_t p = 0; p < group.size(); ++p) group[p] = sets.find(p);
    return group;
  }

  // Takes whole surfaces that are connected out of the list of triangles: those whose group is marked.
  void leave_out(const std::vector<uint32_t>& group, const std::vector<bool>& marked) {
    std::vector<uint32_t> kept;
    for (const uint32_t t : triangles_) {
      const bool out = marked[group[welded_[assembly_.triangles[t].x]]];
      (out ? left_out_ : kept).push_back(t);
    }
    triangles_ = std::move(kept);
  }

  void leave_out_cell(const HalfEdgeMesh& mesh, const Cells& cells, uint32_t cell) {
    const std::vector<uint32_t> group = connected(mesh);
    const auto face = static_cast<uint32_t>(std::find(cells.of_face.begin(), cells.of_face.end(), cell) -
                                            cells.of_face.begin());
    std::vector<bool> marked(group.size(), false);
    marked[group[mesh.from(3 * face)]] = true;
    leave_out(group, marked);
  }

  // Soup: surfaces of many triangles that fall apart into cells of one or two. False where there is none.
  bool leave_out_soup(const HalfEdgeMesh& mesh, const Cells& cells) {
    constexpr uint64_t many = 256;
    constexpr double triangles_a_cell = 2.5;
    const std::vector<uint32_t> group = connected(mesh);
    std::vector<uint64_t> triangles(group.size(), 0), pieces(group.size(), 0);
    for (const uint32_t t : triangles_) ++triangles[group[welded_[assembly_.triangles[t].x]]];
    std::vector<bool> counted(cells.count, false);
    for (uint32_t f = 0; f < cells.of_face.size(); ++f) {
      if (counted[cells.of_face[f]]) continue;
      counted[cells.of_face[f]] = true;
      ++pieces[group[mesh.from(3 * f)]];
    }
    std::vector<bool> marked(group.size(), false);
    for (size_t g = 0; g < group.size(); ++g)
      marked[g] = triangles[g] >= many && double(triangles[g]) < triangles_a_cell * double(pieces[g]);
    if (std::find(marked.begin(), marked.end(), true) == marked.end()) return false;
    leave_out(group, marked);
    return true;
  }

  const scene::Scene& scene_;
  const scene::Assembly& assembly_;
  const std::vector<uint32_t>& welded_;
  const ChartSettings& settings_;
  const OnStage& on_stage_;
  const std::vector<glm::vec3> positions_;
  std::optional<ShapeMetrics> metrics_;
  std::vector<ScreenView> views_;
  std::vector<uint32_t> triangles_, left_out_;
  std::vector<glm::uvec3> corners_;         // of the triangles
  std::optional<mesh::TriangleTree> tree_;  // and how far they are
  uint64_t budget_ = 0;
};

}  // namespace

MappedCharts map_charts(const scene::Scene& scene, const scene::Assembly& assembly,
                        const std::vector<uint32_t>& welded, std::vector<uint32_t> triangles,
                        const ChartSettings& settings, const OnStage& on_stage) {
  return ChartMaker(scene, assembly, welded, settings, on_stage).run(std::move(triangles));
}

}  // namespace lodestone::geometry_image
