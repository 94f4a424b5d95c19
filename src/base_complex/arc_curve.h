// SPDX-License-Identifier: MIT
// An arc as a curve by distance from its first point.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "lodestone/base_complex/base_complex.h"

namespace lodestone::base_complex {

class ArcCurve {
 public:
  // Both must outlive it.
  ArcCurve(const HalfEdgeMesh& mesh, const Arc& arc) : mesh_(mesh), points_(arc.points) {
    along_.push_back(0);
    for (size_t i = 1; i < points_.size(); ++i)
      along_.push_back(along_.back() + glm::distance(position(i - 1), position(i)));
  }

  double length() const { return along_.back(); }
  size_t points() const { return points_.size(); }
  const glm::dvec3& position(size_t point) const { return mesh_.position(points_[point]); }
  double along(size_t point) const { return along_[point]; }
  // The points with distances above `low` and below `high`.
  std::pair<size_t, size_t> between(double low, double high) const {
    const auto first = std::upper_bound(along_.begin(), along_.end(), low);
    const auto last = std::lower_bound(first, along_.end(), high);
    return {size_t(first - along_.begin()), size_t(last - along_.begin())};
  }

  glm::dvec3 at(double distance) const {
    const auto behind = std::upper_bound(along_.begin(), along_.end(), distance);
    const size_t i = std::clamp<size_t>(size_t(behind - along_.begin()), 1, along_.size() - 1);
    const double step = along_[i] - along_[i - 1];
    const double t = step > 0 ? (distance - along_[i - 1]) / step : 0.0;
    return position(i - 1) * (1 - t) + position(i) * t;
  }

 private:
  const HalfEdgeMesh& mesh_;
  const std::vector<uint32_t>& points_;
  std::vector<double> along_;
};

}  // namespace lodestone::base_complex
