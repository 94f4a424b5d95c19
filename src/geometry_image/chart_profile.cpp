// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_profile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace lodestone::geometry_image {
namespace {

class Lattice {
 public:
  Lattice(ChartPowers powers, const std::vector<glm::dvec3>& points, const std::vector<FirmArc>& firm)
      : powers_(powers), width_(1u << powers.width), height_(1u << powers.height), points_(points) {
    normals_.reserve(points_.size());
    for (uint32_t y = 0; y <= height_; ++y)
      for (uint32_t x = 0; x <= width_; ++x) normals_.push_back(normal_at(x, y));
    find_room(firm);
  }

  double mean_row() const {
    double sum = 0;
    for (uint32_t y = 0; y <= height_; ++y)
      for (uint32_t x = 0; x < width_; ++x) sum += glm::distance(at(x, y), at(x + 1, y));
    return sum / (height_ + 1);
  }
  double mean_column() const {
    double sum = 0;
    for (uint32_t y = 0; y < height_; ++y)
      for (uint32_t x = 0; x <= width_; ++x) sum += glm::distance(at(x, y), at(x, y + 1));
    return sum / (width_ + 1);
  }

  // Of the lattice of these powers, none larger than its own.
  double error(ChartPowers powers) const {
    const uint32_t step_x = 1u << (powers_.width - powers.width),
                   step_y = 1u << (powers_.height - powers.height);
    double most = 0;
    for (uint32_t y = 0; y < height_; y += step_y)
      for (uint32_t x = 0; x < width_; x += step_x)
        most = std::max(most, error_of_quad(x, y, step_x, step_y));
    return most;
  }

 private:
  const glm::dvec3& at(uint32_t x, uint32_t y) const { return points_[size_t(y) * (width_ + 1) + x]; }

  // Unit length, or zero where the surface has no area.
  glm::dvec3 normal_at(uint32_t x, uint32_t y) const {
    const glm::dvec3 across = at(std::min(x + 1, width_), y) - at(x > 0 ? x - 1 : 0, y);
    const glm::dvec3 along = at(x, std::min(y + 1, height_)) - at(x, y > 0 ? y - 1 : 0);
    const glm::dvec3 normal = glm::cross(across, along);
    const double length = glm::length(normal);
    return length > 0 ? normal / length : glm::dvec3(0);
  }

  void find_room(const std::vector<FirmArc>& firm) {
    std::vector<glm::dvec3> border;
    for (const FirmArc& arc : firm) {
      const uint32_t length = arc.side % 2 == 0 ? width_ : height_;
      for (auto i = static_cast<uint32_t>(std::ceil(arc.from * length)); i <= length && i <= arc.to * length;
           ++i) {
        border.push_back(arc.side == 0   ? at(i, 0)
                         : arc.side == 1 ? at(width_, i)
                         : arc.side == 2 ? at(width_ - i, height_)
                                         : at(0, height_ - i));
      }
    }
    room_.assign(points_.size(), std::numeric_limits<double>::infinity());
    for (size_t i = 0; i < points_.size(); ++i)
      for (const glm::dvec3& b : border) room_[i] = std::min(room_[i], glm::distance(points_[i], b));
  }

  double error_of_quad(uint32_t x, uint32_t y, uint32_t step_x, uint32_t step_y) const {
    const glm::dvec3 &a = at(x, y), &b = at(x + step_x, y), &c = at(x, y + step_y),
                     &d = at(x + step_x, y + step_y);
    constexpr uint32_t enough = 4;  // samples along each side
    const uint32_t skip_x = std::max(step_x / enough, 1u), skip_y = std::max(step_y / enough, 1u);
    double most = 0;
    for (uint32_t j = 0; j <= step_y; j += skip_y) {
      for (uint32_t i = 0; i <= step_x; i += skip_x) {
        const double u = double(i) / step_x, v = double(j) / step_y;
        const glm::dvec3 flat =
            u + v <= 1 ? a + u * (b - a) + v * (c - a) : d + (1 - u) * (c - d) + (1 - v) * (b - d);
        const glm::dvec3 off = at(x + i, y + j) - flat;
        const size_t index = size_t(y + j) * (width_ + 1) + (x + i);
        const double across = glm::dot(off, normals_[index]);
        most = std::max({most, std::abs(across), glm::length(off - across * normals_[index]) - room_[index]});
      }
    }
    return most;
  }

  ChartPowers powers_;
  uint32_t width_, height_;
  const std::vector<glm::dvec3>& points_;
  std::vector<glm::dvec3> normals_;
  std::vector<double> room_;  // of each sample, how far it is from the nearest firm arc
};

}  // namespace

ChartProfile::ChartProfile(ChartPowers powers, const std::vector<glm::dvec3>& points,
                           const std::vector<FirmArc>& firm)
    : powers_(powers) {
  const Lattice lattice(powers, points, firm);
  width_ = lattice.mean_row();
  height_ = lattice.mean_column();
  for (uint32_t w = 0; w <= powers.width; ++w)
    for (uint32_t h = 0; h <= powers.height; ++h) errors_.push_back(lattice.error({w, h}));
}

double ChartProfile::error(uint32_t width, uint32_t height) const {
  const auto power = [](uint32_t side) { return static_cast<uint32_t>(std::bit_width(side)) - 1; };
  const ChartPowers low = {power(width), power(height)};
  const double u = std::log2(double(width)) - low.width, v = std::log2(double(height)) - low.height;
  const auto across = [&](uint32_t h) {
    return u > 0 ? (1 - u) * error_of({low.width, h}) + u * error_of({low.width + 1, h})
                 : error_of({low.width, h});
  };
  return v > 0 ? (1 - v) * across(low.height) + v * across(low.height + 1) : across(low.height);
}

double ChartProfile::error_of(ChartPowers powers) const {
  const ChartPowers known = {std::min(powers.width, powers_.width), std::min(powers.height, powers_.height)};
  if (known.width < powers_.width || known.height < powers_.height)
    return errors_[size_t(known.width) * (powers_.height + 1) + known.height];
  if (powers_.width == 0 && powers_.height == 0) return 0;
  // Nothing is known of what lies between the samples, but that it is better than at half of them.
  ChartPowers half = powers_;
  (powers_.width >= powers_.height ? half.width : half.height) -= 1;
  const uint32_t finer = powers.width + powers.height - half.width - half.height;
  return error_of(half) / std::ldexp(1.0, static_cast<int>(finer));
}

}  // namespace lodestone::geometry_image
