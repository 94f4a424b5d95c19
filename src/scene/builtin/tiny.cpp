// SPDX-License-Identifier: MIT
// The smallest scene with everything a deforming mesh has: to step through with a debugger.
#include "lodestone/scene/builtin/scenes.h"
#include "lodestone/scene/builtin/staging.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {
namespace {

Mesh tiny_mesh(uint32_t flat_material, uint32_t bent_material) {
  Mesh mesh;
  mesh.name = "tiny";
  // A strip of 3 x 2 samples in the plane z = 0, and beside it a quad that is not planar.
  mesh.positions = {{-1.5f, -0.5f, 0},   {-0.75f, -0.5f, 0},  {0, -0.5f, 0},    {-1.5f, 0.5f, 0},
                    {-0.75f, 0.5f, 0},   {0, 0.5f, 0},        {0.5f, -0.5f, 0}, {1.5f, -0.5f, 0.25f},
                    {0.5f, 0.5f, 0.25f}, {1.5f, 0.5f, -0.25f}};
  mesh.texcoords[0] = {{0, 0}, {0.5f, 0}, {1, 0}, {0, 1}, {0.5f, 1}, {1, 1}, {0, 0}, {1, 0}, {0, 1}, {1, 1}};
  add_grid(mesh, {3, 2, 0, {0, 1, 2, 3, 4, 5}});
  add_part(mesh, 0, flat_material);
  add_grid(mesh, {2, 2, 0, {6, 7, 8, 9}});
  add_part(mesh, 4, bent_material);
  mesh.normals = snapped_normals(mesh, mesh.positions);

  std::vector<glm::vec3> posed = mesh.positions;
  posed[1].z = posed[4].z = 0.5f;  // folds the strip along its middle
  posed[9].z = 0.5f;
  add_target(mesh, morph_target(mesh, "fold", posed));
  return mesh;
}

}  // namespace

Scene make_tiny() {
  Scene scene;
  const uint32_t red = add_material(scene, "red", {0.8f, 0.15f, 0.1f}, 0.8f);
  const uint32_t blue = add_material(scene, "blue", {0.1f, 0.25f, 0.8f}, 0.5f);
  for (Material& material : scene.materials) material.double_sided = true;
  const uint32_t node = add_mesh(scene, tiny_mesh(red, blue));

  Camera camera;
  camera.name = "Front";
  add_camera(scene, camera, {0.5f, 0.75f, 4.5f}, {0, 0, 0});
  Light light;
  light.name = "Lamp";
  light.intensity = 40;
  add_light(scene, light, {1.5f, 2, 3}, {0, 0, 0});
  scene.sky = Sky{{0.6f, 0.7f, 0.9f}, {0.5f, 0.5f, 0.5f}, {0.2f, 0.2f, 0.2f}};

  Animation animation;
  animation.name = "Fold";
  animation.channels.push_back(weight_keys(node, Channel::Interpolation::linear, {0, 1}, {{0}, {1}}));
  scene.animations.push_back(std::move(animation));
  return scene;
}

}  // namespace lodestone::scene::builtin
