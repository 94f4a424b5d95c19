// SPDX-License-Identifier: MIT
// Ten thousand fish of three kinds that circle in a ball above the sea floor: rings that turn, each with the
// fish that swim in it.
#include <array>
#include <cmath>
#include <string>

#include "lodestone/scene/builtin/noise.h"
#include "lodestone/scene/builtin/scenes.h"
#include "lodestone/scene/builtin/staging.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

constexpr float pi = 3.14159265f;
constexpr uint32_t rings = 125, fish_a_ring = 80, kinds = 3;
constexpr float ball_radius = 24, floor_height = -29;

// A profile through given points along the body, with level tangents.
struct Knot {
  float at, value;
};
template <size_t count>
float profile(const std::array<Knot, count>& knots, float at) {
  for (size_t i = 1; i < count; ++i) {
    if (at > knots[i].at) continue;
    const float x = (at - knots[i - 1].at) / (knots[i].at - knots[i - 1].at);
    return glm::mix(knots[i - 1].value, knots[i].value, x * x * (3 - 2 * x));
  }
  return knots.back().value;
}
constexpr std::array<Knot, 5> half_height = {
    {{0, 0.012f}, {0.12f, 0.085f}, {0.36f, 0.165f}, {0.82f, 0.028f}, {1, 0.19f}}};
constexpr std::array<Knot, 5> half_width = {
    {{0, 0}, {0.12f, 0.05f}, {0.36f, 0.082f}, {0.82f, 0.014f}, {1, 0}}};

struct Kind {
  const char* name;
  glm::vec3 back, flank, belly;
  float metallic, roughness;
};
constexpr std::array<Kind, kinds> looks = {
    {{"sardine", {0.03f, 0.10f, 0.16f}, {0.55f, 0.63f, 0.68f}, {0.85f, 0.86f, 0.84f}, 0.75f, 0.28f},
     {"anthias", {0.60f, 0.13f, 0.10f}, {0.95f, 0.40f, 0.12f}, {0.95f, 0.72f, 0.45f}, 0, 0.4f},
     {"chromis", {0.03f, 0.08f, 0.30f}, {0.08f, 0.35f, 0.75f}, {0.55f, 0.75f, 0.85f}, 0.2f, 0.35f}}};

// One long, its nose at -Z.
Mesh fish(const Kind& kind, uint32_t material) {
  Mesh mesh;
  mesh.name = kind.name;
  const ZippedTube tube(16, 24);
  for (const ZippedTube::Sample& sample : tube.samples()) {
    const float at = float(sample.row) / float(tube.rows() - 1);
    const float angle = 2 * pi * float(sample.column) / float(tube.columns());
    const float up = std::cos(angle);
    const float fork = at > 0.82f ? (at - 0.82f) / 0.18f * (std::abs(up) - 1) * 0.13f : 0;
    mesh.positions.push_back(snap(glm::vec3(profile(half_width, at) * std::sin(angle),
                                            profile(half_height, at) * up, at - 0.5f + fork)));
    const glm::vec3 color =
        up > 0 ? glm::mix(kind.flank, kind.back, up) : glm::mix(kind.flank, kind.belly, -up);
    mesh.colors.push_back(glm::vec4(snap(color), 1));
  }
  add_grid(mesh, tube.chart());
  mesh.normals = snapped_normals(mesh, mesh.positions);
  add_part(mesh, 0, material);
  return mesh;
}

Mesh sea_floor(uint32_t material) {
  constexpr int cells = 48;
  constexpr float half = 150;
  Mesh mesh;
  mesh.name = "floor";
  Grid grid{cells + 1, cells + 1, 0, {}};
  for (int y = 0; y <= cells; ++y) {
    for (int x = 0; x <= cells; ++x) {
      const glm::vec2 p = (2.0f * glm::vec2(x, y) / float(cells) - 1.0f) * half;
      grid.vertices.push_back(uint32_t(mesh.positions.size()));
      mesh.positions.push_back(snap(glm::vec3(p.x, 2.2f * fractal_noise(p, 0.035f, 4), -p.y)));
    }
  }
  add_grid(mesh, std::move(grid));
  mesh.normals = snapped_normals(mesh, mesh.positions);
  add_part(mesh, 0, material);
  return mesh;
}

// Numbers in [0, 1) for each fish or ring.
float chance(uint32_t a, uint32_t b, uint32_t what) {
  return lattice_noise(int(a), int(b), what);
}

glm::quat about_y(float angle) {
  return {snap(std::cos(angle / 2)), 0, snap(std::sin(angle / 2)), 0};
}
glm::quat about_z(float angle) {
  return {snap(std::cos(angle / 2)), 0, 0, snap(std::sin(angle / 2))};
}

// Whole turns in the twelve seconds of the clip.
Channel turns(uint32_t node, int count) {
  Channel channel;
  channel.node = node;
  channel.path = Channel::Path::rotation;
  const int steps = 4 * count;
  for (int k = 0; k <= steps; ++k) {
    const glm::quat q = about_y(float(k % 4) * pi / 2);
    channel.times.push_back(12.0f * float(k) / float(steps));
    channel.values.insert(channel.values.end(), {q.x, q.y, q.z, q.w});
  }
  return channel;
}

void add_fish(Scene& scene, uint32_t ring, uint32_t index, float radius, uint32_t turning) {
  const uint32_t id = ring * fish_a_ring + index;
  const float angle = 2 * pi * (float(index) + 0.8f * chance(id, 1, 0)) / float(fish_a_ring);
  const float out = radius + 2.4f * (chance(id, 2, 0) - 0.5f), up = 2.6f * (chance(id, 3, 0) - 0.5f);
  Node node;
  node.name = "fish" + std::to_string(id);
  node.parent = turning;
  node.mesh = (ring + (chance(id, 4, 0) < 0.15f ? index : 0)) % kinds;
  node.translation = snap(glm::vec3(out * std::cos(angle), up, -out * std::sin(angle)));
  // Along the circle, a little off it, leaning inwards.
  node.rotation =
      about_y(angle + 0.5f * (chance(id, 5, 0) - 0.5f)) * about_z(0.6f * (chance(id, 6, 0) - 0.5f));
  node.scale = glm::vec3(snap(0.9f + 0.9f * chance(id, 7, 0)));
  add_node(scene, std::move(node));
}

void add_rings(Scene& scene) {
  Animation animation;
  animation.name = "Circle";
  for (uint32_t ring = 0; ring < rings; ++ring) {
    const float height = ball_radius * 0.92f * (2 * (float(ring) + 0.5f) / float(rings) - 1);
    const float widest = std::sqrt(ball_radius * ball_radius - height * height);
    const float radius = widest * std::sqrt(0.08f + 0.92f * chance(ring, 0, 1));
    Node tilted;
    tilted.name = "ring" + std::to_string(ring);
    tilted.translation = snap(glm::vec3(0, height, 0));
    tilted.rotation = about_z(0.5f * (chance(ring, 1, 1) - 0.5f));
    const uint32_t parent = add_node(scene, std::move(tilted));
    Node turning;
    turning.name = "turning" + std::to_string(ring);
    turning.parent = parent;
    const uint32_t node = add_node(scene, std::move(turning));
    animation.channels.push_back(turns(node, radius < 10 ? 3 : (radius < 17 ? 2 : 1)));
    for (uint32_t i = 0; i < fish_a_ring; ++i) add_fish(scene, ring, i, radius, node);
  }
  scene.animations.push_back(std::move(animation));
}

}  // namespace

Scene make_shoal() {
  Scene scene;
  for (const Kind& kind : looks) {
    const uint32_t material = add_material(scene, kind.name, glm::vec3(1), kind.roughness, kind.metallic);
    scene.meshes.push_back(fish(kind, material));
  }
  add_rings(scene);
  const uint32_t sand = add_material(scene, "sand", {0.50f, 0.46f, 0.36f}, 1);
  add_mesh(scene, sea_floor(sand), none, glm::vec3(0, floor_height, 0));

  Camera camera;
  camera.name = "ball";
  camera.yfov = 0.72f;
  add_camera(scene, camera, {0, -6, 78}, {0, -3, 0});
  camera.name = "among";
  camera.yfov = 0.9f;
  add_camera(scene, camera, {-9, -3, 24}, {4, 1, 0});

  Light sun;
  sun.name = "Sun";
  sun.kind = Light::Kind::directional;
  sun.color = {0.80f, 0.95f, 1};
  sun.intensity = 3;
  add_light(scene, sun, {2, 8, 3}, {0, 0, 0});
  scene.sky = Sky{{0.45f, 0.80f, 0.95f}, {0.06f, 0.28f, 0.42f}, {0.01f, 0.05f, 0.10f}};
  return scene;
}

}  // namespace lodestone::scene::builtin
