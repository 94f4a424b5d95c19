// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/collinear.h"

#include <cmath>

namespace lodestone::geometry_image {
namespace {

// p - q into `difference`; false where double precision rounds it (Knuth's two-sum gives the error).
bool exact_difference(float p, float q, double& difference) {
  const double a = p, b = -double(q);
  const double sum = a + b;
  const double b_part = sum - a;
  const double error = (a - (sum - b_part)) + (b - b_part);
  difference = sum;
  return error == 0;
}

bool exact_difference(const glm::vec3& p, const glm::vec3& q, glm::dvec3& difference) {
  return exact_difference(p.x, q.x, difference.x) && exact_difference(p.y, q.y, difference.y) &&
         exact_difference(p.z, q.z, difference.z);
}

// a * b == c * d, of the exact products: the rounded ones and what rounding took from them agree.
bool equal_products(double a, double b, double c, double d) {
  const double ab = a * b, cd = c * d;
  return ab == cd && std::fma(a, b, -ab) == std::fma(c, d, -cd);
}

}  // namespace

bool exactly_collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  glm::dvec3 u, v;
  if (!exact_difference(b, a, u) || !exact_difference(c, a, v)) return false;
  return equal_products(u.y, v.z, u.z, v.y) && equal_products(u.z, v.x, u.x, v.z) &&
         equal_products(u.x, v.y, u.y, v.x);
}

}  // namespace lodestone::geometry_image
