// SPDX-License-Identifier: MIT
// The cartoon bust: its parts, materials, lights and camera.
#include "lodestone/scene/builtin/head_parts.h"
#include "lodestone/scene/builtin/head_skin.h"
#include "lodestone/scene/builtin/scenes.h"
#include "lodestone/scene/builtin/staging.h"

namespace lodestone::scene::builtin {

void sculpt(Mesh& mesh, const Posing& posed) {
  mesh.positions = posed(Expression{});
  mesh.normals = snapped_normals(mesh, mesh.positions);
  for (const Shape& shape : head_shapes()) add_target(mesh, shape.name, posed(shape.expression));
}

Scene make_head() {
  Scene scene;
  const uint32_t skin_material = add_material(scene, "skin", {0.75f, 0.47f, 0.34f}, 0.45f);
  const uint32_t eye_material = add_material(scene, "eye", glm::vec3(1), 0.08f);
  scene.images.push_back(iris_image());
  scene.materials[eye_material].base_color_texture.image = 0;

  const HeadSkin skin;
  Mesh mesh;
  mesh.name = "skin";
  for (const Grid& grid : skin.grids()) add_grid(mesh, grid);
  add_part(mesh, 0, skin_material);
  sculpt(mesh, [&](const Expression& e) { return skin.posed(e); });
  add_mesh(scene, std::move(mesh));
  add_mesh(scene, head_eyes(eye_material));
  Camera camera;
  camera.name = "Portrait";
  add_camera(scene, camera, {1.5f, 0.2f, 5.2f}, {0, -0.1f, 0});
  return scene;
}

}  // namespace lodestone::scene::builtin
