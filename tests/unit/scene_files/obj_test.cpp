// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include "scene_files.h"

namespace lodestone::scene::test {
namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

class Obj : public testing::Test {
 protected:
  Mesh load(const std::string& text) const { return load_mesh(folder_.write("model.obj", text)); }

 private:
  TemporaryFolder folder_;
};

TEST_F(Obj, BecomesOneMeshNamedAfterTheFile) {
  const Mesh mesh = load("o first\n" + square + "f 1 2 3\no second\ng group\nf 1 3 4\n");
  EXPECT_EQ(mesh.name, "model");
  EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
  ASSERT_EQ(mesh.parts.size(), 1u);
  EXPECT_EQ(mesh.parts[0].triangle_count, 2u);
  EXPECT_EQ(mesh.parts[0].material, none);
  EXPECT_TRUE(mesh.texcoords[0].empty());
}

TEST_F(Obj, ColoursBehindPositionsAreDecoded) {
  const Mesh mesh = load("v 0 0 0 1 0 0.5\nv 1 0 0 0 1 0 # green\nv 0 1 0 1\nv 1 1 0\nf 1 2 3\nf 3 2 4\n");
  ASSERT_EQ(mesh.colors.size(), 4u);
  EXPECT_EQ(mesh.colors[1], glm::vec4(0, 1, 0, 1));
  EXPECT_NEAR(mesh.colors[0].b, 0.2140411f, 1e-6) << "sRGB";
  EXPECT_EQ(mesh.colors[2], glm::vec4(1)) << "a weight is no colour";
  EXPECT_EQ(mesh.colors[3], glm::vec4(1));
  EXPECT_TRUE(load(square + "f 1 2 3\n").colors.empty());
}

TEST_F(Obj, PolygonsBecomeFansAroundTheirFirstCorner) {
  const Mesh mesh = load("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv -1 1 0\nf 1 2 3 4 5\nf 5 4 1\n");
  EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {4, 3, 0}}));
}

TEST_F(Obj, VerticesAreNumberedByFirstUse) {
  const Mesh mesh = load(square + "vt 0 0\nvt 1 0\nf 3/1 1/1 2/1\nf 3/1 2/2 1/1\n");
  ASSERT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.positions[0], glm::vec3(1, 1, 0));
  EXPECT_EQ(mesh.positions[1], glm::vec3(0, 0, 0));
  EXPECT_EQ(mesh.positions[2], glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.positions[3], glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 3, 1}}));
}

TEST_F(Obj, VerticesThatNoFaceUsesAreLeftOut) {
  const Mesh mesh = load("v 9 9 9\n" + square + "f 2 3 4\n");
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
}

TEST_F(Obj, NegativeIndicesCountBackFromTheLastSoFar) {
  const Mesh mesh = load("v 5 0 0\nv 6 0 0\nv 6 1 0\nf -3 -2 -1\nv 7 0 0\nf -3 -1 -2\n");
  EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(mesh.positions[3], glm::vec3(7, 0, 0));
}

TEST_F(Obj, PositiveIndicesMayLookAhead) {
  EXPECT_EQ(load("f 1 2 3\n" + square).positions[2], glm::vec3(1, 1, 0));
}

TEST_F(Obj, TextureCoordinatesAreTurnedOver) {
  const Mesh mesh = load(square + "vt 0.25 0.75\nvt 0.5\nf 1/1 2/2 3\n");
  EXPECT_EQ(mesh.texcoords[0], (std::vector<glm::vec2>{{0.25f, 0.25f}, {0.5f, 1.0f}, {0.0f, 0.0f}}));
}

TEST_F(Obj, GivenNormalsAreScaledToUnitLength) {
  const Mesh mesh = load(square + "vn 0 3 4\nf 1//1 2//1 3//1\n");
  for (const glm::vec3& normal : mesh.normals) EXPECT_TRUE(near(normal, {0, 0.6f, 0.8f}));
}

// Two squares that meet at a right angle in the Y axis, one twice as large; their border has its own texture
// coordinates on either side.
TEST_F(Obj, MissingNormalsAreSmoothAcrossSeamsAndWeightedByArea) {
  const Mesh mesh = load(
      "v 0 0 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 0 0 1\nv 0 1 1\nvt 0 0\nvt 1 1\n"
      "f 1/1 3/1 4/1 2/1\nf 1/2 2/2 6/2 5/2\n");
  ASSERT_EQ(mesh.positions.size(), 8u);
  // The fan of the first square has both triangles at its first corner, one at its last; the second, the
  // other way round, one at its second corner. So both halves of the border see the areas 2 : 4 and 1 : 2.
  const glm::vec3 at_origin = glm::normalize(glm::vec3(2, 0, 4)), at_end = glm::normalize(glm::vec3(1, 0, 2));
  for (size_t v = 0; v < 8; ++v) {
    const glm::vec3& p = mesh.positions[v];
    const glm::vec3 on_axis = p.y == 0 ? at_origin : at_end;
    const glm::vec3 expected = p.x == 2 ? glm::vec3(0, 0, 1) : p.z == 1 ? glm::vec3(1, 0, 0) : on_axis;
    EXPECT_TRUE(near(mesh.normals[v], expected)) << v;
  }
}

TEST_F(Obj, CornersWithoutANormalGetTheSmoothOne) {
  const Mesh mesh = load(square + "vn 1 0 0\nf 1//1 2//1 3//1\nf 1 3 4\n");
  ASSERT_EQ(mesh.normals.size(), 6u);
  for (size_t v = 0; v < 3; ++v) EXPECT_TRUE(near(mesh.normals[v], {1, 0, 0}));
  for (size_t v = 3; v < 6; ++v) EXPECT_TRUE(near(mesh.normals[v], {0, 0, 1}));
}

TEST_F(Obj, NumbersLinesAndCommentsMayBeWrittenInManyWays) {
  const Mesh mesh = load(
      "\xef\xbb\xbfv +1e0 -.5 1.\r\n\tv\t2 0 0 # why\r\nv 0 1E+1 1e-50\r\n\r\nf 1 \\\r\n 2 3 # x\r\n"
      "# f 9 9 9\r\nf 1 2 3 # end");
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{1, -0.5f, 1}, {2, 0, 0}, {0, 10, 0}}));
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST_F(Obj, LinesEndedByCarriageReturnsAloneAreRead) {
  EXPECT_EQ(load("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r").triangles.size(), 1u);
}

TEST_F(Obj, OnlyFacesAreRead) {
  const Mesh mesh = load(square + "l 1 2 3\np 1\nf 1 2\nvp 0.5\ncurv 0 1 1 2\nf 1 2 3\n");
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.positions.size(), 3u);
}

}  // namespace
}  // namespace lodestone::scene::test
