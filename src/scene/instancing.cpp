// SPDX-License-Identifier: MIT
#include "lodestone/scene/instancing.h"

#include <algorithm>
#include <cmath>

#include "lodestone/layout/arithmetic.h"
#include "lodestone/scene/pose.h"
#include "lodestone/scene/pose_reach.h"

namespace lodestone::scene {
namespace {

bool deforms(const Scene& scene, const Node& node) {
  const Mesh& mesh = scene.meshes[node.mesh];
  return !mesh.targets.empty() || (node.skin != none && !mesh.first_influence.empty());
}

// Whether a ray can be taken to the node's own space in the rest pose. One that is flat there can still be
// drawn, but in the world.
bool has_inverse(const glm::mat4& matrix) {
  const glm::mat3 linear(matrix);
  const float volume = std::abs(glm::determinant(linear));
  const float edges = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  return std::isfinite(edges) && volume > edges * 1e-3f;
}

// Whether rays can be traced in the mesh's own space, whatever its nodes make of it.
bool is_traceable(const Mesh& mesh) {
  float reach = 0;
  for (const glm::vec3& p : mesh.positions) reach = std::max(reach, layout::largest_abs(p));
  return reach >= smallest_reach && reach <= largest_reach;
}

// Nodes that an animation moves, by themselves or with an ancestor.
std::vector<bool> moved_nodes(const Scene& scene) {
  std::vector<bool> moved(scene.nodes.size(), false);
  for (const Animation& animation : scene.animations) {
    for (const Channel& channel : animation.channels)
      if (channel.node != none && channel.path != Channel::Path::weights) moved[channel.node] = true;
  }
  for (size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.nodes[i].parent != none && moved[scene.nodes[i].parent]) moved[i] = true;
  return moved;
}

struct MeshUse {
  std::vector<uint32_t> rigid;  // nodes
  bool moved = false;           // any of them
};

Division divide_rigid(const Scene& scene) {
  const std::vector<bool> moved = moved_nodes(scene);
  const Pose rest = evaluate(scene, none, 0);
  std::vector<MeshUse> uses(scene.meshes.size());
  for (uint32_t n = 0; n < scene.nodes.size(); ++n) {
    const Node& node = scene.nodes[n];
    if (node.mesh == none || scene.meshes[node.mesh].triangles.empty() || deforms(scene, node) ||
        !has_inverse(rest.node_world[n]))
      continue;
    uses[node.mesh].rigid.push_back(n);
    if (moved[n]) uses[node.mesh].moved = true;
  }
  Division division;
  std::vector<uint32_t> object_of(scene.nodes.size(), none);
  for (const MeshUse& use : uses) {
    if (use.rigid.empty() || (use.rigid.size() < 2 && !use.moved)) continue;
    if (!is_traceable(scene.meshes[scene.nodes[use.rigid.front()].mesh])) continue;
    for (const uint32_t node : use.rigid) object_of[node] = static_cast<uint32_t>(division.objects.size());
    division.objects.push_back({{use.rigid.front()}, true});
  }
  ObjectNodes world;
  for (uint32_t n = 0; n < scene.nodes.size(); ++n) {
    if (object_of[n] != none) division.instances.push_back({object_of[n], n});
    if (object_of[n] == none && scene.nodes[n].mesh != none) world.nodes.push_back(n);
  }
  if (!world.nodes.empty()) {
    division.instances.push_back({static_cast<uint32_t>(division.objects.size()), none});
    division.objects.push_back(std::move(world));
  }
  return division;
}

Division divide_nothing(const Scene& scene) {
  Division division;
  ObjectNodes& world = division.objects.emplace_back();
  for (uint32_t n = 0; n < scene.nodes.size(); ++n)
    if (scene.nodes[n].mesh != none) world.nodes.push_back(n);
  division.instances.push_back({0, none});
  return division;
}

uint64_t triangles(const Scene& scene, const Division& division) {
  uint64_t sum = 0;
  for (const ObjectNodes& object : division.objects) {
    for (const uint32_t node : object.nodes) sum += scene.meshes[scene.nodes[node].mesh].triangles.size();
  }
  return sum;
}

}  // namespace

Division divide(const Scene& scene, Instancing instancing) {
  if (instancing == Instancing::off) return divide_nothing(scene);
  Division rigid = divide_rigid(scene);
  if (rigid.objects.empty()) return divide_nothing(scene);
  if (instancing == Instancing::on) return rigid;
  Division nothing = divide_nothing(scene);
  return 2 * triangles(scene, rigid) <= triangles(scene, nothing) ? rigid : nothing;
}

}  // namespace lodestone::scene
