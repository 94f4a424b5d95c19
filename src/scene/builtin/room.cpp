// SPDX-License-Identifier: MIT
// A closed room at night, lit by surfaces that shine: a panel under the ceiling, a pendant that swings and a
// screen.
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "lodestone/scene/builtin/scenes.h"
#include "lodestone/scene/builtin/staging.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

constexpr glm::vec3 half_room(2, 1.5f, 2.5f);  // from its middle, 1.5 above the floor

// The surface of a box from -half to half, flat faces of `cells` x `cells` quads with a texture square each;
// materials[i] is that of face i of BoxLattice::faces. `inside`: it is seen from within.
Mesh box(const std::string& name, const glm::vec3& half, int cells, const std::array<uint32_t, 6>& materials,
         bool inside = false) {
  Mesh mesh;
  mesh.name = name;
  const BoxLattice lattice(glm::ivec3{cells});
  constexpr std::array<glm::vec3, 6> normals = {
      {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}};
  for (size_t f = 0; f < 6; ++f) {
    const auto first = static_cast<uint32_t>(mesh.triangles.size());
    Grid grid{uint32_t(cells + 1), uint32_t(cells + 1), 0, {}};
    for (int y = 0; y <= cells; ++y) {
      for (int x = 0; x <= cells; ++x) {
        const int column = inside ? cells - x : x;
        const glm::vec3 place(lattice.face_point(BoxLattice::faces[f], {column, y}));
        grid.vertices.push_back(uint32_t(mesh.positions.size()));
        mesh.positions.push_back(snap((2.0f * place / float(cells) - 1.0f) * half));
        mesh.normals.push_back(inside ? -normals[f] : normals[f]);
        mesh.texcoords[0].push_back(snap(glm::vec2(x, cells - y) / float(cells)));
      }
    }
    add_grid(mesh, std::move(grid));
    add_part(mesh, first, materials[f]);
  }
  return mesh;
}

// Blocks of colours on black.
Image test_card() {
  constexpr std::array<std::array<uint8_t, 3>, 4> bars = {
      {{40, 90, 255}, {30, 220, 160}, {255, 70, 190}, {255, 200, 40}}};
  Image image;
  image.name = "test card";
  image.width = 32;
  image.height = 16;
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      const bool lit = x % 8 > 0 && y % 8 > 0 && (x / 8 + y / 8) % 2 == 0;
      const auto& color = bars[x / 8];
      for (const uint8_t channel : color) image.rgba.push_back(lit ? channel : uint8_t{0});
      image.rgba.push_back(255);
    }
  }
  return image;
}

uint32_t add_lamp(Scene& scene, const std::string& name, const glm::vec3& radiance) {
  const uint32_t lamp = add_material(scene, name, glm::vec3(0.1f), 0.5f);
  scene.materials[lamp].emissive = radiance;
  return lamp;
}

// To and fro about the z axis.
void swing(Scene& scene, uint32_t node) {
  Channel channel;
  channel.node = node;
  channel.path = Channel::Path::rotation;
  constexpr uint32_t keys = 16;
  for (uint32_t i = 0; i <= keys; ++i) {
    const float turn = 2 * 3.14159265f * float(i % keys) / keys, half = 0.25f * std::sin(turn);
    channel.times.push_back(2 * float(i) / keys);
    for (const float value : {0.0f, 0.0f, std::sin(half), std::cos(half)}) channel.values.push_back(value);
  }
  scene.animations.push_back({"Swing", {std::move(channel)}});
}

}  // namespace

Scene make_room() {
  Scene scene;
  scene.sky = Sky{};
  scene.images.push_back(test_card());
  const uint32_t plaster = add_material(scene, "plaster", {0.76f, 0.74f, 0.7f}, 0.9f);
  const uint32_t red = add_material(scene, "red", {0.62f, 0.09f, 0.06f}, 0.8f);
  const uint32_t green = add_material(scene, "green", {0.12f, 0.42f, 0.14f}, 0.8f);
  const uint32_t boards = add_material(scene, "boards", {0.42f, 0.27f, 0.16f}, 0.35f);
  const uint32_t housing = add_material(scene, "housing", glm::vec3(0.5f), 0.4f, 1);
  const uint32_t gold = add_material(scene, "gold", {1, 0.77f, 0.34f}, 0.3f, 1);
  const uint32_t panel = add_lamp(scene, "panel", {7, 7.4f, 8});
  const uint32_t bulb = add_lamp(scene, "bulb", {9, 5.4f, 2.4f});
  const uint32_t screen = add_lamp(scene, "screen", glm::vec3(3));
  scene.materials[screen].emissive_texture.image = 0;
  scene.materials[screen].emissive_texture.nearest = true;

  add_mesh(scene, box("room", half_room, 8, {plaster, green, plaster, red, plaster, boards}, true), none,
           {0, 1.5f, 0});
  add_mesh(scene, box("panel", {0.6f, 0.04f, 0.35f}, 2, {housing, housing, housing, housing, housing, panel}),
           none, {-0.4f, 2.9f, -0.2f});
  add_mesh(scene,
           box("screen", {0.65f, 0.35f, 0.03f}, 4, {screen, housing, housing, housing, housing, housing}),
           none, {-0.55f, 1.5f, -2.4f});
  const uint32_t block = add_mesh(
      scene, box("block", {0.32f, 0.5f, 0.32f}, 4, {plaster, plaster, plaster, plaster, plaster, plaster}),
      none, {-0.75f, 0.5f, -1.1f});
  scene.nodes[block].rotation = glm::angleAxis(0.35f, glm::vec3(0, 1, 0));
  add_mesh(scene, ball("gold", 16, gold), none, {0.6f, 0.45f, -0.7f}, glm::vec3(0.45f));
  Node hook;
  hook.name = "pendant";
  hook.translation = {1.05f, 3, -1};
  const uint32_t pendant = add_node(scene, hook);
  add_mesh(scene,
           box("cord", {0.008f, 0.55f, 0.008f}, 1, {housing, housing, housing, housing, housing, housing}),
           pendant, {0, -0.55f, 0});
  add_mesh(scene, ball("bulb", 6, bulb), pendant, {0, -1.25f, 0}, glm::vec3(0.17f));
  swing(scene, pendant);

  // For those who look with direct light alone.
  Light candle;
  candle.name = "Candle";
  candle.kind = Light::Kind::point;
  candle.color = {1, 0.8f, 0.6f};
  candle.intensity = 0.6f;
  add_light(scene, candle, {1.6f, 0.8f, 2}, {0, 0, 0});
  Camera camera;
  camera.name = "Door";
  camera.yfov = 0.95f;
  add_camera(scene, camera, {0.1f, 1.45f, 2.35f}, {0, 1.3f, -1});
  return scene;
}

}  // namespace lodestone::scene::builtin
