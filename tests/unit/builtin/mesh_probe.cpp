// SPDX-License-Identifier: MIT
#include "mesh_probe.h"

#include <algorithm>
#include <limits>
#include <map>

namespace lodestone::test {
namespace {

std::vector<glm::vec3> with_deltas(std::vector<glm::vec3> base, const std::vector<uint32_t>& vertices,
                                   const std::vector<glm::vec3>& deltas) {
  for (size_t k = 0; k < vertices.size(); ++k) base[vertices[k]] += deltas[k];
  return base;
}

// Distance to a triangle along a ray, infinite on a miss.
float distance_to(glm::vec3 origin, glm::vec3 direction, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  constexpr float miss = std::numeric_limits<float>::infinity();
  const glm::vec3 u = b - a, v = c - a, p = glm::cross(direction, v);
  const float det = glm::dot(u, p);
  if (det == 0) return miss;
  const glm::vec3 s = origin - a, q = glm::cross(s, u);
  const float x = glm::dot(s, p) / det, y = glm::dot(direction, q) / det, t = glm::dot(v, q) / det;
  return x >= 0 && y >= 0 && x + y <= 1 && t > 0 ? t : miss;
}

}  // namespace

std::vector<glm::vec3> posed_positions(const scene::Mesh& mesh, const scene::MorphTarget& target) {
  return with_deltas(mesh.positions, target.vertices, target.positions);
}

std::vector<glm::vec3> posed_normals(const scene::Mesh& mesh, const scene::MorphTarget& target) {
  return with_deltas(mesh.normals, target.vertices, target.normals);
}

std::vector<uint32_t> joined_vertices(const scene::Mesh& mesh) {
  // Where a vertex is at rest and in every blendshape, as one key.
  std::vector<std::vector<float>> keys(mesh.positions.size());
  const auto append = [&](const std::vector<glm::vec3>& positions) {
    for (size_t v = 0; v < positions.size(); ++v)
      keys[v].insert(keys[v].end(), {positions[v].x, positions[v].y, positions[v].z});
  };
  append(mesh.positions);
  for (const scene::MorphTarget& target : mesh.targets) append(posed_positions(mesh, target));
  std::map<std::vector<float>, uint32_t> first;
  std::vector<uint32_t> joined;
  for (uint32_t v = 0; v < keys.size(); ++v) joined.push_back(first.emplace(keys[v], v).first->second);
  return joined;
}

size_t open_edges(const scene::Mesh& mesh) {
  const std::vector<uint32_t> joined = joined_vertices(mesh);
  std::map<std::pair<uint32_t, uint32_t>, int> edges;  // forward minus backward uses, by (low, high)
  std::map<std::pair<uint32_t, uint32_t>, int> uses;
  for (const glm::uvec3& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = joined[triangle[k]], b = joined[triangle[(k + 1) % 3]];
      const std::pair key(std::min(a, b), std::max(a, b));
      edges[key] += a < b ? 1 : -1;
      ++uses[key];
    }
  size_t open = 0;
  for (const auto& [edge, balance] : edges) open += balance != 0 || uses[edge] != 2;
  return open;
}

double volume(const scene::Mesh& mesh, const std::vector<glm::vec3>& positions) {
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles)
    sum += double(glm::dot(positions[t.x], glm::cross(positions[t.y], positions[t.z])));
  return sum / 6;
}

Hit first_hit(const scene::Scene& scene, const std::string& shape, glm::vec3 origin, glm::vec3 direction) {
  Hit hit{"", std::numeric_limits<float>::infinity()};
  for (const scene::Mesh& mesh : scene.meshes) {
    std::vector<glm::vec3> positions = mesh.positions;
    for (const scene::MorphTarget& target : mesh.targets)
      if (target.name == shape) positions = posed_positions(mesh, target);
    for (const glm::uvec3& t : mesh.triangles) {
      const float d = distance_to(origin, direction, positions[t.x], positions[t.y], positions[t.z]);
      if (d < hit.distance) hit = {mesh.name, d};
    }
  }
  return hit;
}

}  // namespace lodestone::test
