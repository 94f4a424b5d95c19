// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/unfold.h"

#include <algorithm>
#include <array>
#include <utility>

#include "lodestone/layout/relax.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::BaseComplex;
using base_complex::CellMap;

// How bad a triangle is: 0 if it is of good shape and faces as the surface at its corners does, growing with
// its size if not, and most where it is folded.
double badness_of(const Facet& a, const Facet& b, const Facet& c) {
  const glm::dvec3 ab = b.position - a.position, ac = c.position - a.position, bc = c.position - b.position;
  const double squares = glm::dot(ab, ab) + glm::dot(ac, ac) + glm::dot(bc, bc);
  const glm::dvec3 normal = a.normal + b.normal + c.normal;
  const double length = glm::length(normal);
  if (!(squares > 0) || !(length > 0)) return 0;
  constexpr double of_equilateral = 3.4641016151377544;  // 2 sqrt(3): makes its quality 1
  constexpr double good = 0.3;
  const double quality = of_equilateral * glm::dot(glm::cross(ab, ac), normal) / (length * squares);
  const double lack = std::max(good - quality, 0.0);
  return lack * lack * squares;
}

// Whether the angle between a triangle and the surface is large. What has no area has no side.
bool is_folded(const Facet& a, const Facet& b, const Facet& c) {
  constexpr double too_steep = 0.5;  // cosine
  const glm::dvec3 cross = glm::cross(b.position - a.position, c.position - a.position);
  const glm::dvec3 normal = a.normal + b.normal + c.normal;
  return glm::dot(cross, normal) < too_steep * glm::length(cross) * glm::length(normal);
}

// Corners of the small triangles of a quad.
std::array<std::array<uint32_t, 3>, 2> triangles_of(uint32_t columns, uint32_t x, uint32_t y) {
  const uint32_t a = y * columns + x, b = a + 1, c = a + columns, d = c + 1;
  return {{{a, b, c}, {d, c, b}}};
}

// The inner samples at corners of folded triangles, and those around them, ascending.
std::vector<uint32_t> at_folds(uint32_t columns, const std::vector<Facet>& samples) {
  const auto rows = static_cast<uint32_t>(samples.size() / columns);
  std::vector<uint8_t> marked(samples.size(), 0);
  for (uint32_t y = 0; y + 1 < rows; ++y) {
    for (uint32_t x = 0; x + 1 < columns; ++x) {
      for (const std::array<uint32_t, 3>& t : triangles_of(columns, x, y))
        if (is_folded(samples[t[0]], samples[t[1]], samples[t[2]]))
          for (const uint32_t corner : t) marked[corner] = 1;
    }
  }
  std::vector<uint32_t> list;
  for (uint32_t y = 1; y + 1 < rows; ++y) {
    for (uint32_t x = 1; x + 1 < columns; ++x) {
      bool near = false;
      for (uint32_t j = y - 1; j <= y + 1; ++j)
        for (uint32_t i = x - 1; i <= x + 1; ++i) near = near || marked[j * columns + i] != 0;
      if (near) list.push_back(y * columns + x);
    }
  }
  return list;
}

class Unfolder {
 public:
  Unfolder(const BaseComplex& complex, uint32_t cell, const CellMap& map, uint32_t columns,
           std::vector<Facet>& samples, std::vector<FacePoint>& points)
      : complex_(complex),
        cell_(cell),
        map_(map),
        walk_(map),
        columns_(columns),
        samples_(samples),
        points_(points) {
    for (uint32_t i = 0; i < points.size(); ++i) places_.emplace_back(i % columns, i / columns);
  }

  void run() {
    constexpr int most_sweeps = 12;
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      bool moved = false;
      for (const uint32_t sample : at_folds(columns_, samples_)) moved = move(sample) || moved;
      if (!moved) break;
    }
  }

 private:
  // Calls visit(corner, corner, corner) for the triangles at an inner sample.
  template <class Visit>
  void for_triangles_at(uint32_t sample, Visit visit) const {
    const uint32_t x = sample % columns_, y = sample / columns_;
    for (uint32_t j = y - 1; j <= y; ++j) {
      for (uint32_t i = x - 1; i <= x; ++i) {
        for (const auto& [a, b, c] : triangles_of(columns_, i, j))
          if (a == sample || b == sample || c == sample) visit(a, b, c);
      }
    }
  }

  double badness(uint32_t sample) const {
    double sum = 0;
    for_triangles_at(sample, [&](uint32_t a, uint32_t b, uint32_t c) {
      sum += badness_of(samples_[a], samples_[b], samples_[c]);
    });
    return sum;
  }

  // Whether the triangles at a sample are all the right way round in the rectangle, and of some area: so no
  // two samples are ever at one place. Twice the area is 1 to begin with; relax.h has the same bound.
  bool keeps_lattice(uint32_t sample) const {
    double least = 1;
    for_triangles_at(sample, [&](uint32_t a, uint32_t b, uint32_t c) {
      least = std::min(least, base_complex::cross(places_[b] - places_[a], places_[c] - places_[a]));
    });
    return least >= double(layout::relax_least_area);
  }

  // To the best of some places around, if one is better.
  bool move(uint32_t sample) {
    constexpr double better = 0.99;
    const uint32_t face = points_[sample].face;
    const glm::dvec2 from = places_[sample];
    glm::dvec2 best = from;
    double least = better * badness(sample);
    for (const double step : {0.5, 0.25, 0.125, 0.0625}) {
      for (int direction = 0; direction < 9; ++direction) {
        places_[sample] = from + step * glm::dvec2(direction % 3 - 1, direction / 3 - 1);
        if (!keeps_lattice(sample)) continue;
        const FacePoint point = walk_.find(places_[sample], face);
        if (point.face == base_complex::none) continue;
        const Facet before = std::exchange(samples_[sample], facet_at(complex_, cell_, map_, point));
        const double after = badness(sample);
        if (after < least) {
          least = after;
          best = places_[sample];
          points_[sample] = point;
        } else {
          samples_[sample] = before;
        }
      }
    }
    places_[sample] = best;
    return best != from;
  }

  const BaseComplex& complex_;
  const uint32_t cell_;
  const CellMap& map_;
  const FaceWalk walk_;
  const uint32_t columns_;
  std::vector<glm::dvec2> places_;  // of the samples, in the rectangle
  std::vector<Facet>& samples_;
  std::vector<FacePoint>& points_;
};

}  // namespace

Facet facet_at(const BaseComplex& complex, uint32_t cell, const CellMap& map, const FacePoint& point) {
  const auto& [a, b, c] = map.faces[point.face];
  const glm::dvec3& w = point.barycentrics;
  const glm::dvec3 sum = complex.mesh.position(map.points[a]) * w.x +
                         complex.mesh.position(map.points[b]) * w.y +
                         complex.mesh.position(map.points[c]) * w.z;
  return {sum / (w.x + w.y + w.z), complex.mesh.normal(complex.cells[cell].faces[point.face])};
}

bool has_folds(uint32_t columns, const std::vector<Facet>& samples) {
  return !at_folds(columns, samples).empty();
}

void unfold(const BaseComplex& complex, uint32_t cell, const CellMap& map, uint32_t columns,
            std::vector<Facet>& samples, std::vector<FacePoint>& points) {
  Unfolder(complex, cell, map, columns, samples, points).run();
}

}  // namespace lodestone::geometry_image
