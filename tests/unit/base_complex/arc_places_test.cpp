// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/arc_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace lodestone::base_complex {
namespace {

// A complex of nothing but one arc, in the plane z = 0 where nothing else is said.
BaseComplex arc_along(const std::vector<glm::dvec3>& points, bool firm,
                      const std::vector<glm::dvec3>& normals = {}, double room = 1e9) {
  BaseComplex complex(HalfEdgeMesh(points, {}));
  Arc& arc = complex.arcs.emplace_back();
  for (uint32_t p = 0; p < points.size(); ++p) {
    arc.points.push_back(p);
    if (p > 0) arc.length += glm::distance(points[p - 1], points[p]);
  }
  arc.firm = firm;
  if (!firm) arc.room.assign(points.size(), room);
  complex.normals = normals.empty() ? std::vector<glm::dvec3>(points.size(), {0, 0, 1}) : normals;
  return complex;
}

std::vector<glm::dvec3> half_circle(uint32_t edges) {
  std::vector<glm::dvec3> points;
  for (uint32_t i = 0; i <= edges; ++i) {
    const double angle = std::acos(-1.0) * i / edges;
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  return points;
}

std::vector<glm::dvec3> random_walk(uint32_t seed, uint32_t edges) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> step(-1, 1);
  std::vector<glm::dvec3> points = {{0, 0, 0}};
  for (uint32_t i = 0; i < edges; ++i) {
    // Now and then no step at all.
    const double x = step(random), y = step(random), z = step(random);
    points.push_back(points.back() + (i % 7 == 3 ? 0.0 : 1.0) * glm::dvec3(1 + x, y, z));
  }
  return points;
}

TEST(ArcPlaces, AscendFromEndToEnd) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    for (const uint32_t edges : {1u, 2u, 3u, 20u, 300u}) {
      for (const bool firm : {false, true}) {
        const BaseComplex complex = arc_along(random_walk(seed, edges), firm);
        for (const uint32_t segments : {1u, 2u, 3u, 7u, 8u, 64u, 1024u}) {
          const std::vector<double> places = arc_places(complex, 0, segments);
          ASSERT_EQ(places.size(), segments + 1);
          EXPECT_EQ(places.front(), 0);
          EXPECT_NEAR(places.back(), complex.arcs[0].length, 1e-12 * complex.arcs[0].length);
          for (size_t i = 0; i + 1 < places.size(); ++i) EXPECT_LT(places[i], places[i + 1]);
        }
      }
    }
  }
}

TEST(ArcPlaces, OfAnArcThatIsNotFirmLeaveBendsWithinTheSurface) {
  const BaseComplex complex = arc_along({{0, 0, 0}, {1, 0, 0}, {1, 3, 0}}, false);
  const std::vector<double> places = arc_places(complex, 0, 8);
  for (size_t i = 0; i < places.size(); ++i) EXPECT_DOUBLE_EQ(places[i], 0.5 * double(i));
}

TEST(ArcPlaces, OfAnArcThatIsNotFirmStayOnTheSurface) {
  // A bend round something that is no part of the surface, 0.25 away: the chord leads through it.
  const std::vector<glm::dvec3> bend = {{0, 0, 0}, {1, 0.75, 0}, {2, 0, 0}};
  EXPECT_LT(arc_error(arc_along(bend, false), 0, 1), 1e-12);
  EXPECT_NEAR(arc_error(arc_along(bend, false, {}, 0.25), 0, 1), 0.5, 1e-12);
  EXPECT_LT(arc_error(arc_along(bend, false, {}, 0.25), 0, 2), 1e-12);
}

TEST(ArcPlaces, OfAnArcThatIsNotFirmHitClearBendsOfTheSurface) {
  const glm::dvec3 diagonal(std::sqrt(0.5), -std::sqrt(0.5), 0);
  const BaseComplex complex =
      arc_along({{0, 0, 0}, {1, 0, 0}, {1, 3, 0}}, false, {{0, -1, 0}, diagonal, {1, 0, 0}});
  for (const uint32_t segments : {2u, 3u, 5u, 9u}) {
    const std::vector<double> places = arc_places(complex, 0, segments);
    EXPECT_TRUE(
        std::any_of(places.begin(), places.end(), [](double at) { return std::abs(at - 1) < 1e-12; }));
    EXPECT_LT(arc_error(complex, 0, segments), 1e-12);
  }
  EXPECT_GT(arc_error(complex, 0, 1), 0.5);
}

TEST(ArcPlaces, HitTheCornersOfAFirmArc) {
  // Corners at 1, 2.5 and 4 of 7; the others are points on straight lines.
  const BaseComplex complex = arc_along(
      {{0, 0, 0}, {0.3, 0, 0}, {1, 0, 0}, {1, 0.7, 0}, {1, 1.5, 0}, {2.5, 1.5, 0}, {2.5, 1.5, 3}}, true);
  for (const uint32_t segments : {4u, 5u, 8u, 64u}) {
    const std::vector<double> places = arc_places(complex, 0, segments);
    for (const double corner : {1.0, 2.5, 4.0})
      EXPECT_TRUE(std::any_of(places.begin(), places.end(),
                              [&](double place) { return std::abs(place - corner) < 1e-12; }))
          << corner << " with " << segments;
    EXPECT_LT(arc_error(complex, 0, segments), 1e-12);
  }
  EXPECT_GT(arc_error(complex, 0, 3), 0.1) << "too few for all corners";
}

TEST(ArcPlaces, OfAStraightFirmArcAreEven) {
  const BaseComplex complex = arc_along({{0, 0, 0}, {0.1, 0, 0}, {3.9, 0, 0}, {4, 0, 0}}, true);
  const std::vector<double> places = arc_places(complex, 0, 8);
  for (size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(places[i], 0.5 * double(i), 1e-12);
}

TEST(ArcPlaces, ErrorFallsWithSegments) {
  for (const bool firm : {false, true}) {
    // On a cylinder, so that all of it is across the surface.
    const BaseComplex complex = arc_along(half_circle(256), firm, half_circle(256));
    double before = arc_error(complex, 0, 1);
    EXPECT_NEAR(before, 1, 1e-3);
    for (uint32_t segments = 2; segments <= 128; segments *= 2) {
      const double error = arc_error(complex, 0, segments);
      // A circle's falls with the square.
      EXPECT_LT(error, 0.45 * before) << segments;
      before = error;
    }
    const double sagitta = 1 - std::cos(std::acos(-1.0) / 16);
    EXPECT_NEAR(arc_error(complex, 0, 8), sagitta, (firm ? 0.5 : 0.01) * sagitta);
  }
}

TEST(ArcPlaces, ErrorIsHowFarThePolylineStrays) {
  const BaseComplex bent = arc_along({{0, 0, 0}, {1, 1, 0}, {2, 0, 0}}, true);
  EXPECT_DOUBLE_EQ(arc_error(bent, 0, 1), 1);
  EXPECT_LT(arc_error(bent, 0, 2), 1e-12);
  const BaseComplex within = arc_along({{0, 0, 0}, {1, 1, 0}, {2, 0, 0}}, false);
  EXPECT_EQ(arc_error(within, 0, 1), 0) << "along the surface nothing is lost";
}

TEST(ArcPlaces, AreThereOnAnArcOfNoLength) {
  for (const bool firm : {false, true}) {
    const BaseComplex complex = arc_along({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, firm);
    EXPECT_EQ(arc_places(complex, 0, 4), std::vector<double>(5, 0.0));
    EXPECT_EQ(arc_error(complex, 0, 4), 0);
  }
}

}  // namespace
}  // namespace lodestone::base_complex
