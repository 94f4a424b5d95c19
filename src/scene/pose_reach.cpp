// SPDX-License-Identifier: MIT
#include "lodestone/scene/pose_reach.h"

#include <algorithm>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/layout/arithmetic.h"

namespace lodestone::scene {
namespace {

// Vertices that no triangle has are not drawn.
float reach(const Mesh& mesh) {
  float largest = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner)
      largest = std::max(largest, layout::largest_abs(mesh.positions[t[corner]]));
  }
  return largest;
}

float reach(const MorphTarget& target) {
  float largest = 0;
  for (const glm::vec3& delta : target.positions) largest = std::max(largest, layout::largest_abs(delta));
  return largest;
}

float largest_influence(const Mesh& mesh) {
  float largest = mesh.first_influence.empty() ? 1.0f : 0.0f;
  for (size_t v = 0; v + 1 < mesh.first_influence.size(); ++v) {
    float sum = 0;
    for (uint32_t i = mesh.first_influence[v]; i < mesh.first_influence[v + 1]; ++i)
      sum += std::abs(mesh.influences[i].weight);
    largest = std::max(largest, sum);
  }
  return largest;
}

// Of a point whose coordinates are no larger than `of`, taken along by `m`.
float reach_through(const glm::mat4& m, float of) {
  float largest = 0;
  for (int row = 0; row < 3; ++row) {
    const float sum =
        (std::abs(m[0][row]) + std::abs(m[1][row]) + std::abs(m[2][row])) * of + std::abs(m[3][row]);
    if (!(sum <= largest)) largest = sum;  // also where it is NaN
  }
  return largest;
}

}  // namespace

PoseReach::PoseReach(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    MeshReach of_mesh{reach(mesh), {}, largest_influence(mesh)};
    for (const MorphTarget& target : mesh.targets) of_mesh.targets.push_back(reach(target));
    meshes_.push_back(std::move(of_mesh));
  }
}

float PoseReach::of_node(const Scene& scene, const Pose& pose, uint32_t node) const {
  const MeshReach& mesh = meshes_[scene.nodes[node].mesh];
  float morphed = mesh.base;
  for (size_t i = 0; i < mesh.targets.size(); ++i)
    morphed += std::abs(pose.weights[node][i]) * mesh.targets[i];
  float largest = 0;
  for (const glm::mat4& matrix : palette(scene, pose, node)) {
    const float far = reach_through(matrix, morphed) * mesh.influence;
    if (!(far <= largest)) largest = far;
  }
  return largest;
}

void PoseReach::check(const Scene& scene, const Pose& pose) const {
  float largest = 0;
  for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
    if (scene.nodes[node].mesh == none || scene.meshes[scene.nodes[node].mesh].triangles.empty()) continue;
    const float far = of_node(scene, pose, node);
    if (!(far <= largest_reach)) {
      fail_input(
          scene.name,
          "node {} ({}) takes vertices up to {:.3g} from the origin, where {:.3g} is the limit; scale the "
          "scene down, or its weights",
          node, scene.nodes[node].name, far, largest_reach);
    }
    largest = std::max(largest, far);
  }
  if (largest > 0 && largest < smallest_reach) {
    fail_input(
        scene.name,
        "all of its vertices are within {:.3g} of the origin, where {:.3g} is the limit; scale the scene up",
        largest, smallest_reach);
  }
}

}  // namespace lodestone::scene
