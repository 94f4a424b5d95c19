// SPDX-License-Identifier: MIT
#include "lodestone/scene/builtin/staging.h"

#include <utility>

#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

Node looking(const std::string& name, glm::vec3 eye, glm::vec3 target) {
  Node node;
  node.name = name;
  node.translation = snap(eye);
  const glm::quat q = glm::quatLookAt(glm::normalize(target - eye), glm::vec3(0, 1, 0));
  node.rotation = glm::quat(snap(q.w), snap(q.x), snap(q.y), snap(q.z));
  return node;
}

}  // namespace

uint32_t add_node(Scene& scene, Node node) {
  scene.nodes.push_back(std::move(node));
  return uint32_t(scene.nodes.size() - 1);
}

uint32_t add_mesh(Scene& scene, Mesh mesh, uint32_t parent, glm::vec3 translation, glm::vec3 scale) {
  Node node;
  node.name = mesh.name;
  node.parent = parent;
  node.translation = translation;
  node.scale = scale;
  node.mesh = uint32_t(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
  return add_node(scene, std::move(node));
}

uint32_t add_camera(Scene& scene, Camera camera, glm::vec3 eye, glm::vec3 target) {
  Node node = looking(camera.name, eye, target);
  node.camera = uint32_t(scene.cameras.size());
  scene.cameras.push_back(std::move(camera));
  return add_node(scene, std::move(node));
}

uint32_t add_light(Scene& scene, Light light, glm::vec3 eye, glm::vec3 target) {
  Node node = looking(light.name, eye, target);
  node.light = uint32_t(scene.lights.size());
  scene.lights.push_back(std::move(light));
  return add_node(scene, std::move(node));
}

uint32_t add_material(Scene& scene, const std::string& name, glm::vec3 color, float roughness,
                      float metallic) {
  Material material;
  material.name = name;
  material.base_color = glm::vec4(color, 1);
  material.roughness = roughness;
  material.metallic = metallic;
  scene.materials.push_back(std::move(material));
  return uint32_t(scene.materials.size() - 1);
}

Channel weight_keys(uint32_t node, Channel::Interpolation interpolation, const std::vector<float>& times,
                    const std::vector<std::vector<float>>& keys) {
  Channel channel;
  channel.node = node;
  channel.path = Channel::Path::weights;
  channel.interpolation = interpolation;
  channel.times = times;
  for (const std::vector<float>& key : keys)
    channel.values.insert(channel.values.end(), key.begin(), key.end());
  return channel;
}

}  // namespace lodestone::scene::builtin
