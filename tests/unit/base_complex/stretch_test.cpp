// SPDX-License-Identifier: MIT
#include "lodestone/base_complex/stretch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <random>

namespace lodestone::base_complex {
namespace {

class Random {
 public:
  explicit Random(uint32_t seed) : random_(seed) {}
  double number() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  glm::dvec2 plane_point() {
    const double x = number();
    return {x, number()};
  }
  // Counterclockwise and no needle.
  std::array<glm::dvec2, 3> triangle() {
    while (true) {
      const std::array<glm::dvec2, 3> t = {plane_point(), plane_point(), plane_point()};
      if (cross(t[1] - t[0], t[2] - t[0]) > 0.1) return t;
    }
  }
  glm::dmat3 rotation() {
    const double w = number(), x = number(), y = number();
    return glm::mat3_cast(glm::normalize(glm::dquat(w, x, y, number())));
  }

 private:
  std::mt19937 random_;
};

double stretch_of(const std::array<glm::dvec3, 3>& s, const std::array<glm::dvec2, 3>& t) {
  return squared_stretch(shape_of(s[0], s[1], s[2]), t[1] - t[0], t[2] - t[0]);
}

std::array<glm::dvec3, 3> lifted(const std::array<glm::dvec2, 3>& t, const glm::dmat3& by) {
  return {by * glm::dvec3(t[0], 0), by * glm::dvec3(t[1], 0), by * glm::dvec3(t[2], 0)};
}

TEST(Stretch, IsOneForIsometries) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const std::array<glm::dvec2, 3> t = random.triangle();
    EXPECT_NEAR(stretch_of(lifted(t, random.rotation()), t), 1, 1e-12);
  }
}

TEST(Stretch, ScalesWithTheSurfaceAndAgainstThePlane) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const std::array<glm::dvec2, 3> t = random.triangle();
    const double scale = std::exp(3 * random.number());
    const glm::dmat3 rotation = random.rotation();
    EXPECT_NEAR(stretch_of(lifted(t, scale * rotation), t) / (scale * scale), 1, 1e-12);
    const std::array<glm::dvec2, 3> large = {scale * t[0], scale * t[1], scale * t[2]};
    EXPECT_NEAR(stretch_of(lifted(t, rotation), large) * (scale * scale), 1, 1e-12);
  }
}

// The mean, over all directions of the plane, of the squared length of a unit vector on the surface.
TEST(Stretch, IsTheMeanOverAllDirections) {
  Random random(3);
  constexpr int directions = 64;
  for (int i = 0; i < 100; ++i) {
    glm::dmat3 any;
    for (glm::length_t c = 0; c < 3; ++c) any[c] = {random.number(), random.number(), random.number()};
    double mean = 0;
    for (int d = 0; d < directions; ++d) {
      const double angle = 2 * std::acos(-1.0) * d / directions;
      const glm::dvec3 on_surface = any * glm::dvec3(std::cos(angle), std::sin(angle), 0);
      mean += glm::dot(on_surface, on_surface) / directions;
    }
    const std::array<glm::dvec2, 3> t = random.triangle();
    EXPECT_NEAR(stretch_of(lifted(t, any), t), mean, 1e-10);
  }
}

TEST(Stretch, IsInfiniteWhereThePlaneTriangleHasNoArea) {
  EXPECT_EQ(squared_stretch(shape_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), {1, 1}, {2, 2}),
            std::numeric_limits<double>::infinity());
}

TEST(Stretch, OfATriangleIsTheSameWhicheverCornerIsFirst) {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const std::array<glm::dvec2, 3> t = random.triangle();
    glm::dvec3 s[3];
    for (glm::dvec3& p : s) p = {random.number(), random.number(), random.number()};
    const TriangleShape shape = shape_of(s[0], s[1], s[2]), turned = rotated(shape),
                        expected = shape_of(s[1], s[2], s[0]);
    EXPECT_NEAR(turned.e11, expected.e11, 1e-12);
    EXPECT_NEAR(turned.e12, expected.e12, 1e-12);
    EXPECT_NEAR(turned.e22, expected.e22, 1e-12);
    EXPECT_NEAR(turned.area, expected.area, 1e-12);
    const double stretch = squared_stretch(shape, t[1] - t[0], t[2] - t[0]);
    EXPECT_NEAR(squared_stretch(turned, t[2] - t[1], t[0] - t[1]) / stretch, 1, 1e-10);
    EXPECT_NEAR(squared_stretch(rotated(turned), t[0] - t[2], t[1] - t[2]) / stretch, 1, 1e-10);
    const TriangleShape whole_turn = rotated(rotated(turned));
    EXPECT_NEAR(whole_turn.e11, shape.e11, 1e-12);
    EXPECT_NEAR(whole_turn.e12, shape.e12, 1e-12);
    EXPECT_NEAR(whole_turn.e22, shape.e22, 1e-12);
  }
}

TEST(Stretch, EnergyHasTheSlopesThatDifferencesShow) {
  Random random(5);
  constexpr double step = 1e-4;
  for (int i = 0; i < 200; ++i) {
    const std::array<glm::dvec2, 3> t = random.triangle();
    glm::dvec3 s[3];
    for (glm::dvec3& p : s) p = {random.number(), random.number(), random.number()};
    const TriangleShape shape = shape_of(s[0], s[1], s[2]);
    const auto at = [&](double x, double y) {
      const glm::dvec2 corner = t[0] + glm::dvec2(x, y);
      StretchEnergy energy;
      add_energy(shape, t[1] - corner, t[2] - corner, energy);
      EXPECT_NEAR(energy.value, shape.area * squared_stretch(shape, t[1] - corner, t[2] - corner),
                  1e-10 * energy.value);
      return energy;
    };
    const StretchEnergy here = at(0, 0), right = at(step, 0), left = at(-step, 0), up = at(0, step),
                        down = at(0, -step);
    const double tolerance = 1e-4 * here.value / std::pow(cross(t[1] - t[0], t[2] - t[0]), 4);
    EXPECT_NEAR(here.gradient.x, (right.value - left.value) / (2 * step), tolerance);
    EXPECT_NEAR(here.gradient.y, (up.value - down.value) / (2 * step), tolerance);
    for (glm::length_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(here.hessian[0][k], (right.gradient[k] - left.gradient[k]) / (2 * step), 10 * tolerance);
      EXPECT_NEAR(here.hessian[1][k], (up.gradient[k] - down.gradient[k]) / (2 * step), 10 * tolerance);
    }
  }
}

TEST(Stretch, EnergiesAddUp) {
  const TriangleShape shape = shape_of({0, 0, 0}, {1, 0, 1}, {0, 1, 0});
  StretchEnergy one, two;
  add_energy(shape, {1, 0}, {0, 1}, one);
  add_energy(shape, {1, 0}, {0, 1}, two);
  add_energy(shape, {1, 0}, {0, 1}, two);
  EXPECT_DOUBLE_EQ(two.value, 2 * one.value);
  EXPECT_DOUBLE_EQ(two.gradient.x, 2 * one.gradient.x);
  EXPECT_DOUBLE_EQ(two.hessian[0][1], 2 * one.hessian[0][1]);
}

}  // namespace
}  // namespace lodestone::base_complex
