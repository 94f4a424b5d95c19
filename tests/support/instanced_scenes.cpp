// SPDX-License-Identifier: MIT
#include "lodestone/test_support/instanced_scenes.h"

#include <array>
#include <random>

#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

uint32_t add(scene::Scene& scene, uint32_t mesh, glm::vec3 at, glm::quat turn, glm::vec3 scale,
             uint32_t parent = scene::none) {
  scene::Node& node = scene.nodes.emplace_back();
  node.mesh = mesh;
  node.parent = parent;
  node.translation = at;
  node.rotation = glm::normalize(turn);
  node.scale = scale;
  return static_cast<uint32_t>(scene.nodes.size() - 1);
}

scene::Channel channel(uint32_t node, scene::Channel::Path path, std::vector<float> values) {
  scene::Channel made;
  made.node = node;
  made.path = path;
  made.times = {0, 1};
  made.values = std::move(values);
  return made;
}

// Red, with holes, bent by a normal map.
void add_fence(scene::Scene& scene) {
  scene::Image holes;
  holes.name = "holes";
  holes.width = holes.height = 4;
  for (uint32_t i = 0; i < 16; ++i) {
    const auto alpha = static_cast<uint8_t>((i / 4 + i % 4) % 3 == 0 ? 0 : 255);
    holes.rgba.insert(holes.rgba.end(), {220, 60, 40, alpha});
  }
  scene::Image bumps;
  bumps.name = "bumps";
  bumps.width = bumps.height = 1;
  bumps.rgba = {180, 150, 220, 255};
  scene.images = {holes, bumps};
  scene::Material& fence = scene.materials.emplace_back();
  fence.metallic = 0;
  fence.alpha_mask = true;
  fence.base_color_texture.image = 0;
  fence.base_color_texture.nearest = true;
  fence.normal_texture.image = 1;
}

}  // namespace

scene::Scene grove() {
  scene::Scene scene = grid_sphere(24);
  scene.name = "grove";
  scene.nodes.clear();
  add_fence(scene);
  const auto fence = static_cast<uint32_t>(scene.materials.size() - 1);
  scene.meshes.push_back(square(0, fence));
  scene.meshes.push_back(square(0, scene::none));
  scene::Mesh ball = grid_sphere(10).meshes[0];
  scene::MorphTarget& taller = ball.targets.emplace_back();
  for (uint32_t v = 0; v < ball.positions.size(); ++v) {
    taller.vertices.push_back(v);
    taller.positions.emplace_back(0, 0.5f * ball.positions[v].y, 0);
  }
  ball.weights = {0.25f};
  scene.meshes.push_back(ball);

  const glm::quat none(1, 0, 0, 0);
  const uint32_t moving = add(scene, 0, {-1.4f, 0, 0.5f}, {0.9f, 0.1f, 0.4f, 0}, glm::vec3(0.6f));
  const uint32_t squeezed =
      add(scene, scene::none, {1.5f, 0.3f, -0.4f}, {0.8f, 0, 0, 0.6f}, {1.2f, 0.4f, 0.8f});
  add(scene, 0, {0.2f, 0.1f, 0}, {0.7f, 0.5f, 0, 0.3f}, glm::vec3(0.7f), squeezed);  // sheared
  add(scene, 0, {0, 1.5f, -1}, none, {-0.5f, 0.7f, 0.5f});                           // mirrored
  add(scene, 0, {0.1f, -0.4f, 1.2f}, {0.6f, 0.2f, 0.7f, 0.1f}, {0.6f, 0.6f, 0.02f});
  add(scene, 0, {0.9f, 0.9f, 1.1f}, none, glm::vec3(0.05f));
  const uint32_t turning = add(scene, 1, {-0.5f, 0.6f, 1.4f}, {0.95f, 0.2f, 0.1f, 0.2f}, glm::vec3(0.5f));
  add(scene, 1, {0.8f, -0.2f, 1.6f}, {0.9f, 0.1f, 0.3f, 0}, {-0.5f, 0.6f, 1});
  add(scene, 1, {-1.2f, -0.5f, 1.3f}, {0.2f, 0.1f, 0.9f, 0.1f}, {0.7f, -0.4f, -1});
  add(scene, 2, {0, -1.2f, 0}, {0.7071068f, -0.7071068f, 0, 0}, glm::vec3(4));
  const uint32_t deforming = add(scene, 3, {0.3f, 0.2f, -0.6f}, none, glm::vec3(0.5f));

  scene::Animation& clip = scene.animations.emplace_back();
  clip.name = "move";
  using Path = scene::Channel::Path;
  clip.channels.push_back(channel(moving, Path::translation, {-1.4f, 0, 0.5f, -0.9f, 0.6f, 0.7f}));
  clip.channels.push_back(channel(squeezed, Path::rotation, {0, 0, 0.6f, 0.8f, 0, 0.6f, 0, 0.8f}));
  clip.channels.push_back(channel(turning, Path::scale, {0.5f, 0.5f, 0.5f, 0.8f, 0.3f, 0.5f}));
  clip.channels.push_back(channel(deforming, Path::weights, {0.25f, 1}));
  return scene;
}

scene::Scene swarm(uint32_t count, float half) {
  scene::Scene scene = grid_sphere(12);
  scene.name = "swarm";
  scene.nodes.clear();
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (uint32_t i = 0; i < count; ++i) {
    std::array<float, 8> drawn{};  // in the same order whatever the compiler
    for (float& number : drawn) number = unit(random);
    const glm::vec3 at(half * drawn[2], half * drawn[1], half * drawn[0]);
    const glm::quat turn(drawn[6] + 1.5f, drawn[5], drawn[4], drawn[3]);
    add(scene, 0, at, turn, glm::vec3(0.25f + 0.1f * drawn[7], 0.25f, 0.2f));
  }
  return scene;
}

}  // namespace lodestone::test
