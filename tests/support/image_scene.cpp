// SPDX-License-Identifier: MIT
#include "lodestone/test_support/image_scene.h"

#include "lodestone/geometry_image/texel_values.h"
#include "lodestone/layout/arithmetic.h"

namespace lodestone::test {

scene::Scene image_scene(const ReadyScene& ready, const scene::Pose& pose) {
  scene::Mesh mesh;
  mesh.name = "geometry image";
  mesh.positions = ready.texels(pose);
  mesh.normals = geometry_image::at_texels(
      ready.assembly, ready.atlas.texel_map,
      scene::blended_normals(ready.assembly, scene::frame_weights(ready.scene, ready.assembly, pose),
                             scene::frame_matrices(ready.scene, ready.assembly, pose)));
  for (glm::vec3& normal : mesh.normals) normal = layout::normalize_or(normal, glm::vec3(0, 0, 1));
  mesh.triangles = quad_triangles(ready.atlas).texels;
  mesh.parts = {{0, static_cast<uint32_t>(mesh.triangles.size()), scene::none}};
  scene::Scene scene;
  scene.name = ready.scene.name + ", its geometry image";
  scene.meshes = {std::move(mesh)};
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  return scene;
}

}  // namespace lodestone::test
