// SPDX-License-Identifier: MIT
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {

scene::Mesh square(float z, uint32_t material) {
  scene::Mesh mesh;
  mesh.positions = {{-1, 1, z}, {1, 1, z}, {-1, -1, z}, {1, -1, z}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.texcoords[0] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.triangles = {{0, 2, 1}, {3, 1, 2}};
  mesh.parts = {{0, 2, material}};
  return mesh;
}

scene::Scene facing_camera(std::vector<scene::Mesh> meshes, std::vector<scene::Material> materials) {
  scene::Scene scene;
  scene.name = "facing camera";
  for (uint32_t i = 0; i < meshes.size(); ++i) {
    scene::Node node;
    node.mesh = i;
    scene.nodes.push_back(node);
  }
  scene.meshes = std::move(meshes);
  scene.materials = std::move(materials);
  scene::Camera camera;
  camera.perspective = false;
  camera.xmag = camera.ymag = 1.5f;
  scene.cameras = {camera};
  scene::Node eye;
  eye.translation = {0, 0, 3};
  eye.camera = 0;
  scene.nodes.push_back(eye);
  scene.sky = scene::Sky{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
  return scene;
}

}  // namespace lodestone::test
