// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_profile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace lodestone::geometry_image {

ChartProfile::ChartProfile(ChartPowers powers, std::vector<glm::dvec3> points,
                           const std::vector<FirmArc>& firm)
    : powers_(powers), points_(std::move(points)) {
  const uint32_t width = 1u << powers.width, height = 1u << powers.height;
  normals_.reserve(points_.size());
  for (uint32_t y = 0; y <= height; ++y) {
    for (uint32_t x = 0; x <= width; ++x) {
      normals_.push_back(normal_at(x, y));
      if (x > 0) width_ += glm::distance(at(x - 1, y), at(x, y)) / (height + 1);
      if (y > 0) height_ += glm::distance(at(x, y - 1), at(x, y)) / (width + 1);
    }
  }
  find_room(firm);
}

void ChartProfile::find_room(const std::vector<FirmArc>& firm) {
  const uint32_t width = 1u << powers_.width, height = 1u << powers_.height;
  std::vector<glm::dvec3> border;
  for (const FirmArc& arc : firm) {
    const uint32_t length = arc.side % 2 == 0 ? width : height;
    for (auto i = static_cast<uint32_t>(std::ceil(arc.from * length)); i <= length && i <= arc.to * length;
         ++i) {
      border.push_back(arc.side == 0   ? at(i, 0)
                       : arc.side == 1 ? at(width, i)
                       : arc.side == 2 ? at(width - i, height)
                                       : at(0, height - i));
    }
  }
  room_.assign(points_.size(), std::numeric_limits<double>::infinity());
  for (size_t i = 0; i < points_.size(); ++i)
    for (const glm::dvec3& b : border) room_[i] = std::min(room_[i], glm::distance(points_[i], b));
}

// Unit length, or zero where the surface has no area.
glm::dvec3 ChartProfile::normal_at(uint32_t x, uint32_t y) const {
  const uint32_t width = 1u << powers_.width, height = 1u << powers_.height;
  const glm::dvec3 across = at(std::min(x + 1, width), y) - at(x > 0 ? x - 1 : 0, y);
  const glm::dvec3 along = at(x, std::min(y + 1, height)) - at(x, y > 0 ? y - 1 : 0);
  const glm::dvec3 normal = glm::cross(across, along);
  const double length = glm::length(normal);
  return length > 0 ? normal / length : glm::dvec3(0);
}

double ChartProfile::error_of_quad(uint32_t x, uint32_t y, uint32_t step_x, uint32_t step_y) const {
  const uint32_t width = 1u << powers_.width;
  const glm::dvec3 &a = at(x, y), &b = at(x + step_x, y), &c = at(x, y + step_y),
                   &d = at(x + step_x, y + step_y);
  double most = 0;
  for (uint32_t j = 0; j <= step_y; ++j) {
    for (uint32_t i = 0; i <= step_x; ++i) {
      const double u = double(i) / step_x, v = double(j) / step_y;
      const glm::dvec3 flat =
          u + v <= 1 ? a + u * (b - a) + v * (c - a) : d + (1 - u) * (c - d) + (1 - v) * (b - d);
      const glm::dvec3 off = at(x + i, y + j) - flat;
      const size_t index = size_t(y + j) * (width + 1) + (x + i);
      const double across = glm::dot(off, normals_[index]);
      most = std::max({most, std::abs(across), glm::length(off - across * normals_[index]) - room_[index]});
    }
  }
  return most;
}

double ChartProfile::error(uint32_t width, uint32_t height) const {
  const auto power = [](uint32_t side) { return static_cast<uint32_t>(std::bit_width(side)) - 1; };
  return surface_error({power(width), power(height)});
}

double ChartProfile::surface_error(ChartPowers powers) const {
  const ChartPowers known = {std::min(powers.width, powers_.width), std::min(powers.height, powers_.height)};
  const uint32_t step_x = 1u << (powers_.width - known.width), step_y = 1u << (powers_.height - known.height);
  if (step_x == 1 && step_y == 1) {
    // Nothing is known of what lies between the samples, but that it is better than at half of them.
    ChartPowers half = powers_;
    (powers_.width >= powers_.height ? half.width : half.height) -= 1;
    if (powers_.width == 0 && powers_.height == 0) return 0;
    const uint32_t finer = powers.width + powers.height - half.width - half.height;
    return surface_error(half) / std::ldexp(1.0, static_cast<int>(finer));
  }
  double most = 0;
  for (uint32_t y = 0; y < (1u << powers_.height); y += step_y)
    for (uint32_t x = 0; x < (1u << powers_.width); x += step_x)
      most = std::max(most, error_of_quad(x, y, step_x, step_y));
  return most;
}

}  // namespace lodestone::geometry_image
