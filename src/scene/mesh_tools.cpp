// SPDX-License-Identifier: MIT
#include "lodestone/scene/mesh_tools.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>

namespace lodestone::scene {
namespace {

// For each vertex the lowest vertex at the same position.
std::vector<uint32_t> join_by_position(std::span<const glm::vec3> positions) {
  std::vector<uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const glm::vec3 &p = positions[a], &q = positions[b];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  });
  std::vector<uint32_t> joined(positions.size());
  for (size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
    joined[order[i]] = same ? joined[order[i - 1]] : order[i];
  }
  return joined;
}

// Double precision throughout: squares of coordinates as large as a float holds do not overflow, and
// triangles of very different sizes do not cancel.
glm::vec3 unit_or_zero(const glm::dvec3& v) {
  const double length = std::sqrt(glm::dot(v, v));
  return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0);
}

}  // namespace

float decode_srgb(float encoded) {
  const double value = std::clamp(double(encoded), 0.0, 1.0);
  return static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
}

glm::vec3 facet_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::dvec3 origin(a);
  return unit_or_zero(glm::cross(glm::dvec3(b) - origin, glm::dvec3(c) - origin));
}

std::vector<glm::vec3> smooth_normals(std::span<const glm::vec3> positions,
                                      std::span<const glm::uvec3> triangles) {
  const std::vector<uint32_t> joined = join_by_position(positions);
  std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
  for (const glm::uvec3& t : triangles) {
    const glm::dvec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
    const glm::dvec3 doubled_area = glm::cross(b - a, c - a);
    for (int corner = 0; corner < 3; ++corner) sums[joined[t[corner]]] += doubled_area;
  }
  std::vector<glm::vec3> normals(positions.size());
  for (size_t v = 0; v < normals.size(); ++v) {
    const glm::vec3 n = unit_or_zero(sums[joined[v]]);
    normals[v] = n == glm::vec3(0) ? glm::vec3(0, 0, 1) : n;
  }
  return normals;
}

void complete_normals(Mesh& mesh) {
  if (mesh.normals.empty()) {
    mesh.normals = smooth_normals(mesh.positions, mesh.triangles);
    return;
  }
  bool any_zero = false;
  for (glm::vec3& n : mesh.normals) {
    n = unit_or_zero(n);
    any_zero = any_zero || n == glm::vec3(0);
  }
  if (!any_zero) return;
  const std::vector<glm::vec3> smooth = smooth_normals(mesh.positions, mesh.triangles);
  for (size_t v = 0; v < mesh.normals.size(); ++v) {
    if (mesh.normals[v] == glm::vec3(0)) mesh.normals[v] = smooth[v];
  }
}

}  // namespace lodestone::scene
