// SPDX-License-Identifier: MIT
// What changes by the frame, and the reference of the pass `blend`.
#include <algorithm>
#include <stdexcept>
#include <string>

#include "lodestone/base/parallel.h"
#include "lodestone/layout/arithmetic.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::scene {
namespace {

struct Rows {
  glm::vec4 r0{0}, r1{0}, r2{0};
};

glm::vec3 morphed(const Assembly& assembly, const std::vector<float>& weights, uint32_t vertex,
                  const std::vector<glm::vec3>& base, glm::vec3 MorphEntry::*delta) {
  glm::vec3 sum = base[vertex];
  for (uint32_t i = assembly.first_morph[vertex]; i < assembly.first_morph[vertex + 1]; ++i) {
    const MorphEntry& entry = assembly.morphs[i];
    sum = sum + weights[entry.weight] * entry.*delta;
  }
  return sum;
}

Rows blended_matrix(const Assembly& assembly, const std::vector<glm::vec4>& matrices, uint32_t vertex) {
  Rows sum;
  for (uint32_t i = assembly.first_influence[vertex]; i < assembly.first_influence[vertex + 1]; ++i) {
    const MatrixInfluence& influence = assembly.influences[i];
    const glm::vec4* row = &matrices[3 * size_t(influence.matrix)];
    sum.r0 = sum.r0 + influence.weight * row[0];
    sum.r1 = sum.r1 + influence.weight * row[1];
    sum.r2 = sum.r2 + influence.weight * row[2];
  }
  return sum;
}

float transformed(const glm::vec4& row, const glm::vec3& p) {
  return row.x * p.x + row.y * p.y + row.z * p.z + row.w;
}

// By the cofactor matrix, which needs no inverse; its sign is that of the determinant.
glm::vec3 turned(const Rows& m, const glm::vec3& normal) {
  const glm::vec3 r0(m.r0), r1(m.r1), r2(m.r2);
  const glm::vec3 c0 = layout::cross3(r1, r2), c1 = layout::cross3(r2, r0), c2 = layout::cross3(r0, r1);
  glm::vec3 sum{layout::dot3(c0, normal), layout::dot3(c1, normal), layout::dot3(c2, normal)};
  if (layout::dot3(r0, c0) < 0.0f) sum = sum * -1.0f;
  return layout::normalize_or(sum, glm::vec3(0, 0, 1));
}

void check_size(size_t have, size_t need, const char* what) {
  if (have != need) throw std::invalid_argument(std::string(what) + " are not those of this assembly");
}

// What `blend` makes of each vertex.
template <class Blend>
std::vector<glm::vec3> for_each_vertex(const Assembly& assembly, const std::vector<float>& weights,
                                       const std::vector<glm::vec4>& matrices, Blend blend) {
  check_size(weights.size(), assembly.weight_count, "the morph weights");
  check_size(matrices.size(), 3 * size_t(assembly.matrix_count), "the matrices");
  constexpr uint64_t grain = 1u << 13;
  std::vector<glm::vec3> blended(assembly.positions.size());
  parallel_for(blended.size(), grain, [&](uint64_t begin, uint64_t end) {
    for (auto v = static_cast<uint32_t>(begin); v < end; ++v) blended[v] = blend(v);
  });
  return blended;
}

}  // namespace

std::vector<float> frame_weights(const Scene& scene, const Assembly& assembly, const Pose& pose) {
  std::vector<float> weights(assembly.weight_count, 0.0f);
  for (const Placement& placement : assembly.placements) {
    const std::vector<float>& given = pose.weights[placement.node];
    check_size(given.size(), scene.meshes[placement.mesh].targets.size(), "the morph weights of a pose");
    std::transform(given.begin(), given.end(), weights.begin() + placement.first_weight, layout::flush_tiny);
  }
  return weights;
}

std::vector<glm::vec4> frame_matrices(const Scene& scene, const Assembly& assembly, const Pose& pose) {
  std::vector<glm::vec4> rows(3 * size_t(assembly.matrix_count));
  for (size_t i = 0; i < assembly.placements.size(); ++i) {
    const uint32_t first = assembly.placements[i].first_matrix;
    const bool last = i + 1 == assembly.placements.size();
    const uint32_t end = last ? assembly.matrix_count : assembly.placements[i + 1].first_matrix;
    const std::vector<glm::mat4> matrices = assembly.placements[i].rigid != 0
                                                ? std::vector<glm::mat4>{glm::mat4(1)}
                                                : palette(scene, pose, assembly.placements[i].node);
    check_size(matrices.size(), end - first, "the matrices of a pose");
    for (uint32_t m = 0; m < matrices.size(); ++m) {
      for (int r = 0; r < 3; ++r) {
        const glm::mat4& matrix = matrices[m];
        glm::vec4& row = rows[3 * size_t(first + m) + size_t(r)];
        for (int column = 0; column < 4; ++column) row[column] = layout::flush_tiny(matrix[column][r]);
      }
    }
  }
  return rows;
}

std::vector<glm::mat4> frame_instances(const Assembly& assembly, const Pose& pose) {
  std::vector<glm::mat4> matrices;
  for (const Instance& instance : assembly.instances)
    matrices.push_back(instance.node == none ? glm::mat4(1) : pose.node_world[instance.node]);
  return matrices;
}

std::vector<glm::vec3> blended_positions(const Assembly& assembly, const std::vector<float>& weights,
                                         const std::vector<glm::vec4>& matrices) {
  return for_each_vertex(assembly, weights, matrices, [&](uint32_t v) {
    const glm::vec3 p = morphed(assembly, weights, v, assembly.positions, &MorphEntry::position);
    const Rows m = blended_matrix(assembly, matrices, v);
    return layout::flush_tiny3({transformed(m.r0, p), transformed(m.r1, p), transformed(m.r2, p)});
  });
}

std::vector<glm::vec3> rest_positions(const Scene& scene, const Assembly& assembly) {
  const Pose rest = evaluate(scene, none, 0);
  return blended_positions(assembly, frame_weights(scene, assembly, rest),
                           frame_matrices(scene, assembly, rest));
}

std::vector<glm::vec3> placed_positions(const Scene& scene, const Assembly& assembly, const Pose& pose) {
  std::vector<glm::vec3> positions = blended_positions(assembly, frame_weights(scene, assembly, pose),
                                                       frame_matrices(scene, assembly, pose));
  for (const Object& object : assembly.objects) {
    if (!object.rigid) continue;
    const glm::mat4& matrix = pose.node_world[assembly.placements[object.first_placement].node];
    for (uint32_t v = object.first_vertex; v < object.first_vertex + object.vertices; ++v)
      positions[v] = glm::vec3(matrix * glm::vec4(positions[v], 1));
  }
  return positions;
}

std::vector<glm::vec3> blended_normals(const Assembly& assembly, const std::vector<float>& weights,
                                       const std::vector<glm::vec4>& matrices) {
  return for_each_vertex(assembly, weights, matrices, [&](uint32_t v) {
    return turned(blended_matrix(assembly, matrices, v),
                  morphed(assembly, weights, v, assembly.normals, &MorphEntry::normal));
  });
}

}  // namespace lodestone::scene
