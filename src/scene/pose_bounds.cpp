// SPDX-License-Identifier: MIT
// World bounds of what a pose draws, from vertices morphed and skinned on the CPU. Minima and maxima do not
// depend on the order in which they are taken, so that the result is the same for any number of threads.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/scene/pose.h"

namespace lodestone::scene {
namespace {

Bounds joined(Bounds a, const Bounds& b) {
  if (b.empty) return a;
  a.include(b.lo);
  a.include(b.hi);
  return a;
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
  return tbb::parallel_reduce(
      tbb::blocked_range<size_t>(0, mesh.triangles.size(), 4096), Bounds(),
      [&](const tbb::blocked_range<size_t>& range, Bounds bounds) {
        for (size_t t = range.begin(); t < range.end(); ++t) {
          for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = mesh.triangles[t][corner];
            bounds.include(to_world(mesh, matrices, vertex, positions[vertex]));
          }
        }
        return bounds;
      },
      joined);
}

}  // namespace

void Bounds::include(const glm::vec3& point) {
  lo = empty ? point : glm::min(lo, point);
  hi = empty ? point : glm::max(hi, point);
  empty = false;
}

Bounds pose_bounds(const Scene& scene, const Pose& pose) {
  std::vector<Bounds> of_node(scene.nodes.size());
  tbb::parallel_for(uint32_t(0), uint32_t(scene.nodes.size()), [&](uint32_t n) {
    if (scene.nodes[n].mesh != none) of_node[n] = node_bounds(scene, pose, n);
  });
  Bounds all;
  for (const Bounds& bounds : of_node) all = joined(all, bounds);
  const glm::vec3 extent = all.hi - all.lo;
  if (!std::isfinite(extent.x) || !std::isfinite(extent.y) || !std::isfinite(extent.z)) {
    fail_input(scene.name, "its vertices leave the range of floats; scale the scene down");
  }
  return all;
}

Bounds animation_bounds(const Scene& scene, uint32_t animation, uint32_t samples) {
  if (animation == none) return pose_bounds(scene, evaluate(scene, none, 0));
  const float duration = scene.animations.at(animation).duration();
  Bounds all;
  for (uint32_t i = 0; i < std::max(samples, 1u); ++i) {
    const float time = samples > 1 ? duration * float(i) / float(samples - 1) : 0;
    all = joined(all, pose_bounds(scene, evaluate(scene, animation, time)));
  }
  return all;
}

}  // namespace lodestone::scene
