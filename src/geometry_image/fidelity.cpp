// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/fidelity.h"

#include <limits>
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
  surface.positions = at_texels(assembly, atlas, positions);
  for (const glm::uvec2& leaf : atlas.leaf_map) {
    if (leaf.x == layout::empty_slot) continue;
    const uint32_t a = leaf.x, b = a + 1, c = a + leaf.y, d = c + 1;
    surface.corners.emplace_back(a, b, c);
    surface.corners.emplace_back(d, c, b);
  }
  return surface;
}

double diagonal_of(const Triangles& surface) {
  glm::dvec3 lo(std::numeric_limits<double>::infinity()), hi = -lo;
  for (const glm::uvec3& t : surface.corners) {
    for (glm::length_t k = 0; k < 3; ++k) {
      lo = glm::min(lo, glm::dvec3(surface.positions[t[k]]));
      hi = glm::max(hi, glm::dvec3(surface.positions[t[k]]));
    }
  }
  return surface.corners.empty() ? 0.0 : glm::distance(lo, hi);
}

}  // namespace

Fidelity measure_fidelity(const scene::Scene& scene, const scene::Assembly& assembly, const Atlas& atlas,
                          const scene::Pose& pose) {
  Triangles input;
  input.positions = scene::blended_positions(assembly, scene::frame_weights(scene, assembly, pose),
                                             scene::frame_matrices(scene, assembly, pose));
  for (const glm::uvec4& t : assembly.triangles) input.corners.emplace_back(t.x, t.y, t.z);
  const Triangles image = image_surface(assembly, input.positions, atlas);
  const mesh::SymmetricDistance distance =
      mesh::symmetric({input.positions, input.corners}, {image.positions, image.corners});
  Fidelity fidelity;
  fidelity.diagonal = diagonal_of(input);
  const double scale = fidelity.diagonal > 0 ? 1 / fidelity.diagonal : 0;
  fidelity.from_input = distance.forth.maximum * scale;
  fidelity.from_image = distance.back.maximum * scale;
  fidelity.mean = distance.forth.mean * scale;
  fidelity.root_mean_square = distance.forth.root_mean_square * scale;
  return fidelity;
}

}  // namespace lodestone::geometry_image
