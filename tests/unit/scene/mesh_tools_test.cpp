// SPDX-License-Identifier: MIT
#include "lodestone/scene/mesh_tools.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lodestone::scene {
namespace {

void expect_near(const glm::vec3& a, const glm::vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-6);
  EXPECT_NEAR(a.y, b.y, 1e-6);
  EXPECT_NEAR(a.z, b.z, 1e-6);
}

TEST(SmoothNormals, AreWeightedByArea) {
  // Around vertex 0: a triangle of area 1/2 facing +z, and one of area 3/2 facing +x.
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 3}};
  const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<glm::vec3> normals = smooth_normals(positions, triangles);
  expect_near(normals[0], glm::normalize(glm::vec3(3, 0, 1)));
  expect_near(normals[1], {0, 0, 1});
  expect_near(normals[3], {1, 0, 0});
}

TEST(SmoothNormals, TreatEqualPositionsAsOneVertex) {
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<glm::vec3> normals =
      smooth_normals(positions, std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}});
  expect_near(normals[0], glm::normalize(glm::vec3(1, 0, 1)));
  EXPECT_EQ(normals[0], normals[3]);
  EXPECT_EQ(normals[2], normals[4]);
}

TEST(SmoothNormals, PositiveAndNegativeZeroAreTheSamePlace) {
  const std::vector<glm::vec3> positions = {{0, 0, 0},         {1, 0, 0}, {0, 1, 0},
                                            {-0.0f, 0, -0.0f}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<glm::vec3> normals =
      smooth_normals(positions, std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}});
  EXPECT_EQ(normals[0], normals[3]);
}

TEST(SmoothNormals, AreUnitEvenForTinyHugeAndDegenerateTriangles) {
  for (float size : {1e-30f, 1.0f, 1e30f}) {
    const std::vector<glm::vec3> positions = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}};
    for (const glm::vec3& n : smooth_normals(positions, std::vector<glm::uvec3>{{0, 1, 2}}))
      expect_near(n, {0, 0, 1});
  }
  const std::vector<glm::vec3> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  for (const glm::vec3& n : smooth_normals(line, std::vector<glm::uvec3>{{0, 1, 2}}))
    EXPECT_EQ(n, glm::vec3(0, 0, 1));
  EXPECT_TRUE(smooth_normals({}, {}).empty());
}

TEST(CompleteNormals, ScalesGivenOnesAndReplacesZeros) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals = {{0, 5, 0}, {0, 0, 0}, {1e30f, 0, 0}};
  complete_normals(mesh);
  expect_near(mesh.normals[0], {0, 1, 0});
  expect_near(mesh.normals[1], {0, 0, 1});
  expect_near(mesh.normals[2], {1, 0, 0});
}

}  // namespace
}  // namespace lodestone::scene
