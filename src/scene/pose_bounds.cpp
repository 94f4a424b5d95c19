// SPDX-License-Identifier: MIT
// World bounds of what a pose draws, from vertices morphed and skinned on the CPU. Blocks are joined in their
// order, so that the result is the same for any number of threads.
#include <algorithm>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/base/parallel.h"
#include "lodestone/scene/pose.h"

namespace lodestone::scene {
namespace {

Bounds joined(const std::vector<Bounds>& parts) {
  Bounds all;
  for (const Bounds& part : parts) all.include(part);
  return all;
}

std::vector<glm::vec3> morphed(const Mesh& mesh, const std::vector<float>& weights) {
  std::vector<glm::vec3> positions = mesh.positions;
  for (size_t i = 0; i < mesh.targets.size(); ++i) {
    if (weights[i] == 0) continue;
    const MorphTarget& target = mesh.targets[i];
    for (size_t k = 0; k < target.vertices.size(); ++k) {
      positions[target.vertices[k]] += weights[i] * target.positions[k];
    }
  }
  return positions;
}

glm::vec3 to_world(const Mesh& mesh, const std::vector<glm::mat4>& matrices, uint32_t vertex,
                   const glm::vec3& p) {
  const glm::vec4 point(p, 1);
  if (mesh.first_influence.empty()) return glm::vec3(matrices[0] * point);
  glm::vec4 sum(0);
  for (uint32_t i = mesh.first_influence[vertex]; i < mesh.first_influence[vertex + 1]; ++i) {
    sum += mesh.influences[i].weight * (matrices[mesh.influences[i].joint] * point);
  }
  return glm::vec3(sum);
}

Bounds node_bounds(const Scene& scene, const Pose& pose, uint32_t node) {
  const Mesh& mesh = scene.meshes[scene.nodes[node].mesh];
  const std::vector<glm::vec3> positions = morphed(mesh, pose.weights[node]);
  const std::vector<glm::mat4> matrices = palette(scene, pose, node);
  // Over the corners of triangles: a vertex that no triangle has is not drawn.
  constexpr uint64_t grain = 4096;
  std::vector<Bounds> of_block((mesh.triangles.size() + grain - 1) / grain);
  parallel_for(mesh.triangles.size(), grain, [&](uint64_t begin, uint64_t end) {
    Bounds bounds;
    for (uint64_t t = begin; t < end; ++t) {
      for (int corner = 0; corner < 3; ++corner) {
        const uint32_t vertex = mesh.triangles[t][corner];
        bounds.include(to_world(mesh, matrices, vertex, positions[vertex]));
      }
    }
    of_block[begin / grain] = bounds;
  });
  return joined(of_block);
}

}  // namespace

void Bounds::include(const glm::vec3& point) {
  lo = empty ? point : glm::min(lo, point);
  hi = empty ? point : glm::max(hi, point);
  empty = false;
}

void Bounds::include(const Bounds& other) {
  if (other.empty) return;
  include(other.lo);
  include(other.hi);
}

Bounds pose_bounds(const Scene& scene, const Pose& pose) {
  std::vector<Bounds> of_node(scene.nodes.size());
  parallel_for(scene.nodes.size(), 1, [&](uint64_t n, uint64_t) {
    if (scene.nodes[n].mesh != none) of_node[n] = node_bounds(scene, pose, uint32_t(n));
  });
  const Bounds all = joined(of_node);
  const glm::vec3 extent = all.hi - all.lo;
  if (!std::isfinite(extent.x) || !std::isfinite(extent.y) || !std::isfinite(extent.z)) {
    fail_input(scene.name, "its vertices leave the range of floats; scale the scene down");
  }
  return all;
}

}  // namespace lodestone::scene
