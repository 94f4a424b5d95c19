// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/shape_metrics.h"

#include <algorithm>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/scene/pose.h"

namespace lodestone::geometry_image {

using base_complex::TriangleShape;

namespace {

double half_sum_of_squares(const TriangleShape& shape) {  // of the edges
  return shape.e11 + shape.e22 - shape.e12;
}

}  // namespace

ShapeMetrics::ShapeMetrics(const scene::Scene& scene, const scene::Assembly& assembly)
    : largest_(assembly.triangles.size()) {
  constexpr uint64_t triangles_a_task = 1u << 13;
  const scene::Pose rest = scene::evaluate(scene, scene::none, 0);
  const std::vector<glm::vec4> matrices = scene::frame_matrices(scene, assembly, rest);
  const auto include = [&](const std::vector<float>& weights) {
    const std::vector<glm::vec3> at = scene::blended_positions(assembly, weights, matrices);
    parallel_for(largest_.size(), triangles_a_task, [&](uint64_t begin, uint64_t end) {
      for (uint64_t t = begin; t < end; ++t) {
        const glm::uvec4& v = assembly.triangles[t];
        const TriangleShape shape = base_complex::shape_of(at[v.x], at[v.y], at[v.z]);
        if (half_sum_of_squares(shape) > half_sum_of_squares(largest_[t])) largest_[t] = shape;
      }
    });
  };
  include(scene::frame_weights(scene, assembly, rest));
  rest_ = largest_;
  for (uint32_t w = 0; w < assembly.weight_count; ++w) {
    std::vector<float> alone(assembly.weight_count, 0.0f);
    alone[w] = 1;
    include(alone);
  }
}

std::vector<TriangleShape> ShapeMetrics::of_cell(const base_complex::BaseComplex& complex,
                                                 const std::vector<uint32_t>& triangles,
                                                 uint32_t cell) const {
  std::vector<TriangleShape> shapes;
  for (const uint32_t face : complex.cells[cell].faces)
    shapes.push_back(of_face(complex.mesh, triangles, face));
  return shapes;
}

TriangleShape ShapeMetrics::of_face(const base_complex::HalfEdgeMesh& mesh,
                                    const std::vector<uint32_t>& triangles, uint32_t face) const {
  const uint32_t triangle = triangles[mesh.triangle(face)];
  const TriangleShape &a = rest_[triangle], &b = largest_[triangle];
  const TriangleShape whole = {0.5 * (a.e11 + b.e11), 0.5 * (a.e12 + b.e12), 0.5 * (a.e22 + b.e22),
                               std::max(a.area, b.area)};
  // The piece's edges in terms of those of the whole triangle.
  const glm::dvec3 b0 = mesh.barycentrics(3 * face);
  const glm::dvec3 d1 = mesh.barycentrics(3 * face + 1) - b0, d2 = mesh.barycentrics(3 * face + 2) - b0;
  const auto product = [&](const glm::dvec3& p, const glm::dvec3& q) {
    return p.y * q.y * whole.e11 + (p.y * q.z + p.z * q.y) * whole.e12 + p.z * q.z * whole.e22;
  };
  return {product(d1, d1), product(d1, d2), product(d2, d2),
          whole.area * std::abs(d1.y * d2.z - d1.z * d2.y)};
}

}  // namespace lodestone::geometry_image
