// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/arc_smoothing.h"

#include <algorithm>
#include <limits>

#include "lodestone/base_complex/arc_curve.h"
#include "lodestone/mesh/point_triangle.h"

namespace lodestone::base_complex {
namespace {

// The mean of an arc around `middle`, weighted from 0 at `from` and `to` to most in the middle.
glm::dvec3 mean_around(const ArcCurve& arc, double from, double middle, double to) {
  constexpr int steps = 8;  // on either side
  glm::dvec3 sum = arc.at(middle) * double(steps);
  for (int i = 1; i < steps; ++i) {
    const double t = double(i) / steps;
    sum += (arc.at(middle + t * (from - middle)) + arc.at(middle + t * (to - middle))) * double(steps - i);
  }
  return sum / double(steps * steps);
}

}  // namespace

ArcSmoother::ArcSmoother(const BaseComplex& complex) : complex_(complex) {
  const HalfEdgeMesh& mesh = complex.mesh;
  std::vector<bool> listed(mesh.points(), false);
  for (const Arc& arc : complex.arcs)
    if (!arc.firm)
      for (const uint32_t point : arc.points) listed[point] = true;
  first_.assign(mesh.points() + 1, 0);
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h) first_[mesh.from(h) + 1] += listed[mesh.from(h)] ? 1 : 0;
  for (size_t p = 1; p < first_.size(); ++p) first_[p] += first_[p - 1];
  faces_.resize(first_.back());
  std::vector<uint32_t> next_place(first_.begin(), first_.end() - 1);
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h)
    if (listed[mesh.from(h)]) faces_[next_place[mesh.from(h)]++] = face_of(h);
}

PlaceOnFace ArcSmoother::nearest_face(const Arc& arc, size_t first, size_t end,
                                      const glm::dvec3& point) const {
  const HalfEdgeMesh& mesh = complex_.mesh;
  PlaceOnFace found;
  glm::dvec3 found_at(0);
  double least = std::numeric_limits<double>::infinity();
  for (size_t p = first; p < end; ++p) {
    for (uint32_t i = first_[arc.points[p]]; i < first_[arc.points[p] + 1]; ++i) {
      const auto [a, b, c] = mesh.corners(faces_[i]);
      const glm::dvec3 offset =
          mesh::offset_from_triangle(point, mesh.position(a), mesh.position(b), mesh.position(c));
      const double distance = glm::dot(offset, offset);
      if (distance >= least) continue;
      least = distance;
      found.face = faces_[i];
      found_at = point - offset;
    }
  }
  if (found.face == none) return found;
  const auto [a, b, c] = mesh.corners(found.face);
  const glm::dvec3 ab = mesh.position(b) - mesh.position(a), ac = mesh.position(c) - mesh.position(a),
                   at = found_at - mesh.position(a);
  const glm::dvec3 normal = glm::cross(ab, ac);
  const double square = glm::dot(normal, normal);
  if (!(square > 0)) return {};
  const double of_b = glm::dot(glm::cross(at, ac), normal) / square,
               of_c = glm::dot(glm::cross(ab, at), normal) / square;
  found.barycentrics = glm::max(glm::dvec3(1 - of_b - of_c, of_b, of_c), glm::dvec3(0));
  return found;
}

std::vector<PlaceOnFace> ArcSmoother::smooth(uint32_t index, const std::vector<double>& places) const {
  std::vector<PlaceOnFace> moved(places.size());
  const Arc& arc = complex_.arcs[index];
  if (arc.firm) return moved;
  const ArcCurve curve(complex_.mesh, arc);
  for (size_t i = 1; i + 1 < places.size(); ++i) {
    // The arc's points between the two places, and those next to them, but for the ends, around which there
    // may be other surfaces.
    const auto [from, to] = std::pair(places[i - 1], places[i + 1]);
    const auto [after, before] = curve.between(from, to);
    const size_t first = std::max<size_t>(1, after - 1), end = std::min(curve.points() - 1, before + 1);
    if (first >= end || !(from < to)) continue;
    const glm::dvec3 mean = mean_around(curve, from, places[i], to);
    double room = std::numeric_limits<double>::infinity(), far = 0;
    for (size_t p = first; p < end; ++p) {
      room = std::min(room, arc.room[p]);
      far = std::max(far, glm::distance(mean, curve.position(p)));
    }
    if (far < room) moved[i] = nearest_face(arc, first, end, mean);
  }
  return moved;
}

}  // namespace lodestone::base_complex
