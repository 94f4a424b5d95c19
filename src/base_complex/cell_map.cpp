// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/cell_map.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "lodestone/base_complex/predicates.h"

namespace lodestone::base_complex {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

class Mapper {
 public:
  Mapper(const BaseComplex& complex, uint32_t cell, const Rectangle& rectangle,
         std::vector<TriangleShape> shapes)
      : complex_(complex), mesh_(complex.mesh), cell_(complex.cells[cell]) {
    map_.shapes = std::move(shapes);
    place_boundary(rectangle);
    number_faces();
  }

  CellMap run(const MapOptions& options) {
    const bool done = (embed(chord_weights()) && is_one_to_one()) ||
                      (embed(std::vector<double>(edges_.size(), 1.0)) && is_one_to_one());
    if (!done) throw NotMappable{};
    reweigh();
    relax(options);
    return std::move(map_);
  }

 private:
  void place_boundary(const Rectangle& rectangle) {
    const glm::dvec2 corners[5] = {
        {0, 0}, {rectangle.width, 0}, {rectangle.width, rectangle.height}, {0, rectangle.height}, {0, 0}};
    size_t side = 0;
    double along = 0;
    for (size_t p = 0; p < cell_.boundary.size(); ++p) {
      while (side < 3 && p == cell_.corners[side + 1]) {
        ++side;
        along = 0;
      }
      const double length = side % 2 == 0 ? rectangle.width : rectangle.height;
      const std::vector<double> fractions = passage_fractions(
          cell_.boundary[p], rectangle.places.empty() ? std::vector<double>() : rectangle.places[p]);
      const glm::dvec2 direction = (corners[side + 1] - corners[side]) / length;
      uint32_t h = cell_.boundary[p].first_half_edge;
      for (size_t i = 0; i + 1 < fractions.size(); ++i, h = next_on_boundary(complex_, h)) {
        local_.emplace(mesh_.from(h), static_cast<uint32_t>(map_.points.size()));
        map_.points.push_back(mesh_.from(h));
        map_.at.push_back(corners[side] + direction * (along + rectangle.segments[p] * fractions[i]));
      }
      along += rectangle.segments[p];
    }
    map_.boundary_points = static_cast<uint32_t>(map_.points.size());
  }

  // Of the points along a passage, which fraction of its segment lies before each. Points at one place of the
  // arc are spread a little: no two may meet in the rectangle.
  std::vector<double> passage_fractions(const Passage& passage, const std::vector<double>& places) const {
    const Arc& arc = complex_.arcs[passage.arc];
    const size_t count = arc.points.size();
    std::vector<double> along(count, 0);
    for (size_t i = 1; i < count; ++i)
      along[i] =
          along[i - 1] + glm::distance(mesh_.position(arc.points[i - 1]), mesh_.position(arc.points[i]));
    const double length = along.back();
    std::vector<double> fractions(count);
    for (size_t i = 0; i < count; ++i) {
      const double even = double(i) / double(count - 1);
      const double found = !(length > 0)    ? even
                           : places.empty() ? along[i] / length
                                            : place_fraction(places, along[i]);
      constexpr double spread = 1e-6;
      fractions[i] = (1 - spread) * found + spread * even;
    }
    if (passage.backwards) {
      std::reverse(fractions.begin(), fractions.end());
      for (double& f : fractions) f = 1 - f;
    }
    return fractions;
  }
  static double place_fraction(const std::vector<double>& places, double distance) {
    const auto behind = std::upper_bound(places.begin() + 1, places.end() - 1, distance);
    const auto i = static_cast<size_t>(behind - places.begin());
    const double step = places[i] - places[i - 1];
    const double t = step > 0 ? std::clamp((distance - places[i - 1]) / step, 0.0, 1.0) : 0.0;
    return (double(i - 1) + t) / double(places.size() - 1);
  }

  void number_faces() {
    for (const uint32_t face : cell_.faces) {
      std::array<uint32_t, 3> corners = mesh_.corners(face);
      for (uint32_t& point : corners) {
        const auto [place, is_new] = local_.emplace(point, static_cast<uint32_t>(map_.points.size()));
        if (is_new) map_.points.push_back(point);
        point = place->second;
      }
      map_.faces.push_back(corners);
    }
    map_.at.resize(map_.points.size(), glm::dvec2(0));
    const size_t points = map_.points.size();
    first_corner_.assign(points + 1, 0);
    for (const auto& face : map_.faces)
      for (const uint32_t p : face) ++first_corner_[p + 1];
    for (size_t p = 0; p < points; ++p) first_corner_[p + 1] += first_corner_[p];
    corners_.resize(3 * map_.faces.size());
    std::vector<uint32_t> next_place(first_corner_.begin(), first_corner_.end() - 1);
    for (uint32_t f = 0; f < map_.faces.size(); ++f)
      for (uint32_t k = 0; k < 3; ++k) corners_[next_place[map_.faces[f][k]]++] = 3 * f + k;
    for (uint32_t f = 0; f < map_.faces.size(); ++f) {
      for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t a = map_.faces[f][k], b = map_.faces[f][(k + 1) % 3];
        // Edges inside the cell have two faces, of which one sees them this way round.
        if (a < b) edges_.push_back({a, b});
      }
    }
  }

  struct Edge {
    uint32_t a, b;
  };

  std::vector<double> chord_weights() const {
    std::vector<double> weights(edges_.size());
    double mean = 0;
    for (size_t e = 0; e < edges_.size(); ++e) {
      weights[e] =
          glm::distance(mesh_.position(map_.points[edges_[e].a]), mesh_.position(map_.points[edges_[e].b]));
      mean += weights[e];
    }
    mean /= double(std::max<size_t>(edges_.size(), 1));
    // Bounds keep the system well conditioned whatever the triangles are.
    for (double& w : weights) w = mean > 0 ? 1 / std::clamp(w / mean, 1e-2, 1e2) : 1.0;
    return weights;
  }

  // Places each inner point at the weighted mean of its neighbours. False where the solver fails.
  bool embed(const std::vector<double>& weights) {
    const uint32_t fixed = map_.boundary_points;
    const auto inner = static_cast<Eigen::Index>(map_.points.size() - fixed);
    if (inner == 0) return true;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(inner, 2);
    std::vector<double> diagonal(static_cast<size_t>(inner), 0.0);
    const auto add = [&](uint32_t from, uint32_t to, double weight) {
      if (from < fixed) return;
      diagonal[from - fixed] += weight;
      if (to >= fixed) {
        entries.emplace_back(from - fixed, to - fixed, -weight);
      } else {
        right(from - fixed, 0) += weight * map_.at[to].x;
        right(from - fixed, 1) += weight * map_.at[to].y;
      }
    };
    for (size_t e = 0; e < edges_.size(); ++e) {
      add(edges_[e].a, edges_[e].b, weights[e]);
      add(edges_[e].b, edges_[e].a, weights[e]);
    }
    for (Eigen::Index i = 0; i < inner; ++i) entries.emplace_back(i, i, diagonal[static_cast<size_t>(i)]);
    Matrix matrix(inner, inner);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::SimplicialLDLT<Matrix> solver(matrix);
    if (solver.info() != Eigen::Success) return false;
    const Eigen::MatrixX2d solution = solver.solve(right);
    if (solver.info() != Eigen::Success || !solution.allFinite()) return false;
    for (Eigen::Index i = 0; i < inner; ++i)
      map_.at[fixed + static_cast<size_t>(i)] = {solution(i, 0), solution(i, 1)};
    return true;
  }

  bool is_one_to_one() const {
    return std::all_of(map_.faces.begin(), map_.faces.end(), [&](const std::array<uint32_t, 3>& f) {
      return orientation(map_.at[f[0]], map_.at[f[1]], map_.at[f[2]]) > 0;
    });
  }

  double energy() const {
    double sum = 0;
    for (size_t f = 0; f < map_.faces.size(); ++f)
      if (map_.shapes[f].area > 0) sum += map_.shapes[f].area * map_.squared_stretch_of(f);
    return sum;
  }

  // Weights divided by how stretched their surroundings are pull the map apart where it is too small; with
  // positive weights it stays one to one (Yoshizawa, Belyaev and Seidel, A fast and simple
  // stretch-minimizing mesh parameterization, 2004). Far from the minimum a few such steps do what would
  // take the relaxation many.
  void reweigh() {
    constexpr int steps = 4;
    std::vector<double> weights = chord_weights();
    double best = energy();
    for (int step = 0; step < steps; ++step) {
      const std::vector<glm::dvec2> before = map_.at;
      std::vector<double> stretch(map_.points.size(), 0), area(map_.points.size(), 0);
      for (size_t f = 0; f < map_.faces.size(); ++f) {
        if (!(map_.shapes[f].area > 0)) continue;
        const double weighted = map_.shapes[f].area * map_.squared_stretch_of(f);
        for (const uint32_t p : map_.faces[f]) {
          stretch[p] += weighted;
          area[p] += map_.shapes[f].area;
        }
      }
      for (size_t p = 0; p < stretch.size(); ++p)
        stretch[p] = area[p] > 0 && stretch[p] > 0 ? std::sqrt(stretch[p] / area[p]) : 1.0;
      for (size_t e = 0; e < edges_.size(); ++e)
        weights[e] /= std::sqrt(stretch[edges_[e].a] * stretch[edges_[e].b]);
      const bool good = embed(weights) && is_one_to_one();
      const double found = good ? energy() : std::numeric_limits<double>::infinity();
      if (!(found < best)) {
        map_.at = before;
        return;
      }
      best = found;
    }
  }

  // Moves one point after another down the slope of the L2 stretch, never across an edge of its ring.
  void relax(const MapOptions& options) {
    double before = energy();
    for (uint32_t sweep = 0; sweep < options.sweeps; ++sweep) {
      for (auto p = map_.boundary_points; p < map_.points.size(); ++p) improve(p);
      const double after = energy();
      if (!(before - after > options.least_gain * before)) return;
      before = after;
    }
  }

  StretchEnergy energy_at(uint32_t point) const {
    StretchEnergy sum;
    for (uint32_t i = first_corner_[point]; i < first_corner_[point + 1]; ++i) {
      const uint32_t f = corners_[i] / 3, k = corners_[i] % 3;
      TriangleShape shape = map_.shapes[f];
      if (!(shape.area > 0)) continue;
      for (uint32_t turn = 0; turn < k; ++turn) shape = rotated(shape);
      add_energy(shape, map_.at[map_.faces[f][(k + 1) % 3]] - map_.at[point],
                 map_.at[map_.faces[f][(k + 2) % 3]] - map_.at[point], sum);
    }
    return sum;
  }
  // Infinite where a face round the point has turned over.
  double value_at(uint32_t point) const {
    double sum = 0;
    for (uint32_t i = first_corner_[point]; i < first_corner_[point + 1]; ++i) {
      const uint32_t f = corners_[i] / 3;
      const auto& [a, b, c] = map_.faces[f];
      if (orientation(map_.at[a], map_.at[b], map_.at[c]) <= 0)
        return std::numeric_limits<double>::infinity();
      if (map_.shapes[f].area > 0) sum += map_.shapes[f].area * map_.squared_stretch_of(f);
    }
    return sum;
  }

  void improve(uint32_t point) {
    constexpr int halvings = 8;
    constexpr double enough = 1e-4;  // of the decrease that the slope promises
    const StretchEnergy start = energy_at(point);
    if (!(start.value > 0)) return;
    const glm::dmat2& h = start.hessian;
    const double det = glm::determinant(h);
    glm::dvec2 step = -(glm::inverse(h) * start.gradient);
    if (!(det > 0) || !(h[0][0] > 0) || !(glm::dot(step, start.gradient) < 0)) {
      const double bend = std::abs(h[0][0]) + std::abs(h[1][1]) + 2 * std::abs(h[0][1]);
      step = -start.gradient / bend;
    }
    const double slope = glm::dot(step, start.gradient);
    if (!(slope < 0) || !std::isfinite(slope)) return;
    const glm::dvec2 from = map_.at[point];
    for (int i = 0; i < halvings; ++i, step *= 0.5) {
      map_.at[point] = from + step;
      if (value_at(point) <= start.value + enough * std::ldexp(slope, -i)) return;
    }
    map_.at[point] = from;
  }

  const BaseComplex& complex_;
  const HalfEdgeMesh& mesh_;
  const Cell& cell_;
  CellMap map_;
  std::unordered_map<uint32_t, uint32_t> local_;
  std::vector<uint32_t> first_corner_, corners_;  // of each point, the corners of faces there
  std::vector<Edge> edges_;                       // of which not both ends are on the boundary, mostly
};

}  // namespace

std::vector<TriangleShape> face_shapes(const BaseComplex& complex, uint32_t cell) {
  std::vector<TriangleShape> shapes;
  for (const uint32_t face : complex.cells[cell].faces) {
    const auto [a, b, c] = complex.mesh.corners(face);
    shapes.push_back(shape_of(complex.mesh.position(a), complex.mesh.position(b), complex.mesh.position(c)));
  }
  return shapes;
}

CellMap map_cell(const BaseComplex& complex, uint32_t cell, const Rectangle& rectangle,
                 std::vector<TriangleShape> shapes, const MapOptions& options) {
  return Mapper(complex, cell, rectangle, std::move(shapes)).run(options);
}

}  // namespace lodestone::base_complex
