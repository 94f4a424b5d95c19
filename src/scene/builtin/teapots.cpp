// SPDX-License-Identifier: MIT
// The teapot island of Carr, Hoberock, Crane and Hart 2006 (figure 9): three Utah teapots in the middle of a
// large, sparse landscape, so that detail is at widely varying scales.
#include <array>
#include <cmath>

#include "lodestone/scene/builtin/island.h"
#include "lodestone/scene/builtin/scenes.h"
#include "lodestone/scene/builtin/staging.h"
#include "lodestone/scene/builtin/surface.h"
#include "lodestone/scene/builtin/teapot.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;

struct Palm {
  glm::vec2 place;
  float turn, size;  // radians about +Y; 1: as palm() makes it
  uint32_t kind;
};

constexpr std::array<Palm, 12> palms = {{{{-24, -31}, 0.4f, 1, 0},
                                         {{-31, -27}, 2.6f, 0.82f, 1},
                                         {{30, -36}, 3.4f, 1.05f, 1},
                                         {{8, -55}, 1.2f, 1.1f, 0},
                                         {{15, -60}, 4.4f, 0.9f, 1},
                                         {{-52, -12}, 5.2f, 1, 1},
                                         {{-47, 22}, 0.9f, 0.95f, 0},
                                         {{-40, 27}, 3.9f, 1.1f, 1},
                                         {{50, 6}, 2.1f, 1, 0},
                                         {{56, 1}, 5.9f, 0.85f, 1},
                                         {{36, 38}, 4.9f, 1.05f, 0},
                                         {{-8, 58}, 1.7f, 1, 1}}};

glm::quat turned(float angle) {
  return {snap(std::cos(angle / 2)), 0, snap(std::sin(angle / 2)), 0};
}

void add_palms(Scene& scene, uint32_t material) {
  const uint32_t first = uint32_t(scene.meshes.size());
  for (uint32_t kind = 0; kind < 2; ++kind)
    scene.meshes.push_back(palm("palm" + std::to_string(kind + 1), kind, material));
  for (size_t k = 0; k < palms.size(); ++k) {
    Node node;
    node.name = "palm" + std::to_string(k + 1);
    node.mesh = first + palms[k].kind;
    node.translation = snap(glm::vec3(palms[k].place.x, island_height(palms[k].place), palms[k].place.y));
    node.rotation = turned(palms[k].turn);
    node.scale = glm::vec3(palms[k].size);
    add_node(scene, std::move(node));
  }
}

// One turn about the axis; the last key is the first.
Channel spin(uint32_t node, float start, float direction) {
  Channel channel;
  channel.node = node;
  channel.path = Channel::Path::rotation;
  constexpr int steps = 8;
  for (int k = 0; k <= steps; ++k) {
    const glm::quat q = turned(start + direction * 2 * pi * float(k % steps) / steps);
    channel.times.push_back(2.0f * float(k) / steps);
    channel.values.insert(channel.values.end(), {q.x, q.y, q.z, q.w});
  }
  return channel;
}

struct Pot {
  const char* name;
  glm::vec3 color;
  float roughness, metallic;
  glm::vec2 place;
  float turn, direction;  // radians about +Y at rest; of the clip, +1 or -1
};

// A mirror, brushed metal and glazed pottery, each within 3.5 of its place however it turns.
constexpr std::array<Pot, 3> pots = {{{"chrome", {0.78f, 0.79f, 0.80f}, 0.02f, 1, {-3.9f, 2.2f}, 0.45f, 1},
                                      {"copper", {0.90f, 0.50f, 0.32f}, 0.25f, 1, {4.0f, 2.0f}, 2.7f, -1},
                                      {"glaze", {0.05f, 0.16f, 0.42f}, 0.10f, 0, {0.1f, -4.6f}, -0.5f, 1}}};
constexpr float clearance = 0.004f;  // so that no two surfaces lie in one plane

void add_teapots(Scene& scene) {
  Animation animation;
  animation.name = "Turn";
  for (const Pot& pot : pots) {
    const uint32_t material = add_material(scene, pot.name, pot.color, pot.roughness, pot.metallic);
    scene.materials[material].double_sided = true;  // one sees into the spout, and past the lid
    const uint32_t node = add_mesh(scene, teapot(pot.name, material), none,
                                   snap(glm::vec3(pot.place.x, clearance, pot.place.y)));
    scene.nodes[node].rotation = turned(pot.turn);
    animation.channels.push_back(spin(node, pot.turn, pot.direction));
  }
  scene.animations.push_back(std::move(animation));
}

// Everything; the teapots; and the mirror's handle, in which distant palms are to be seen.
void add_cameras(Scene& scene) {
  Camera camera;
  camera.name = "teapots";
  camera.yfov = 0.7f;
  add_camera(scene, camera, {1.8f, 4.3f, 18.5f}, {0.2f, 3.2f, 0});
  camera.name = "island";
  camera.yfov = 0.75f;
  add_camera(scene, camera, {52, 50, 150}, {0, -6, 0});
  camera.name = "handle";
  camera.yfov = 0.5f;
  add_camera(scene, camera, {-8.9f, 2.2f, 5.5f}, {-6.1f, 1.75f, 3.2f});
}

}  // namespace

Scene make_teapots() {
  Scene scene;
  add_teapots(scene);
  scene.images.push_back(island_picture());
  const uint32_t ground = add_material(scene, "ground", glm::vec3(1), 0.95f);
  scene.materials[ground].base_color_texture.image = 0;
  const uint32_t sea = add_material(scene, "sea", glm::vec3(1), 0.12f);
  const uint32_t leaf = add_material(scene, "palm", glm::vec3(1), 0.55f);
  scene.materials[leaf].double_sided = true;
  add_mesh(scene, island_ground(ground));
  add_mesh(scene, island_sea(sea));
  add_palms(scene, leaf);
  add_cameras(scene);

  Light sun;
  sun.name = "Sun";
  sun.kind = Light::Kind::directional;
  sun.color = {1, 0.93f, 0.80f};
  sun.intensity = 3.2f;
  add_light(scene, sun, {-5, 7, 4}, {0, 0, 0});
  scene.sky = Sky{{0.16f, 0.34f, 0.75f}, {0.70f, 0.78f, 0.86f}, {0.05f, 0.12f, 0.17f}};
  return scene;
}

}  // namespace lodestone::scene::builtin
