// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/half_edge_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "surfaces.h"

namespace lodestone::base_complex {
namespace {

using test::Surface;

using Edge = std::pair<uint32_t, uint32_t>;
Edge ends_of(const HalfEdgeMesh& mesh, uint32_t h) {
  return std::minmax({mesh.from(h), mesh.to(h)});
}

// All half-edges of the ring, ascending. Cut off where it does not close.
std::vector<uint32_t> ring_of(const HalfEdgeMesh& mesh, uint32_t h) {
  std::vector<uint32_t> ring = {h};
  while (ring.size() <= 3 * size_t(mesh.faces()) && mesh.next_on_edge(ring.back()) != h)
    ring.push_back(mesh.next_on_edge(ring.back()));
  std::sort(ring.begin(), ring.end());
  return ring;
}

// Twins, rings, names and barriers are what the corners of all faces say.
void expect_sound(const HalfEdgeMesh& mesh, bool two_edges_may_have_the_same_points = false) {
  std::map<Edge, std::vector<uint32_t>> by_points;
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h) by_points[ends_of(mesh, h)].push_back(h);
  std::set<uint32_t> names;
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h) {
    ASSERT_NE(mesh.from(h), mesh.to(h));
    const std::vector<uint32_t> ring = ring_of(mesh, h);
    const std::vector<uint32_t>& all = by_points.at(ends_of(mesh, h));
    ASSERT_TRUE(std::includes(all.begin(), all.end(), ring.begin(), ring.end()));
    ASSERT_TRUE(two_edges_may_have_the_same_points || ring == all);
    ASSERT_TRUE(std::binary_search(ring.begin(), ring.end(), mesh.edge_name(h)));
    for (const uint32_t other : ring) {
      ASSERT_EQ(mesh.edge_name(other), mesh.edge_name(h));
      ASSERT_EQ(mesh.is_barrier(other), mesh.is_barrier(h));
    }
    if (ring.size() == 2 && mesh.from(ring[0]) == mesh.to(ring[1])) {
      ASSERT_EQ(mesh.twin(h), ring[0] + ring[1] - h);
    } else {
      ASSERT_EQ(mesh.twin(h), none);
      ASSERT_TRUE(mesh.is_barrier(h));
    }
  }
}

int64_t euler_characteristic(const HalfEdgeMesh& mesh) {
  std::set<uint32_t> points, edges;
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h) {
    points.insert(mesh.from(h));
    edges.insert(mesh.edge_name(h));
  }
  return int64_t(points.size()) - int64_t(edges.size()) + mesh.faces();
}

// The faces tile their triangles, whose corners are as they were, and every point is where each face that has
// it says it lies on its triangle.
void expect_tiles(const HalfEdgeMesh& mesh, const Surface& input) {
  std::vector<double> area(input.triangles.size(), 0);
  for (uint32_t f = 0; f < mesh.faces(); ++f) {
    const glm::uvec3& t = input.triangles.at(mesh.triangle(f));
    glm::dmat3 corners;
    for (glm::length_t k = 0; k < 3; ++k) corners[k] = input.positions[t[k]];
    const glm::dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    EXPECT_GE(glm::dot(across, mesh.normal(f)), 0) << "a face that has turned over";
    area[mesh.triangle(f)] += mesh.area(f);
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
      const glm::dvec3 at = mesh.barycentrics(h);
      EXPECT_NEAR(at.x + at.y + at.z, 1, 1e-14);
      EXPECT_LT(glm::distance(corners * at, mesh.position(mesh.from(h))), 1e-13);
    }
  }
  const HalfEdgeMesh original = input.mesh();
  for (uint32_t f = 0; f < original.faces(); ++f) EXPECT_NEAR(area[f], original.area(f), 1e-12);
}

// A point on an edge of the input has an exact 0 in all triangles that share the edge.
void expect_exact_zeros(const HalfEdgeMesh& mesh) {
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h) {
    const uint32_t twin = mesh.twin(h);
    if (twin != none && mesh.triangle(face_of(twin)) == mesh.triangle(face_of(h))) continue;
    const glm::dvec3 a = mesh.barycentrics(h), b = mesh.barycentrics(next(h));
    EXPECT_TRUE((a.x == 0 && b.x == 0) || (a.y == 0 && b.y == 0) || (a.z == 0 && b.z == 0));
  }
}

TEST(HalfEdgeMesh, TwinsAreWhereTwoFacesRunInOppositeDirections) {
  const HalfEdgeMesh mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                          std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(mesh.twin(2), 3u);
  EXPECT_EQ(mesh.twin(3), 2u);
  for (const uint32_t h : {0u, 1u, 4u, 5u}) EXPECT_EQ(mesh.twin(h), none);
  EXPECT_FALSE(mesh.is_barrier(2));
  EXPECT_EQ(mesh.from(5), 3u);
  EXPECT_EQ(mesh.to(5), 0u);
  EXPECT_EQ(mesh.edge_name(3), mesh.edge_name(2));
}

TEST(HalfEdgeMesh, FacesOfOppositeOrientationAreNeighboursOverNoTwin) {
  const HalfEdgeMesh mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                          std::vector<glm::uvec3>{{0, 1, 2}, {0, 3, 2}});
  EXPECT_EQ(mesh.twin(2), none);
  EXPECT_EQ(mesh.twin(5), none);
  EXPECT_EQ(mesh.next_on_edge(2), 5u);
  EXPECT_EQ(mesh.next_on_edge(5), 2u);
  EXPECT_TRUE(mesh.is_barrier(5));
}

TEST(HalfEdgeMesh, MoreThanTwoFacesAtAnEdgeHaveNoTwins) {
  for (const uint32_t count : {3u, 4u}) {
    const HalfEdgeMesh mesh = test::sheets(count).mesh();
    std::set<uint32_t> ring;
    for (uint32_t h = 0; ring.insert(h).second; h = mesh.next_on_edge(h)) EXPECT_EQ(mesh.twin(h), none);
    EXPECT_EQ(ring.size(), count);
  }
}

TEST(HalfEdgeMesh, IsSoundForAllSamples) {
  for (const test::Sample& sample : test::all_samples()) {
    SCOPED_TRACE(sample.name);
    expect_sound(sample.mesh);
  }
}

TEST(HalfEdgeMesh, ABarrierIsOneOnBothSides) {
  HalfEdgeMesh mesh = test::plane(2, 2).mesh();
  uint32_t inner = 0;
  while (mesh.twin(inner) == none) ++inner;
  mesh.make_barrier(inner);
  EXPECT_TRUE(mesh.is_barrier(inner));
  EXPECT_TRUE(mesh.is_barrier(mesh.twin(inner)));
  expect_sound(mesh);
  EXPECT_NE(mesh.twin(inner), none) << "the surface goes on there";
}

TEST(HalfEdgeMesh, ASplitMakesTwoFacesOfEachOneAsPromised) {
  HalfEdgeMesh mesh = test::plane(1, 1).mesh();
  const uint32_t diagonal = 2;  // from 3 to 0
  ASSERT_NE(mesh.twin(diagonal), none);
  const uint32_t u = mesh.from(diagonal), v = mesh.to(diagonal), w = mesh.to(next(diagonal));
  std::vector<HalfEdgeMesh::Halves> halves;
  const uint32_t point = mesh.split_edge(diagonal, 0.25, &halves);
  EXPECT_LT(glm::distance(mesh.position(point), 0.75 * mesh.position(u) + 0.25 * mesh.position(v)), 1e-15);
  ASSERT_EQ(halves.size(), 2u);
  EXPECT_EQ(halves[0].face, 0u);
  EXPECT_EQ(mesh.faces(), 4u);
  EXPECT_EQ(mesh.from(diagonal), u);
  EXPECT_EQ(mesh.to(diagonal), point);
  EXPECT_EQ(mesh.to(next(diagonal)), w);
  EXPECT_EQ(mesh.corners(halves[0].taken), (std::array<uint32_t, 3>{point, v, w}));
  expect_sound(mesh);
}

TEST(HalfEdgeMesh, SplitsKeepTopologyAreasAndPlaces) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> fraction(0.05, 0.95);
  const std::vector<Surface> inputs = {
      test::single_triangle(), test::pillow(),    test::tetrahedron(),  test::plane(3, 2),
      test::moebius(5, 1),     test::torus(3, 3), test::sheets(2),      test::sheets(3),
      test::sheets(4),         test::sheets(7),   test::soup(1, 8, 30), test::touching_spheres(4)};
  // Each of its faces gets an edge from the new point to the third corner that both have.
  constexpr size_t pillow = 1;
  for (size_t i = 0; i < inputs.size(); ++i) {
    SCOPED_TRACE(i);
    HalfEdgeMesh mesh = inputs[i].mesh();
    const int64_t euler = euler_characteristic(mesh);
    for (int splits = 0; splits < 60; ++splits) {
      const auto h = static_cast<uint32_t>(random() % (3 * mesh.faces()));
      uint32_t beside = 1;
      for (uint32_t other = mesh.next_on_edge(h); other != h; other = mesh.next_on_edge(other)) ++beside;
      const uint32_t faces = mesh.faces(), points = mesh.points();
      std::vector<HalfEdgeMesh::Halves> halves;
      EXPECT_EQ(mesh.split_edge(h, fraction(random), &halves), points);
      EXPECT_EQ(mesh.faces(), faces + beside);
      EXPECT_EQ(mesh.points(), points + 1);
      EXPECT_EQ(halves.size(), beside);
      for (const HalfEdgeMesh::Halves& half : halves)
        EXPECT_EQ(mesh.triangle(half.taken), mesh.triangle(half.face));
      expect_sound(mesh, i == pillow);
      if (HasFatalFailure()) return;
      EXPECT_EQ(euler_characteristic(mesh), euler);
    }
    expect_tiles(mesh, inputs[i]);
    expect_exact_zeros(mesh);
  }
}

TEST(HalfEdgeMesh, HalvesOfABarrierAreBarriersAndNothingElseBecomesOne) {
  HalfEdgeMesh mesh = test::plane(3, 3).mesh();
  const auto is_line = [](const glm::dvec3& a, const glm::dvec3& b) { return a.x == 1 && b.x == 1; };
  test::add_barriers(mesh, is_line);
  std::mt19937 random(6);
  for (int splits = 0; splits < 80; ++splits) {
    mesh.split_edge(static_cast<uint32_t>(random() % (3 * mesh.faces())), 0.5);
    for (uint32_t h = 0; h < 3 * mesh.faces(); ++h) {
      const bool expected =
          mesh.twin(h) == none || is_line(mesh.position(mesh.from(h)), mesh.position(mesh.to(h)));
      ASSERT_EQ(mesh.is_barrier(h), expected);
    }
  }
}

TEST(HalfEdgeMesh, SplittingWhatIsLongEndsAndLeavesNothingLonger) {
  for (const Surface& input : {test::single_triangle(), test::plane(3, 2), test::sheets(3), test::sheets(8),
                               test::moebius(5, 1), test::torus(5, 4), test::soup(2, 9, 40)}) {
    for (const double longest : {10.0, 1.0, 0.3, 0.1}) {
      HalfEdgeMesh mesh = input.mesh();
      const int64_t euler = euler_characteristic(mesh);
      mesh.split_longer_than(longest);
      double found = 0;
      for (uint32_t h = 0; h < 3 * mesh.faces(); ++h) found = std::max(found, mesh.length(h));
      EXPECT_LE(found, longest);
      expect_sound(mesh);
      EXPECT_EQ(euler_characteristic(mesh), euler);
      expect_tiles(mesh, input);
    }
  }
}

TEST(HalfEdgeMesh, WhatIsShortStaysAsItIs) {
  const Surface input = test::sphere(6);
  HalfEdgeMesh mesh = input.mesh();
  mesh.split_longer_than(3);
  EXPECT_EQ(mesh.faces(), input.triangles.size());
  EXPECT_EQ(mesh.points(), input.positions.size());
}

TEST(HalfEdgeMesh, SplittingGivesTheSameEveryTime) {
  const auto split = [] {
    HalfEdgeMesh mesh = test::soup(3, 20, 60).mesh();
    mesh.split_longer_than(0.2);
    return mesh;
  };
  const HalfEdgeMesh first = split(), second = split();
  ASSERT_EQ(first.faces(), second.faces());
  for (uint32_t h = 0; h < 3 * first.faces(); ++h) {
    EXPECT_EQ(first.position(first.from(h)), second.position(second.from(h)));
    EXPECT_EQ(first.next_on_edge(h), second.next_on_edge(h));
  }
}

TEST(HalfEdgeMesh, MeasuresFaces) {
  const HalfEdgeMesh mesh({{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {1, 0, 0}},
                          std::vector<glm::uvec3>{{0, 1, 2}, {0, 1, 3}});
  EXPECT_DOUBLE_EQ(mesh.area(0), 3);
  EXPECT_EQ(mesh.normal(0), glm::dvec3(0, 0, 1));
  EXPECT_LT(glm::distance(mesh.centroid(0), glm::dvec3(2.0 / 3, 1, 0)), 1e-15);
  EXPECT_EQ(mesh.area(1), 0);
  EXPECT_EQ(mesh.normal(1), glm::dvec3(0));
  EXPECT_DOUBLE_EQ(mesh.length(0), 2);
}

}  // namespace
}  // namespace lodestone::base_complex
