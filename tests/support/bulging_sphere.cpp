// SPDX-License-Identifier: MIT
#include "lodestone/test_support/bulging_sphere.h"

#include <cmath>
#include <map>
#include <tuple>

namespace lodestone::test {
namespace {

const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 1, 1));

glm::dvec3 bulged(const glm::dvec3& p) {
  constexpr double rim = 0.5, lift = 1.6, widen = 4;
  const double t = std::acos(std::min(glm::dot(p, axis), 1.0)) / rim;
  if (t >= 1) return p;
  const double share = (1 - t * t) * (1 - t * t);
  const glm::dvec3 across = p - axis * glm::dot(p, axis);
  return p + axis * (lift * share) + across * (widen * share);
}

std::vector<glm::vec3> normals_of(const std::vector<glm::vec3>& positions,
                                  const std::vector<glm::uvec3>& triangles) {
  std::vector<glm::vec3> normals(positions.size(), glm::vec3(0));
  for (const glm::uvec3& t : triangles) {
    const glm::vec3 across = glm::cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]);
    for (glm::length_t k = 0; k < 3; ++k) normals[t[k]] += across;
  }
  for (glm::vec3& normal : normals) normal = glm::normalize(normal);
  return normals;
}

// Six sides of a cube, whose points are one where they meet, blown up to a sphere.
scene::Mesh sphere(uint32_t quads) {
  scene::Mesh mesh;
  mesh.name = "bulging sphere";
  const auto n = static_cast<int>(quads);
  std::map<std::tuple<int, int, int>, uint32_t> found;
  const auto vertex = [&](const glm::ivec3& at) {
    const auto [place, is_new] =
        found.emplace(std::tuple(at.x, at.y, at.z), static_cast<uint32_t>(mesh.positions.size()));
    if (is_new) {
      // Even angles, so that the quads are of much the same size.
      const glm::dvec3 angles = glm::dvec3(at) * (0.25 * 3.14159265358979 / n);
      mesh.positions.emplace_back(
          glm::normalize(glm::dvec3(std::tan(angles.x), std::tan(angles.y), std::tan(angles.z))));
    }
    return place->second;
  };
  for (int side = 0; side < 6; ++side) {
    const int k = side % 3, sign = side < 3 ? 1 : -1;
    const auto place = [&](int u, int v) {
      glm::ivec3 at(0);
      at[k] = sign * n;
      at[(k + 1) % 3] = sign * (2 * u - n);
      at[(k + 2) % 3] = 2 * v - n;
      return vertex(at);
    };
    for (int v = 0; v < n; ++v) {
      for (int u = 0; u < n; ++u) {
        const uint32_t a = place(u, v), b = place(u + 1, v), c = place(u, v + 1), d = place(u + 1, v + 1);
        mesh.triangles.emplace_back(a, b, c);
        mesh.triangles.emplace_back(d, c, b);
      }
    }
  }
  mesh.parts = {{0, static_cast<uint32_t>(mesh.triangles.size()), scene::none}};
  mesh.normals = mesh.positions;
  return mesh;
}

}  // namespace

scene::Scene bulging_sphere(uint32_t quads) {
  scene::Mesh mesh = sphere(quads);
  std::vector<glm::vec3> after;
  for (const glm::vec3& p : mesh.positions) after.emplace_back(bulged(p));
  const std::vector<glm::vec3> normals = normals_of(after, mesh.triangles);
  scene::MorphTarget target;
  target.name = "bulge";
  for (uint32_t v = 0; v < after.size(); ++v) {
    if (after[v] == mesh.positions[v]) continue;
    target.vertices.push_back(v);
    target.positions.push_back(after[v] - mesh.positions[v]);
    target.normals.push_back(normals[v] - mesh.normals[v]);
  }
  mesh.targets = {target};
  mesh.weights = {0};
  scene::Scene scene;
  scene.name = "bulging sphere";
  scene.meshes = {mesh};
  scene.nodes.resize(2);
  scene.nodes[0].mesh = 0;
  scene.cameras.resize(1);
  scene.nodes[1].camera = 0;
  scene.nodes[1].translation = {1.2f, 0.6f, 6.5f};
  return scene;
}

}  // namespace lodestone::test
