// SPDX-License-Identifier: MIT
// Spheres on a floor: closed surfaces of several materials under lights of every kind.
#include <cmath>

#include "lodestone/scene/builtin/scenes.h"
#include "lodestone/scene/builtin/staging.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

// A ball with a texture square on every face: border vertices are doubled, equal but for their coordinates.
Mesh textured_sphere(const std::string& name, int cells, uint32_t material) {
  Mesh mesh;
  mesh.name = name;
  const BoxLattice lattice(glm::ivec3{cells});
  for (const BoxLattice::Face face : BoxLattice::faces) {
    Grid grid{uint32_t(cells + 1), uint32_t(cells + 1), 0, {}};
    for (int y = 0; y <= cells; ++y)
      for (int x = 0; x <= cells; ++x) {
        grid.vertices.push_back(uint32_t(mesh.positions.size()));
        mesh.positions.push_back(snap(cube_sphere_direction(lattice, lattice.face_point(face, {x, y}))));
        mesh.texcoords[0].push_back(snap(glm::vec2(x, cells - y) / float(cells)));
      }
    add_grid(mesh, std::move(grid));
  }
  mesh.normals = mesh.positions;
  add_part(mesh, 0, material);
  return mesh;
}

Mesh floor_mesh(int cells, float half_width, uint32_t material) {
  Mesh mesh;
  mesh.name = "floor";
  Grid grid{uint32_t(cells + 1), uint32_t(cells + 1), 0, {}};
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x) {
      const glm::vec2 p = (2.0f * glm::vec2(x, y) / float(cells) - 1.0f) * half_width;
      grid.vertices.push_back(uint32_t(mesh.positions.size()));
      mesh.positions.push_back(snap(glm::vec3(p.x, 0, -p.y)));
      mesh.texcoords[0].push_back(glm::vec2(x, cells - y) / float(cells));
    }
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0, 1, 0));
  add_grid(mesh, std::move(grid));
  add_part(mesh, 0, material);
  return mesh;
}

// Squeezes the sphere flat and wide, as a ball that lands.
void add_squash(Mesh& mesh) {
  std::vector<glm::vec3> posed = mesh.positions;
  for (glm::vec3& p : posed) p = snap(glm::vec3(1.3f * p.x, 0.55f * p.y - 0.45f, 1.3f * p.z));
  add_target(mesh, morph_target(mesh, "squash", posed));
}

Image checker() {
  Image image;
  image.name = "checker";
  image.width = image.height = 64;
  for (uint32_t y = 0; y < image.height; ++y)
    for (uint32_t x = 0; x < image.width; ++x) {
      const bool light = ((x / 16) + (y / 16)) % 2 == 0;
      const std::array<uint8_t, 4> texel =
          light ? std::array<uint8_t, 4>{235, 225, 205, 255} : std::array<uint8_t, 4>{30, 70, 90, 255};
      image.rgba.insert(image.rgba.end(), texel.begin(), texel.end());
    }
  return image;
}

void add_lights(Scene& scene) {
  Light sun;
  sun.name = "Sun";
  sun.kind = Light::Kind::directional;
  sun.color = {1, 0.95f, 0.85f};
  sun.intensity = 1.5f;
  add_light(scene, sun, {3, 5, 2}, {0, 0, 0});
  Light bulb;
  bulb.name = "Bulb";
  bulb.kind = Light::Kind::point;
  bulb.color = {0.6f, 0.75f, 1};
  bulb.intensity = 12;
  bulb.range = 20;
  add_light(scene, bulb, {-3, 2.5f, 2.5f}, {0, 0, 0});
  Light spot;
  spot.name = "Spot";
  spot.kind = Light::Kind::spot;
  spot.color = {1, 0.6f, 0.35f};
  spot.intensity = 60;
  spot.inner_cone = 0.2f;
  spot.outer_cone = 0.35f;
  add_light(scene, spot, {1.5f, 5, 3.5f}, {0.6f, 0.4f, 1});
  scene.sky = Sky{{0.35f, 0.45f, 0.6f}, {0.5f, 0.5f, 0.5f}, {0.15f, 0.13f, 0.12f}};
}

}  // namespace

Scene make_spheres() {
  Scene scene;
  scene.images.push_back(checker());
  const uint32_t grey = add_material(scene, "floor", glm::vec3(0.55f), 0.9f);
  const uint32_t gold = add_material(scene, "gold", {1, 0.77f, 0.34f}, 0.25f, 1);
  const uint32_t checkered = add_material(scene, "checkered", glm::vec3(1), 0.5f);
  scene.materials[checkered].base_color_texture.image = 0;
  const uint32_t rubber = add_material(scene, "rubber", {0.75f, 0.08f, 0.06f}, 0.4f);
  const uint32_t chalk = add_material(scene, "chalk", {0.2f, 0.55f, 0.3f}, 1);

  const auto place = [&](Mesh mesh, glm::vec2 at, float radius) {
    return add_mesh(scene, std::move(mesh), none, glm::vec3(at.x, radius, at.y), glm::vec3(radius));
  };
  add_mesh(scene, floor_mesh(32, 4, grey));
  place(ball("gold", 16, gold), {-0.9f, -0.6f}, 1);
  place(textured_sphere("checkered", 12, checkered), {1.1f, -0.3f}, 0.7f);
  Mesh bouncing = ball("ball", 12, rubber);
  add_squash(bouncing);
  const uint32_t ball_node = place(std::move(bouncing), {0.3f, 1.1f}, 0.4f);
  place(ball("chalk", 8, chalk), {-0.7f, 1.3f}, 0.25f);

  Camera camera;
  camera.name = "Overview";
  add_camera(scene, camera, {1.2f, 2.6f, 6}, {0, 0.6f, 0});
  add_lights(scene);

  // The ball jumps and lands: morph and node move together.
  Animation animation;
  animation.name = "Bounce";
  animation.channels.push_back(
      weight_keys(ball_node, Channel::Interpolation::linear, {0, 0.15f, 0.85f, 1}, {{1}, {0}, {0}, {1}}));
  Channel jump;
  jump.node = ball_node;
  jump.path = Channel::Path::translation;
  jump.interpolation = Channel::Interpolation::cubic_spline;
  jump.times = {0, 0.5f, 1};
  for (const glm::vec2 key : {glm::vec2(0.4f, 0), glm::vec2(1.2f, 0), glm::vec2(0.4f, 0)}) {
    const std::array<float, 9> values = {0, key.y, 0, 0.3f, key.x, 1.1f, 0, key.y, 0};
    jump.values.insert(jump.values.end(), values.begin(), values.end());
  }
  animation.channels.push_back(std::move(jump));
  scene.animations.push_back(std::move(animation));
  return scene;
}

}  // namespace lodestone::scene::builtin
