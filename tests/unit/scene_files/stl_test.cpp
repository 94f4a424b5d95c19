// SPDX-License-Identifier: MIT
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "scene_files.h"

namespace lodestone::scene::test {
namespace {

using Triangles = std::vector<std::array<glm::vec3, 3>>;

std::string binary(const Triangles& triangles, std::string header = "") {
  header.resize(80);
  const auto append = [&header](const auto& value) {
    header.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  append(static_cast<uint32_t>(triangles.size()));
  for (const auto& triangle : triangles) {
    append(glm::vec3(9));  // a wrong normal: it is not to be believed
    for (const glm::vec3& corner : triangle) append(corner);
    append(uint16_t(0xffff));
  }
  return header;
}

std::string ascii(const Triangles& triangles, const std::string& name = "") {
  std::string text = fmt::format("solid {}\n", name);
  for (const auto& triangle : triangles) {
    text += "facet normal nan -nan(ind) 1.#IND\n outer loop\n";
    for (const glm::vec3& c : triangle) text += fmt::format("  vertex {} {} {}\n", c.x, c.y, c.z);
    text += " endloop\nendfacet\n";
  }
  return text + fmt::format("endsolid {}\n", name);
}

const Triangles tetrahedron{{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}},
                            {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
                            {{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
                            {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};

// An upright prism over a regular polygon of radius 1, closed, its caps fans around their first corner.
Triangles prism(int sides) {
  const auto corner = [sides](int i, float z) {
    const double angle = 2 * std::numbers::pi * (i % sides) / sides;
    return glm::vec3(std::cos(angle), std::sin(angle), z);
  };
  Triangles triangles;
  for (int i = 0; i < sides; ++i) {
    triangles.push_back({corner(i, 0), corner(i + 1, 0), corner(i + 1, 1)});
    triangles.push_back({corner(i, 0), corner(i + 1, 1), corner(i, 1)});
  }
  for (int i = 1; i + 1 < sides; ++i) {
    triangles.push_back({corner(0, 1), corner(i, 1), corner(i + 1, 1)});
    triangles.push_back({corner(0, 0), corner(i + 1, 0), corner(i, 0)});
  }
  return triangles;
}

class Stl : public testing::Test {
 protected:
  Mesh load(const std::string& bytes) const { return load_mesh(folder_.write("model.stl", bytes)); }

  // The mesh has to consist of these triangles, corner by corner.
  void expect_triangles(const Mesh& mesh, const Triangles& triangles) const {
    ASSERT_EQ(mesh.triangles.size(), triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(mesh.positions[mesh.triangles[t][c]], triangles[t][static_cast<size_t>(c)]);
      }
    }
  }

  TemporaryFolder folder_;
};

TEST_F(Stl, BothEncodingsGiveTheSameMesh) {
  const Mesh from_binary = load(binary(prism(12))), from_ascii = load(ascii(prism(12)));
  expect_triangles(from_binary, prism(12));
  EXPECT_EQ(from_binary.positions, from_ascii.positions);
  EXPECT_EQ(from_binary.normals, from_ascii.normals);
  EXPECT_EQ(from_binary.triangles, from_ascii.triangles);
  EXPECT_EQ(from_binary.name, "model");
}

TEST_F(Stl, ABinaryFileMayBeginWithSolid) {
  expect_triangles(load(binary(tetrahedron, "solid made by a program that knows no better")), tetrahedron);
  expect_triangles(load(binary(tetrahedron, "solid x\nfacet normal")), tetrahedron);
}

TEST_F(Stl, BytesBehindABinaryFileAreLeftOut) {
  expect_triangles(load(binary(tetrahedron, "solid trailing") + "trailing"), tetrahedron);
}

TEST_F(Stl, AnAsciiFileMayHoldSeveralSolidsInAnyCase) {
  std::string upper = ascii(tetrahedron, "two words");
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  Triangles twice = tetrahedron;
  twice.insert(twice.end(), tetrahedron.begin(), tetrahedron.end());
  expect_triangles(load(fmt::format("\n{}\r\n{}", ascii(tetrahedron), upper)), twice);
}

TEST_F(Stl, SharpEdgesDivideVertices) {
  const Mesh mesh = load(binary(tetrahedron));
  EXPECT_EQ(mesh.positions.size(), 12u) << "all edges of a tetrahedron are sharp";
  EXPECT_TRUE(near(mesh.normals[mesh.triangles[0].x], {0, 0, -1}));
  EXPECT_TRUE(near(mesh.normals[mesh.triangles[3].x], glm::vec3(1 / std::sqrt(3.0f))));
}

// The sides of the prism meet at 30 degrees: round. Its caps stay flat. The side's normals point away from
// the axis exactly, however the sides are cut into triangles: the weight is the angle, not the area.
TEST_F(Stl, ShallowEdgesAreRound) {
  const Mesh mesh = load(binary(prism(12)));
  EXPECT_EQ(mesh.positions.size(), 12u * 4);
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::vec3 &p = mesh.positions[v], &n = mesh.normals[v];
    const glm::vec3 cap(0, 0, p.z == 1 ? 1 : -1);
    EXPECT_TRUE(near(n, std::abs(n.z) > 0.5f ? cap : glm::vec3(p.x, p.y, 0)));
  }
}

// Two triangles on the X axis at the given angle, in degrees.
Triangles hinge(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const glm::vec3 wing(0, std::cos(angle), std::sin(angle));
  return {{{{0, 0, 0}, {1, 0, 0}, wing}}, {{{1, 0, 0}, {0, 0, 0}, {0, -1, 0}}}};
}

TEST_F(Stl, TheCreaseAngleIsFortyDegrees) {
  EXPECT_EQ(load(binary(hinge(39.9))).positions.size(), 4u);
  EXPECT_EQ(load(binary(hinge(40.1))).positions.size(), 6u);
}

TEST_F(Stl, AHexagonalNutHasFlatSides) {
  const Mesh mesh = load(binary(prism(6)));
  EXPECT_EQ(mesh.positions.size(), 6u * 4 + 6u * 2);
}

TEST_F(Stl, VerticesAreNumberedByFirstUse) {
  const Mesh mesh = load(binary(prism(12)));
  uint32_t next = 0;
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      ASSERT_LE(triangle[c], next);
      if (triangle[c] == next) ++next;
    }
  }
  EXPECT_EQ(next, mesh.positions.size());
}

TEST_F(Stl, BothZerosAreOnePosition) {
  const Triangles flat{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{1, 0, -0.0f}, {1, 1, 0}, {-0.0f, 1, 0}}}};
  const Mesh mesh = load(binary(flat));
  EXPECT_EQ(mesh.positions.size(), 4u);
  for (const glm::vec3& p : mesh.positions) EXPECT_FALSE(std::signbit(p.x) || std::signbit(p.z));
}

TEST_F(Stl, TrianglesWithoutAnAreaStayAndAddNoVertices) {
  Triangles with_sliver = prism(12);
  const glm::vec3 a = with_sliver[0][0], b = with_sliver[0][1];
  with_sliver.insert(with_sliver.begin(), {a, b, a});
  with_sliver.insert(with_sliver.begin(), {a, a, a});
  const Mesh mesh = load(binary(with_sliver));
  expect_triangles(mesh, with_sliver);
  EXPECT_EQ(mesh.positions.size(), 12u * 4);
}

TEST_F(Stl, NothingButTrianglesWithoutAnAreaIsStillAMesh) {
  const Mesh mesh = load(binary({{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}}));
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.positions.size(), 3u);
}

TEST_F(Stl, TrianglesThatFaceOppositeWaysAreNotSmoothed) {
  const Triangles flipped{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}};
  const Mesh mesh = load(binary(flipped));
  EXPECT_EQ(mesh.positions.size(), 6u);
  EXPECT_TRUE(near(mesh.normals[0], {0, 0, 1}));
  EXPECT_TRUE(near(mesh.normals[3], {0, 0, -1}));
}

// Three sheets on one edge: which two would belong together, nobody can say.
TEST_F(Stl, EdgesOfThreeTrianglesAreSharp) {
  const Triangles book{{{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}}},
                       {{{0, 1, 0}, {0, 0, 0}, {1, 0, 0.1f}}},
                       {{{0, 1, 0}, {0, 0, 0}, {1, 0, -0.1f}}}};
  EXPECT_EQ(load(binary(book)).positions.size(), 9u);
}

}  // namespace
}  // namespace lodestone::scene::test
