// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/arc_places.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "lodestone/base_complex/arc_curve.h"
#include "lodestone/mesh/point_triangle.h"

namespace lodestone::base_complex {
namespace {

// And how far the polyline through some of its places is from it.
class Curve : public ArcCurve {
 public:
  Curve(const BaseComplex& complex, const Arc& arc)
      : ArcCurve(complex.mesh, arc),
        normals_(complex.normals),
        points_(arc.points),
        room_(arc.room),
        firm_(arc.firm) {}

  // The point between two places that is farthest from the chord between them, and how far it is. Where the
  // arc is not firm what is across the surface counts, and what is along it only where that leads over a firm
  // arc: else the chord may lie as it will.
  struct Farthest {
    double distance = 0;
    size_t point = 0;
  };
  Farthest farthest(double from, double to) const {
    const glm::dvec3 a = at(from), chord = at(to) - a;
    Farthest found;
    const auto [first, last] = between(from, to);
    for (size_t p = first; p < last; ++p) {
      const glm::dvec3 from_a = position(p) - a;
      const glm::dvec3 off = mesh::offset_from_segment(from_a, chord);
      const double distance = firm_ ? glm::length(off) : off_the_surface(off, p);
      if (distance > found.distance) found = {distance, p};
    }
    return found;
  }

 private:
  double off_the_surface(const glm::dvec3& off, size_t point) const {
    const glm::dvec3& normal = normals_[points_[point]];
    const double across = glm::dot(off, normal);
    return std::max(std::abs(across), glm::length(off - across * normal) - room_[point]);
  }

  const std::vector<glm::dvec3>& normals_;
  const std::vector<uint32_t>& points_;
  const std::vector<double>& room_;
  bool firm_;
};

// Where the arc bends most, until no point is far from the polyline or `most` places are taken; the ends are
// among them.
std::vector<double> bends(const Curve& curve, uint32_t most, double near_enough) {
  struct Piece {
    Curve::Farthest farthest;
    double from, to;
    bool operator<(const Piece& other) const {
      return farthest.distance != other.farthest.distance ? farthest.distance < other.farthest.distance
                                                          : from > other.from;
    }
  };
  std::vector<double> places = {0, curve.length()};
  std::priority_queue<Piece> pieces;
  pieces.push({curve.farthest(0, curve.length()), 0, curve.length()});
  while (places.size() < most && pieces.top().farthest.distance > near_enough) {
    const Piece piece = pieces.top();
    pieces.pop();
    const double middle = curve.along(piece.farthest.point);
    places.push_back(middle);
    pieces.push({curve.farthest(piece.from, middle), piece.from, middle});
    pieces.push({curve.farthest(middle, piece.to), middle, piece.to});
  }
  std::sort(places.begin(), places.end());
  return places;
}

std::vector<double> place_samples(const Curve& curve, bool firm, uint32_t segments) {
  const double near_enough = firm ? 0.02 : 0.15;  // of the even spacing
  const std::vector<double> fixed = bends(curve, segments + 1, near_enough * curve.length() / segments);
  // What is left over goes where gaps are longest.
  const size_t gaps = fixed.size() - 1;
  std::vector<uint32_t> parts(gaps, 1);
  for (size_t left = segments - gaps; left > 0; --left) {
    size_t longest = 0;
    for (size_t g = 1; g < gaps; ++g)
      if ((fixed[g + 1] - fixed[g]) / parts[g] > (fixed[longest + 1] - fixed[longest]) / parts[longest])
        longest = g;
    ++parts[longest];
  }
  std::vector<double> places;
  for (size_t g = 0; g < gaps; ++g)
    for (uint32_t i = 0; i < parts[g]; ++i)
      places.push_back(fixed[g] + (fixed[g + 1] - fixed[g]) * i / parts[g]);
  places.push_back(curve.length());
  return places;
}

}  // namespace

std::vector<double> arc_places(const BaseComplex& complex, uint32_t arc, uint32_t segments) {
  return place_samples(Curve(complex, complex.arcs[arc]), complex.arcs[arc].firm, segments);
}

double arc_error(const BaseComplex& complex, uint32_t arc, uint32_t segments) {
  const Curve curve(complex, complex.arcs[arc]);
  const std::vector<double> places = place_samples(curve, complex.arcs[arc].firm, segments);
  double most = 0;
  for (size_t i = 0; i + 1 < places.size(); ++i)
    most = std::max(most, curve.farthest(places[i], places[i + 1]).distance);
  return most;
}

}  // namespace lodestone::base_complex
