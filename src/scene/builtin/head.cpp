// SPDX-License-Identifier: MIT
// The cartoon bust: its parts, materials, lights and camera.
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

void light_portrait(Scene& scene) {
  Light key;
  key.name = "Key";
  key.kind = Light::Kind::spot;
  key.color = {1, 0.86f, 0.70f};
  key.intensity = 115;
  key.inner_cone = 0.35f;
  key.outer_cone = 0.55f;
  add_light(scene, key, {2.6f, 3.0f, 5.0f}, {0, -0.2f, 0});
  Light rim;
  rim.name = "Rim";
  rim.kind = Light::Kind::point;
  rim.color = {0.50f, 0.72f, 1};
  rim.intensity = 60;
  add_light(scene, rim, {-2.6f, 2.4f, -3.6f}, {0, 0, 0});
  Light fill;
  fill.name = "Fill";
  fill.kind = Light::Kind::point;
  fill.color = {0.75f, 0.80f, 1};
  fill.intensity = 20;
  add_light(scene, fill, {-3.5f, 0.3f, 4}, {0, 0, 0});
  scene.sky = Sky{{0.36f, 0.46f, 0.60f}, {0.30f, 0.32f, 0.36f}, {0.16f, 0.12f, 0.10f}};
}

}  // namespace

Scene make_head() {
  Scene scene;
  const uint32_t skin = add_material(scene, "skin", glm::vec3(1), 0.45f);
  const uint32_t ear = add_material(scene, "ear", glm::vec3(1), 0.45f);
  const uint32_t eye = add_material(scene, "eye", glm::vec3(1), 0.10f);
  const uint32_t brow = add_material(scene, "brow", {0.13f, 0.040f, 0.015f}, 0.7f);
  const uint32_t tooth = add_material(scene, "tooth", {0.90f, 0.87f, 0.80f}, 0.18f);
  const uint32_t tongue = add_material(scene, "tongue", {0.70f, 0.20f, 0.20f}, 0.35f);
  const uint32_t hair = add_material(scene, "hair", {0.50f, 0.135f, 0.030f}, 0.42f);
  const uint32_t wool = add_material(scene, "wool", {0.03f, 0.20f, 0.24f}, 0.9f);
  scene.images = {iris_image(), freckle_image()};
  scene.materials[eye].base_color_texture.image = 0;
  scene.materials[skin].base_color_texture.image = 1;

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
