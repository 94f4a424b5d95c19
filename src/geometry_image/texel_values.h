// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

// What vertices have (their positions, say), at each texel as the `rasterise` pass computes it; 0 where there
// is no texel.
inline std::vector<glm::vec3> at_texels(const scene::Assembly& assembly,
                                        const std::vector<glm::uvec4>& texel_map,
                                        const std::vector<glm::vec3>& of_vertices) {
  constexpr uint64_t texels_a_task = 1u << 14;
  std::vector<glm::vec3> values(texel_map.size(), glm::vec3(0));
  parallel_for(values.size(), texels_a_task, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const glm::uvec4& texel = texel_map[i];
      if (texel.w == 0) continue;
      const glm::uvec4& t = assembly.triangles[texel.x];
      const float b1 = std::bit_cast<float>(texel.y), b2 = std::bit_cast<float>(texel.z);
      values[i] = of_vertices[t.x] * (1.0f - b1 - b2) + of_vertices[t.y] * b1 + of_vertices[t.z] * b2;
    }
  });
  return values;
}

}  // namespace lodestone::geometry_image
