// SPDX-License-Identifier: MIT
#include "lodestone/test_support/ready_scene.h"

#include <bit>
#include <cstdlib>
#include <filesystem>

#include "lodestone/layout/arithmetic.h"
#include "lodestone/scene/load.h"

namespace lodestone::test {

ReadyScene::ReadyScene(scene::Scene made, const geometry_image::AtlasSettings& settings,
                       scene::Instancing instancing)
    : scene(std::move(made)),
      assembly(scene::assemble(scene, instancing)),
      atlas(build_atlas(scene, assembly, settings)) {
  animation = scene.animations.empty() ? scene::none : 0;
}

ReadyScene::ReadyScene(const std::string& spec, const geometry_image::AtlasSettings& settings,
                       scene::Instancing instancing)
    : ReadyScene(scene::load(spec), settings, instancing) {}

std::vector<glm::vec3> ReadyScene::texels(const scene::Pose& pose) const {
  const auto points = scene::blended_positions(assembly, scene::frame_weights(scene, assembly, pose),
                                               scene::frame_matrices(scene, assembly, pose));
  std::vector<glm::vec3> texels;
  for (const glm::uvec4& source : atlas.texel_map) {
    if (source.w == 0) {
      texels.emplace_back(0);
      continue;
    }
    const glm::uvec4 triangle = assembly.triangles[source.x];
    const float b1 = std::bit_cast<float>(source.y), b2 = std::bit_cast<float>(source.z);
    texels.push_back(layout::flush_tiny3(points[triangle.x] * (1.0f - b1 - b2) + points[triangle.y] * b1 +
                                         points[triangle.z] * b2));
  }
  return texels;
}

std::optional<std::string> data_file(const std::string& name) {
  const char* folder = std::getenv("LODESTONE_DATA");
  const std::filesystem::path base = folder != nullptr ? folder : LODESTONE_SOURCE_DIR "/../shared/data";
  const std::filesystem::path path = base / name;
  if (!std::filesystem::exists(path)) return {};
  return path.string();
}

QuadTriangles quad_triangles(const geometry_image::Atlas& atlas) {
  QuadTriangles result;
  for (const glm::uvec2& leaf : atlas.leaf_map) {
    if (leaf.x == layout::empty_slot) continue;
    const uint32_t a = leaf.x, b = a + 1, c = a + leaf.y, d = c + 1;
    result.texels.emplace_back(a, b, c);
    result.texels.emplace_back(d, c, b);
    result.primitives.push_back(2 * a);
    result.primitives.push_back(2 * a + 1);
  }
  return result;
}

}  // namespace lodestone::test
