// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "lodestone/base/parallel.h"
#include "lodestone/layout/arithmetic.h"
#include "lodestone/scene/assembly.h"
#include "sample_scenes.h"

namespace lodestone::scene {
namespace {

using test::random_character;
using test::scene_of;
using test::strip;

struct Frame {
  std::vector<float> weights;
  std::vector<glm::vec4> matrices;
};

Frame rest_frame(const Scene& scene, const Assembly& assembly) {
  const Pose rest = evaluate(scene, none, 0);
  return {frame_weights(scene, assembly, rest), frame_matrices(scene, assembly, rest)};
}

std::vector<glm::vec3> blend(const Assembly& assembly, const Frame& frame) {
  return blended_positions(assembly, frame.weights, frame.matrices);
}

bool same_bits(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(glm::vec3)) == 0;
}

TEST(Blend, ChangesNothingAtTheIdentity) {
  const Scene scene = scene_of({strip(10)});
  const Assembly assembly = assemble(scene);
  EXPECT_EQ(blend(assembly, rest_frame(scene, assembly)), scene.meshes[0].positions);
}

TEST(Blend, AddsDeltasBeforeTheMatrixActs) {
  Mesh mesh = strip(3);
  mesh.targets.push_back({"up", {2}, {{0, 0, 8}}, {}, {}});
  mesh.weights = {0.5f};
  Scene scene = scene_of({mesh});
  scene.nodes[0].translation = {10, 20, 30};
  scene.nodes[0].scale = {1, 2, -3};  // mirrored
  const Assembly assembly = assemble(scene);
  const std::vector<glm::vec3> moved = blend(assembly, rest_frame(scene, assembly));
  EXPECT_EQ(moved[0], glm::vec3(10, 20.5f, 30));
  EXPECT_EQ(moved[1], glm::vec3(11, 22.5f, 33));
  EXPECT_EQ(moved[2], glm::vec3(12, 24.5f, 30 - 3 * (-2 + 4)));
  EXPECT_EQ(assembly.triangles[0], glm::uvec4(0, 1, 2, 0)) << "mirroring keeps the order of corners";
}

TEST(Blend, TurnsNormalsByTheInverseTransposed) {
  for (const uint32_t joints : {0u, 6u}) {
    Scene scene = random_character(50 + joints, 200, 5, joints);
    scene.nodes[0].scale = {1, 2, -3};  // mirrored; of no effect on a mesh with a skin
    const Assembly assembly = assemble(scene);
    const Frame frame = rest_frame(scene, assembly);
    const std::vector<glm::vec3> normals = blended_normals(assembly, frame.weights, frame.matrices);
    ASSERT_EQ(normals.size(), assembly.normals.size());
    for (uint32_t v = 0; v < normals.size(); ++v) {
      glm::dvec3 normal = assembly.normals[v];
      for (uint32_t i = assembly.first_morph[v]; i < assembly.first_morph[v + 1]; ++i)
        normal += double(frame.weights[assembly.morphs[i].weight]) * glm::dvec3(assembly.morphs[i].normal);
      glm::dmat3 transposed(0);
      for (uint32_t i = assembly.first_influence[v]; i < assembly.first_influence[v + 1]; ++i) {
        for (int r = 0; r < 3; ++r) {
          const glm::vec4& row = frame.matrices[3 * size_t(assembly.influences[i].matrix) + size_t(r)];
          transposed[r] += double(assembly.influences[i].weight) * glm::dvec3(row);
        }
      }
      const glm::dvec3 expected = glm::normalize(glm::inverse(transposed) * normal);
      EXPECT_LT(glm::length(expected - glm::dvec3(normals[v])), 1e-4) << v;
    }
  }
}

TEST(Blend, MatchesTheDefinitionInDoublePrecision) {
  for (const uint32_t joints : {0u, 6u}) {
    const Scene scene = random_character(10 + joints, 200, 5, joints);
    const Assembly assembly = assemble(scene);
    const std::vector<glm::vec3> moved = blend(assembly, rest_frame(scene, assembly));
    const Mesh& mesh = scene.meshes[0];
    const std::vector<glm::mat4> matrices = palette(scene, evaluate(scene, none, 0), 0);
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      glm::dvec3 p = mesh.positions[v];
      for (size_t t = 0; t < mesh.targets.size(); ++t) {
        for (size_t i = 0; i < mesh.targets[t].vertices.size(); ++i) {
          if (mesh.targets[t].vertices[i] == v)
            p += double(mesh.weights[t]) * glm::dvec3(mesh.targets[t].positions[i]);
        }
      }
      glm::dmat4 matrix(0);
      if (joints == 0) {
        matrix = glm::dmat4(matrices[0]);
      } else {
        for (uint32_t i = mesh.first_influence[v]; i < mesh.first_influence[v + 1]; ++i) {
          matrix += double(mesh.influences[i].weight) * glm::dmat4(matrices[mesh.influences[i].joint]);
        }
      }
      const glm::dvec3 expected = glm::dvec3(matrix * glm::dvec4(p, 1));
      // Positions and matrices are of the order of ten; a few dozen roundings.
      EXPECT_LT(glm::length(expected - glm::dvec3(moved[v])), 1e-4) << v;
    }
  }
}

// The order of operations that the pass `blend` has, written out in scalars.
TEST(Blend, RoundsAsThePassDoes) {
  const Scene scene = random_character(20, 500, 9, 7);
  const Assembly assembly = assemble(scene);
  const Frame frame = rest_frame(scene, assembly);
  std::vector<glm::vec3> expected;
  for (uint32_t v = 0; v < assembly.positions.size(); ++v) {
    float p[3] = {assembly.positions[v].x, assembly.positions[v].y, assembly.positions[v].z};
    for (uint32_t i = assembly.first_morph[v]; i < assembly.first_morph[v + 1]; ++i) {
      const MorphEntry& entry = assembly.morphs[i];
      for (int axis = 0; axis < 3; ++axis) {
        const float step = frame.weights[entry.weight] * entry.position[axis];
        p[axis] = p[axis] + step;
      }
    }
    float m[3][4] = {};
    for (uint32_t i = assembly.first_influence[v]; i < assembly.first_influence[v + 1]; ++i) {
      const MatrixInfluence& influence = assembly.influences[i];
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
          const float share = influence.weight * frame.matrices[3 * influence.matrix + uint32_t(row)][column];
          m[row][column] = m[row][column] + share;
        }
      }
    }
    glm::vec3 moved;
    for (int row = 0; row < 3; ++row) {
      const float x = m[row][0] * p[0], y = m[row][1] * p[1], z = m[row][2] * p[2];
      const float xy = x + y;
      const float xyz = xy + z;
      moved[row] = layout::flush_tiny(xyz + m[row][3]);
    }
    expected.push_back(moved);
  }
  EXPECT_TRUE(same_bits(blend(assembly, frame), expected));
}

TEST(Blend, GivesTheSameBitsForAnyNumberOfThreads) {
  const Scene scene = random_character(30, 40000, 3, 4);
  const Assembly assembly = assemble(scene);
  const Frame frame = rest_frame(scene, assembly);
  set_thread_count(1);
  const std::vector<glm::vec3> alone = blend(assembly, frame);
  const Assembly assembled_alone = assemble(scene);
  for (const uint32_t threads : {2u, 0u}) {
    set_thread_count(threads);
    EXPECT_TRUE(same_bits(blend(assembly, frame), alone));
    const Assembly again = assemble(scene);
    EXPECT_EQ(again.triangles, assembled_alone.triangles);
    EXPECT_TRUE(same_bits(again.positions, assembled_alone.positions));
  }
  set_thread_count(0);
}

TEST(Blend, StoresMatricesRowByRow) {
  Scene scene = scene_of({strip(3), strip(3)});
  glm::mat4 matrix;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) matrix[column][row] = row < 3 ? float(10 * row + column + 1) : 0.0f;
  }
  matrix[3][3] = 1;
  matrix[0][2] = 1e-40f;
  scene.nodes[1].matrix = matrix;
  const Assembly assembly = assemble(scene);
  const std::vector<glm::vec4> rows = rest_frame(scene, assembly).matrices;
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[3], glm::vec4(1, 2, 3, 4));
  EXPECT_EQ(rows[4], glm::vec4(11, 12, 13, 14));
  EXPECT_EQ(rows[5], glm::vec4(0, 22, 23, 24)) << "tiny numbers are flushed";
}

TEST(Blend, RefusesArraysOfAnotherScene) {
  const Scene scene = random_character(40, 10, 2, 3);
  const Assembly assembly = assemble(scene);
  Frame frame = rest_frame(scene, assembly);
  frame.weights.pop_back();
  EXPECT_THROW(blend(assembly, frame), std::invalid_argument);
  frame = rest_frame(scene, assembly);
  frame.matrices.emplace_back();
  EXPECT_THROW(blend(assembly, frame), std::invalid_argument);
  Pose pose = evaluate(scene, none, 0);
  pose.weights[0].clear();
  EXPECT_THROW(frame_weights(scene, assembly, pose), std::invalid_argument);
}

}  // namespace
}  // namespace lodestone::scene
