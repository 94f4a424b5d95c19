// SPDX-License-Identifier: MIT
#include "lodestone/scene/pose_box.h"

#include <algorithm>
#include <limits>

#include "lodestone/layout/arithmetic.h"

namespace lodestone::scene {
namespace {

// Sums of floats over a vertex's deltas and influences are off by less than this part of their largest term.
constexpr float margin = 0x1p-13f;

Bounds transformed(const glm::mat4& m, const Bounds& box) {
  Bounds result;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point((corner & 1) != 0 ? box.hi.x : box.lo.x, (corner & 2) != 0 ? box.hi.y : box.lo.y,
                          (corner & 4) != 0 ? box.hi.z : box.lo.z);
    result.include(glm::vec3(m * glm::vec4(point, 1)));
  }
  return result;
}

}  // namespace

PoseBox::PoseBox(const Scene& scene) : reach_(scene) {
  for (const Mesh& mesh : scene.meshes) {
    MeshBox of_mesh;
    for (const glm::uvec3& t : mesh.triangles) {
      for (int corner = 0; corner < 3; ++corner) of_mesh.base.include(mesh.positions[t[corner]]);
    }
    for (const MorphTarget& target : mesh.targets) {
      Bounds deltas;
      deltas.include(glm::vec3(0));
      for (const glm::vec3& delta : target.positions) deltas.include(delta);
      of_mesh.targets.push_back(deltas);
    }
    if (!mesh.first_influence.empty()) {
      of_mesh.least = std::numeric_limits<float>::max();
      of_mesh.most = 0;
    }
    for (size_t v = 0; v + 1 < mesh.first_influence.size(); ++v) {
      float sum = 0;
      for (uint32_t i = mesh.first_influence[v]; i < mesh.first_influence[v + 1]; ++i) {
        sum += mesh.influences[i].weight;
        if (mesh.influences[i].weight < 0) of_mesh.mixes = false;
      }
      of_mesh.least = std::min(of_mesh.least, sum);
      of_mesh.most = std::max(of_mesh.most, sum);
    }
    meshes_.push_back(std::move(of_mesh));
  }
}

Bounds PoseBox::of_node(const Scene& scene, const Pose& pose, uint32_t node) const {
  const MeshBox& mesh = meshes_[scene.nodes[node].mesh];
  Bounds box;
  if (mesh.base.empty) return box;
  const glm::vec3 reach(reach_.of_node(scene, pose, node));
  if (mesh.mixes) {
    Bounds morphed = mesh.base;
    for (size_t i = 0; i < mesh.targets.size(); ++i) {
      const glm::vec3 a = mesh.targets[i].lo * pose.weights[node][i],
                      b = mesh.targets[i].hi * pose.weights[node][i];
      morphed.lo += glm::min(a, b);
      morphed.hi += glm::max(a, b);
    }
    // A skinned vertex is a mean of what the joints make of it, times the sum of its weights.
    for (const glm::mat4& matrix : palette(scene, pose, node)) {
      const Bounds moved = transformed(matrix, morphed);
      for (const float sum : {mesh.least, mesh.most}) {
        box.include(moved.lo * sum);
        box.include(moved.hi * sum);
      }
    }
  } else {
    box.include(-reach);
    box.include(reach);
  }
  box.lo -= reach * margin;
  box.hi += reach * margin;
  return box;
}

Bounds PoseBox::of_mesh(uint32_t mesh) const {
  Bounds box = meshes_[mesh].base;
  const glm::vec3 reach(margin * glm::max(layout::largest_abs(box.lo), layout::largest_abs(box.hi)));
  box.lo -= reach;
  box.hi += reach;
  return box;
}

Bounds PoseBox::of(const Scene& scene, const Pose& pose) const {
  Bounds all;
  for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
    if (scene.nodes[node].mesh != none) all.include(of_node(scene, pose, node));
  }
  return all;
}

}  // namespace lodestone::scene
