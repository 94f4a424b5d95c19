// SPDX-License-Identifier: MIT
#include "lodestone/app/bench_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::app {
namespace {

constexpr float far_away = std::numeric_limits<float>::max();
constexpr float start_share =
    1e-4f;  // of the scene's size: where an incoherent ray leaves the surface behind it

// SplitMix64 (Steele, Lea and Flood 2014): one step a number.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  double unit() {  // [0, 1)
    uint64_t bits = state_ += 0x9e3779b97f4a7c15u;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return double((bits ^ (bits >> 31)) >> 11) * 0x1p-53;
  }

 private:
  uint64_t state_;
};

// The summed areas of the triangles up to and with each.
std::vector<double> summed_areas(const std::vector<glm::uvec4>& triangles,
                                 const std::vector<glm::vec3>& positions) {
  std::vector<double> sums;
  sums.reserve(triangles.size());
  double sum = 0;
  for (const glm::uvec4& triangle : triangles) {
    const glm::dvec3 a = positions[triangle.x], b = positions[triangle.y], c = positions[triangle.z];
    sum += glm::length(glm::cross(b - a, c - a)) / 2;
    sums.push_back(sum);
  }
  return sums;
}

glm::vec3 sphere_direction(Random& random) {
  const double z = 1 - 2 * random.unit(), angle = 2 * 3.14159265358979323846 * random.unit();
  const double radius = std::sqrt(std::max(0.0, 1 - z * z));
  return {float(radius * std::cos(angle)), float(radius * std::sin(angle)), float(z)};
}

glm::vec3 point_on(const glm::uvec4& triangle, const std::vector<glm::vec3>& positions, Random& random) {
  const float root = float(std::sqrt(random.unit())), v = float(random.unit());
  return positions[triangle.x] * (1 - root) + positions[triangle.y] * (root * (1 - v)) +
         positions[triangle.z] * (root * v);
}

}  // namespace

Rays primary_rays(const render::View& view, const Size& size) {
  Rays rays;
  rays.reserve(2 * size_t(size.width) * size.height);
  for (uint32_t row = 0; row < size.height; ++row) {
    for (uint32_t column = 0; column < size.width; ++column) {
      const float x = 2 * (float(column) + 0.5f) / float(size.width) - 1;
      const float y = 1 - 2 * (float(row) + 0.5f) / float(size.height);
      const glm::vec3 across = view.right * x + view.up * y;
      const glm::vec3 origin = view.perspective ? view.origin : view.origin + across;
      const glm::vec3 direction = glm::normalize(view.perspective ? view.forward + across : view.forward);
      rays.emplace_back(origin, 0.0f);
      rays.emplace_back(direction, far_away);
    }
  }
  return rays;
}

Rays incoherent_rays(const PreparedScene& prepared, const scene::Pose& pose, uint32_t count, uint32_t seed) {
  const scene::Assembly& assembly = prepared.assembly;
  const std::vector<glm::vec3> positions =
      scene::blended_positions(assembly, scene::frame_weights(prepared.scene, assembly, pose),
                               scene::frame_matrices(prepared.scene, assembly, pose));
  const std::vector<double> areas = summed_areas(assembly.triangles, positions);
  if (!(areas.back() > 0)) fail_input(prepared.scene.name, "has no surface that rays could start from");
  scene::Bounds bounds;
  for (const glm::vec3& position : positions) bounds.include(position);
  const float start = start_share * glm::length(bounds.hi - bounds.lo);
  Random random(seed);
  Rays rays;
  rays.reserve(2 * size_t(count));
  for (uint32_t i = 0; i < count; ++i) {
    const auto chosen = std::upper_bound(areas.begin(), areas.end(), random.unit() * areas.back());
    const size_t triangle = std::min<size_t>(size_t(chosen - areas.begin()), areas.size() - 1);
    const glm::vec3 origin = point_on(assembly.triangles[triangle], positions, random);
    rays.emplace_back(origin, start);
    rays.emplace_back(sphere_direction(random), far_away);
  }
  return rays;
}

}  // namespace lodestone::app
