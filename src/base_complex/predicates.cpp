// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/predicates.h"

#include <array>
#include <cmath>

namespace lodestone::base_complex {
namespace {

int sign(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

// A sum of doubles kept exactly, as parts that do not overlap, the smallest first.
class ExactSum {
 public:
  void add(double x) {
    size_t kept = 0;
    for (size_t i = 0; i < count_; ++i) {
      // x + part = sum + error, exactly.
      const double sum = x + parts_[i];
      const double part_of_x = sum - parts_[i];
      const double error = (x - part_of_x) + (parts_[i] - (sum - part_of_x));
      if (error != 0) parts_[kept++] = error;
      x = sum;
    }
    parts_[kept++] = x;
    count_ = kept;
  }
  void add_product(double x, double y) {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  }
  int sign_of() const {
    for (size_t i = count_; i-- > 0;)
      if (parts_[i] != 0) return sign(parts_[i]);
    return 0;
  }

 private:
  std::array<double, 13> parts_{};
  size_t count_ = 0;
};

}  // namespace

int orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double det = left - right;
  // Shewchuk's bound on the error of the line above.
  constexpr double bound = (3.0 + 16.0 * 0x1p-53) * 0x1p-53;
  if (std::abs(det) > bound * (std::abs(left) + std::abs(right))) return sign(det);
  ExactSum exact;
  exact.add_product(a.x, b.y);
  exact.add_product(-a.x, c.y);
  exact.add_product(-c.x, b.y);
  exact.add_product(-a.y, b.x);
  exact.add_product(a.y, c.x);
  exact.add_product(c.y, b.x);
  return exact.sign_of();
}

}  // namespace lodestone::base_complex
