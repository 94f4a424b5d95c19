// SPDX-License-Identifier: MIT
// A scene with its assembly and atlas, kept together because a renderer refers to all three.
#pragma once

#include <optional>
#include <string>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/render/renderer.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/scene.h"

namespace lodestone::test {

struct ReadyScene {
  scene::Scene scene;
  scene::Assembly assembly;
  geometry_image::Atlas atlas;
  uint32_t animation = scene::none;

  ReadyScene(scene::Scene made, const geometry_image::AtlasSettings& settings = {},
             scene::Instancing instancing = scene::Instancing::off);
  // A file or builtin:NAME.
  explicit ReadyScene(const std::string& spec, const geometry_image::AtlasSettings& settings = {},
                      scene::Instancing instancing = scene::Instancing::off);

  scene::Pose pose(float time) const { return scene::evaluate(scene, animation, time); }
  // The points of all texels at a pose, in the arithmetic of `blend` and `rasterise`.
  std::vector<glm::vec3> texels(const scene::Pose& pose) const;
};

// A file of the shared data folder ($LODESTONE_DATA, else ../shared/data); empty where it is absent.
std::optional<std::string> data_file(const std::string& name);

// The quads of an atlas as triangles, in the order of primitives that hits name: entry p is primitive ids[p].
struct QuadTriangles {
  std::vector<glm::uvec3> texels;
  std::vector<uint32_t> primitives;
};
QuadTriangles quad_triangles(const geometry_image::Atlas& atlas);

}  // namespace lodestone::test
