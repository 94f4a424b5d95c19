// SPDX-License-Identifier: MIT
#include "lodestone/scene/single_mesh.h"

#include <utility>

#include "lodestone/base/error.h"

namespace lodestone::scene {

Scene single_mesh_scene(const std::filesystem::path& path, Mesh mesh) {
  if (mesh.name.empty()) mesh.name = path.stem().string();
  if (mesh.parts.empty()) mesh.parts.push_back({0, static_cast<uint32_t>(mesh.triangles.size()), none});
  Scene scene;
  scene.name = path.string();
  Node node;
  node.name = mesh.name;
  node.mesh = 0;
  scene.nodes.push_back(std::move(node));
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

void fail_too_many(const std::string& file) {
  fail_input(file, "has more than {} vertices or triangles, which are too many for one mesh; split the file",
             none - 1);
}

}  // namespace lodestone::scene
