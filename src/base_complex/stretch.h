// SPDX-License-Identifier: MIT
// The L2 geometric stretch of a map from the plane onto a triangle (P. V. Sander, J. Snyder, S. J. Gortler,
// H. Hoppe, Texture Mapping Progressive Meshes, 2001, section 3): the root mean square, over all directions,
// of how much longer a unit vector of the plane becomes on the surface. It is 1 where the map is an isometry
// and infinite where the plane's triangle has no area.
#pragma once

#include <glm/glm.hpp>

namespace lodestone::base_complex {

// What the stretch of a triangle depends on besides where its corners lie in the plane: of the edges e1 from
// corner 0 to 1 and e2 from 0 to 2 on the surface the products, and the area.
struct TriangleShape {
  double e11 = 0, e12 = 0, e22 = 0, area = 0;
};
inline TriangleShape shape_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 e1 = b - a, e2 = c - a;
  return {glm::dot(e1, e1), glm::dot(e1, e2), glm::dot(e2, e2), 0.5 * glm::length(glm::cross(e1, e2))};
}
// The same triangle with its corners renamed: the second first.
inline TriangleShape rotated(const TriangleShape& s) {
  // e1' = e2 - e1, e2' = -e1
  return {s.e22 - 2 * s.e12 + s.e11, s.e11 - s.e12, s.e11, s.area};
}

inline double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

// The square of the L2 stretch; d1 and d2 are the edges in the plane.
inline double squared_stretch(const TriangleShape& s, const glm::dvec2& d1, const glm::dvec2& d2) {
  const double det = cross(d1, d2);
  return (s.e11 * glm::dot(d2, d2) - 2 * s.e12 * glm::dot(d1, d2) + s.e22 * glm::dot(d1, d1)) /
         (2 * det * det);
}

// The squared stretch times the area, with its first and second derivatives by the place of corner 0.
struct StretchEnergy {
  double value = 0;
  glm::dvec2 gradient{0};
  glm::dmat2 hessian{0};
};
inline void add_energy(const TriangleShape& s, const glm::dvec2& d1, const glm::dvec2& d2,
                       StretchEnergy& energy) {
  const double det = cross(d1, d2);
  const double numerator = s.e11 * glm::dot(d2, d2) - 2 * s.e12 * glm::dot(d1, d2) + s.e22 * glm::dot(d1, d1);
  const glm::dvec2 numerator_slope = 2.0 * (s.e12 * (d1 + d2) - s.e11 * d2 - s.e22 * d1);
  const double numerator_bend = 2 * (s.e11 - 2 * s.e12 + s.e22);
  const glm::dvec2 det_slope{d1.y - d2.y, d2.x - d1.x};
  const double scale = 0.5 * s.area / (det * det);
  energy.value += scale * numerator;
  energy.gradient += scale * (numerator_slope - 2 * numerator / det * det_slope);
  energy.hessian +=
      scale *
      (numerator_bend * glm::dmat2(1) -
       2 / det *
           (glm::outerProduct(numerator_slope, det_slope) + glm::outerProduct(det_slope, numerator_slope)) +
       6 * numerator / (det * det) * glm::outerProduct(det_slope, det_slope));
}

}  // namespace lodestone::base_complex
