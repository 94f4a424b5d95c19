// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/outline.h"

#include <cmath>

namespace lodestone::base_complex {
namespace {

// The angle between two edges of a face at the start of a half-edge.
double corner_angle(const HalfEdgeMesh& mesh, uint32_t half_edge) {
  const glm::dvec3 here = mesh.position(mesh.from(half_edge));
  const glm::dvec3 a = mesh.position(mesh.to(half_edge)) - here;
  const glm::dvec3 b = mesh.position(mesh.from(previous(half_edge))) - here;
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

std::vector<double> boundary_angles(const HalfEdgeMesh& mesh, const std::vector<uint32_t>& cell_of_face,
                                    const std::vector<uint32_t>& boundary) {
  std::vector<double> angles;
  for (const uint32_t start : boundary) {
    const uint32_t cell = cell_of_face[face_of(start)];
    double angle = corner_angle(mesh, start);
    for (uint32_t twin = mesh.twin(previous(start)); twin != none && cell_of_face[face_of(twin)] == cell;
         twin = mesh.twin(previous(twin)))
      angle += corner_angle(mesh, twin);
    angles.push_back(angle);
  }
  return angles;
}

}  // namespace lodestone::base_complex
