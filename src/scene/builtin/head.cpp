// SPDX-License-Identifier: MIT
// The cartoon bust: its parts, materials, lights and camera.
#include <array>
#include <string>

#include "lodestone/base/parallel.h"
#include "lodestone/scene/builtin/head_clip.h"
#include "lodestone/scene/builtin/head_parts.h"
#include "lodestone/scene/builtin/scenes.h"
#include "lodestone/scene/builtin/staging.h"
#include "lodestone/scene/builtin/surface.h"

namespace lodestone::scene::builtin {

void sculpt(Mesh& mesh, const Posing& posed) {
  mesh.positions = posed(Expression{});
  mesh.normals = snapped_normals(mesh, mesh.positions);
  const std::span<const Shape> shapes = head_shapes();
  std::vector<MorphTarget> targets(shapes.size());
  parallel_for(shapes.size(), 1, [&](uint64_t k, uint64_t) {
    targets[k] = morph_target(mesh, shapes[k].name, posed(shapes[k].expression));
  });
  for (MorphTarget& target : targets) add_target(mesh, std::move(target));
}

namespace {

// Nothing of the head but the shirt stays behind when it nods.
constexpr glm::vec3 nod_pivot(0, -1.05f, -0.12f);

// Lights have no size. Three close together stand for a lamp that has one: its shadows have soft borders.
void add_soft_key(Scene& scene) {
  constexpr glm::vec3 middle(2.3f, 2.5f, 5.4f);
  constexpr std::array<glm::vec3, 3> corners = {
      {{-0.24f, 0.12f, 0.09f}, {0.19f, 0.19f, -0.12f}, {0.05f, -0.31f, 0.03f}}};
  Light key;
  key.kind = Light::Kind::spot;
  key.color = {1, 0.86f, 0.70f};
  key.intensity = 102.0f / corners.size();
  key.inner_cone = 0.35f;
  key.outer_cone = 0.55f;
  for (size_t k = 0; k < corners.size(); ++k) {
    key.name = "Key" + std::to_string(k + 1);
    add_light(scene, key, middle + corners[k], {0, -0.2f, 0});
  }
}

void light_portrait(Scene& scene) {
  add_soft_key(scene);
  // Beside the camera, which cannot see its shadows. No light from behind: what it grazed would be white
  // slivers, for hair as smooth as this has no fuzz to catch it.
  Light fill;
  fill.name = "Fill";
  fill.kind = Light::Kind::point;
  fill.color = {1, 0.92f, 0.85f};
  fill.intensity = 30;
  add_light(scene, fill, {1.7f, 0.2f, 6.9f}, {0, 0, 0});
  scene.sky = Sky{{0.38f, 0.48f, 0.62f}, {0.32f, 0.34f, 0.38f}, {0.16f, 0.12f, 0.10f}};
}

}  // namespace

Scene make_head() {
  Scene scene;
  const uint32_t skin = add_material(scene, "skin", glm::vec3(1), 0.50f);
  const uint32_t ear = add_material(scene, "ear", glm::vec3(1), 0.50f);
  const uint32_t eye = add_material(scene, "eye", glm::vec3(1), 0.18f);
  const uint32_t brow = add_material(scene, "brow", {0.13f, 0.040f, 0.015f}, 0.7f);
  const uint32_t tooth = add_material(scene, "tooth", glm::vec3(1), 0.25f);
  const uint32_t tongue = add_material(scene, "tongue", {0.70f, 0.20f, 0.20f}, 0.35f);
  const uint32_t hair = add_material(scene, "hair", {0.50f, 0.135f, 0.030f}, 0.50f);
  const uint32_t wool = add_material(scene, "wool", {0.03f, 0.20f, 0.24f}, 0.9f);
  scene.images = {iris_image(), freckle_image(), mouth_shade()};
  scene.materials[eye].base_color_texture.image = 0;
  scene.materials[skin].base_color_texture.image = 1;
  scene.materials[tooth].occlusion_texture.image = scene.materials[tongue].occlusion_texture.image = 2;

  Node bust;
  bust.name = "bust";
  const uint32_t root = add_node(scene, bust);
  Node head;
  head.name = "head";
  head.parent = root;
  head.translation = nod_pivot;
  const uint32_t pivot = add_node(scene, head);
  std::array parts = {head_skin(skin),   head_eyes(eye),      head_ears(ear), head_brows(brow),
                      head_teeth(tooth), head_tongue(tongue), head_hair(hair)};
  for (Mesh& mesh : parts) add_mesh(scene, std::move(mesh), pivot, -nod_pivot);
  add_mesh(scene, head_shirt(wool), root);

  Camera camera;
  camera.name = "Portrait";
  camera.yfov = 0.41f;
  add_camera(scene, camera, {2.2f, 0.30f, 7.4f}, {0, 0.0f, 0});
  light_portrait(scene);
  scene.animations.push_back(expressions_clip(scene, pivot));
  return scene;
}

}  // namespace lodestone::scene::builtin
