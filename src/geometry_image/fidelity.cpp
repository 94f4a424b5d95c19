// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/fidelity.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lodestone/geometry_image/texel_values.h"
#include "lodestone/mesh/distance.h"

namespace lodestone::geometry_image {
namespace {

struct Triangles {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> corners;
};

// The texels and the two triangles of each quad.
Triangles image_surface(const scene::Assembly& assembly, const std::vector<glm::vec3>& positions,
                        const Atlas& atlas) {
  Triangles surface;
  surface.positions = at_texels(assembly, atlas.texel_map, positions);
  for (const glm::uvec2& leaf : atlas.leaf_map) {
    if (leaf.x == layout::empty_slot) continue;
    const uint32_t a = leaf.x, b = a + 1, c = a + leaf.y, d = c + 1;
    surface.corners.emplace_back(a, b, c);
    surface.corners.emplace_back(d, c, b);
  }
  return surface;
}

bool is_finite(const Triangles& surface) {
  return std::all_of(surface.positions.begin(), surface.positions.end(), [](const glm::vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  });
}

}  // namespace

std::optional<Fidelity> measure_fidelity(const scene::Scene& scene, const scene::Assembly& assembly,
                                         const Atlas& atlas, const scene::Pose& pose) {
  if (atlas.report.mapped_charts == 0) return std::nullopt;
  Triangles input;
  input.positions = scene::placed_positions(scene, assembly, pose);
  if (!is_finite(input)) return std::nullopt;
  for (const glm::uvec4& t : assembly.triangles) input.corners.emplace_back(t.x, t.y, t.z);
  const Triangles image = image_surface(assembly, input.positions, atlas);
  const mesh::SymmetricDistance distance =
      mesh::symmetric({input.positions, input.corners}, {image.positions, image.corners});
  Fidelity fidelity;
  fidelity.diagonal = mesh::diagonal({input.positions, input.corners});
  const double scale = fidelity.diagonal > 0 ? 1 / fidelity.diagonal : 0;
  fidelity.from_input = distance.forth.maximum * scale;
  fidelity.from_image = distance.back.maximum * scale;
  fidelity.mean = distance.forth.mean * scale;
  fidelity.root_mean_square = distance.forth.root_mean_square * scale;
  return fidelity;
}

}  // namespace lodestone::geometry_image
