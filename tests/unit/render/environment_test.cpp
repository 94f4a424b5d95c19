// SPDX-License-Identifier: MIT
// Radiance and density of environments, and that the directions chosen have that density.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/test_support/environment_probe.h"
#include "lodestone/test_support/environments.h"

namespace lodestone::test {
namespace {

constexpr double pi = std::numbers::pi;

// In [0, 1)^2, 24 bits each.
glm::vec2 random_pair(std::mt19937& random) {
  const auto number = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
  const float x = number();
  return {x, number()};
}

glm::vec3 random_direction(std::mt19937& random) {
  const glm::vec2 xi = random_pair(random);
  const double y = 1 - 2 * double(xi.y), radius = std::sqrt(1 - y * y), around = 2 * pi * double(xi.x);
  return glm::dvec3(radius * std::cos(around), y, radius * std::sin(around));
}

double luminance(const glm::vec3& c) {
  return 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z);
}

// Cells lie between the centres of texels.
struct Cell {
  double u, v;         // of a point inside
  double solid_angle;  // in steradians
};
Cell cell_of(const scene::Environment& environment, uint32_t column, uint32_t row) {
  const double top = std::max(row - 0.5, 0.0) / environment.height,
               bottom = std::min((row + 0.5) / environment.height, 1.0);
  return {(column + 1.0) / environment.width, (top + bottom) / 2,
          2 * pi / environment.width * (std::cos(pi * top) - std::cos(pi * bottom))};
}

scene::Scene sky_scene(const scene::Sky& sky) {
  scene::Scene scene;
  scene.sky = sky;
  return scene;
}

std::vector<scene::Scene> scenes() {
  scene::Environment turned = sunny_environment(64, 32, 2), one_texel = even_environment(64, 32, {0, 0, 0});
  turned.rotation = 73;
  one_texel.radiance[5 * 64 + 63] = {0, 2, 0};
  std::vector<scene::Scene> all;
  for (const auto& [width, height] :
       {std::pair(64u, 32u), std::pair(7u, 5u), std::pair(1u, 1u), std::pair(33u, 2u)})
    all.push_back(scene_in(sunny_environment(width, height, std::min({width, height, 2u}))));
  all.push_back(scene_in(turned));
  all.push_back(scene_in(one_texel));
  all.push_back(scene_in(even_environment(48, 24, {1, 1, 1})));
  all.push_back(scene_in(even_environment(48, 24, {0, 0, 0})));
  all.push_back(sky_scene({{1, 2, 3}, {0.5f, 0.5f, 0.5f}, {0, 0, 0}}));
  all.push_back(sky_scene({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
  all.emplace_back();  // lit by the renderer itself
  return all;
}

TEST(Environment, RunsFromMinusXByMinusZPlusXAndPlusZ) {
  scene::Environment four = even_environment(4, 2, {0, 0, 0});
  // The centres of the columns are between the axes.
  for (uint32_t x = 0; x < 4; ++x) four.radiance[x] = four.radiance[4 + x] = glm::vec3(float(x), 0, 0);
  EnvironmentProbe probe(scene_in(four));
  EXPECT_FLOAT_EQ(probe.environment_radiance({-1, 0, -1}).x, 0);
  EXPECT_FLOAT_EQ(probe.environment_radiance({1, 0, -1}).x, 1);
  EXPECT_FLOAT_EQ(probe.environment_radiance({1, 0, 1}).x, 2);
  EXPECT_FLOAT_EQ(probe.environment_radiance({-1, 0, 1}).x, 3);
  EXPECT_FLOAT_EQ(probe.environment_radiance({0, 0, -1}).x, 0.5f);
  EXPECT_FLOAT_EQ(probe.environment_radiance({1, 0, 0}).x, 1.5f);
  EXPECT_FLOAT_EQ(probe.environment_radiance({0, 0, 1}).x, 2.5f);
  EXPECT_FLOAT_EQ(probe.environment_radiance({-1, 0, 0}).x, 1.5f);  // between the last and the first
}

TEST(Environment, HasItsUpperRowAboveAndMeansAtThePoles) {
  scene::Environment rows = even_environment(4, 2, {0, 0, 0});
  for (uint32_t x = 0; x < 4; ++x) rows.radiance[x] = {float(x), 5, 0};
  EnvironmentProbe probe(scene_in(rows));
  EXPECT_FLOAT_EQ(probe.environment_radiance({0, 1, 0}).y, 5);
  EXPECT_FLOAT_EQ(probe.environment_radiance({0, -1, 0}).y, 0);
  EXPECT_FLOAT_EQ(probe.environment_radiance({0.3f, 0, 0.4f}).y, 2.5f);
  EXPECT_FLOAT_EQ(probe.environment_radiance({0, 0, 0}).y, 5);
}

TEST(Environment, IsBilinearBetweenTheCentresOfTexels) {
  const scene::Environment map = sunny_environment(64, 32, 2);
  EnvironmentProbe probe(scene_in(map));
  for (uint32_t y = 0; y < map.height; ++y) {
    for (uint32_t x = 0; x < map.width; ++x) {
      const glm::vec3 texel = map.radiance[size_t(y) * map.width + x];
      const glm::vec3 found =
          probe.environment_radiance(direction_at((x + 0.5) / map.width, (y + 0.5) / map.height));
      // A direction is off by 2e-7 turns or so, which is 1e-5 of a texel; the sun is 6000.
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[c], texel[c], 0.12f) << x << " " << y;
      if (y + 1 == map.height) continue;
      const glm::vec3 below = map.radiance[size_t(y + 1) * map.width + x];
      const glm::vec3 between =
          probe.environment_radiance(direction_at((x + 0.5) / map.width, (y + 1.0) / map.height));
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(between[c], (texel[c] + below[c]) / 2, 0.12f) << x << " " << y;
    }
  }
}

TEST(Environment, TurnsAboutTheYAxisFromPlusXTowardsMinusZ) {
  scene::Environment map = sunny_environment(64, 32, 2);
  EnvironmentProbe still(scene_in(map));
  for (const float degrees : {90.0f, -270.0f, 450.0f}) {
    map.rotation = degrees;
    EnvironmentProbe turned(scene_in(map));
    std::mt19937 random(1);
    for (int i = 0; i < 100; ++i) {
      const glm::vec3 d = random_direction(random), from(-d.z, d.y, d.x);
      ASSERT_NEAR(turned.environment_radiance(d).z, still.environment_radiance(from).z, 0.12f);
      ASSERT_NEAR(turned.environment_pdf(d), still.environment_pdf(from), 1e-5f);
    }
  }
  map.rotation = 90;
  const glm::vec3 centre = still.environment_radiance({1, 0, 0}),
                  behind = EnvironmentProbe(scene_in(map)).environment_radiance({0, 0, -1});
  EXPECT_NEAR(centre.x, behind.x, 1e-3f);
}

TEST(Environment, IsAsStrongAsAsked) {
  scene::Environment map = sunny_environment(16, 8);
  EnvironmentProbe once(scene_in(map));
  map.strength = 4;
  EnvironmentProbe four(scene_in(map));
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 d = random_direction(random);
    ASSERT_EQ(four.environment_radiance(d), once.environment_radiance(d) * 4.0f);
    ASSERT_EQ(four.environment_pdf(d), once.environment_pdf(d));
  }
}

TEST(Environment, OfTheSkyIsTheSky) {
  const scene::Sky sky{{1, 2, 3}, {0.5f, 0.5f, 0.5f}, {0, 0.25f, 0}};
  EnvironmentProbe probe(sky_scene(sky));
  EXPECT_EQ(probe.environment_radiance({0, 1, 0}), sky.top);
  EXPECT_EQ(probe.environment_radiance({0, -1, 0}), sky.bottom);
  EXPECT_EQ(probe.environment_radiance({1, 0, 0}), sky.horizon);
}

TEST(EnvironmentDensity, IntegratesToOne) {
  for (const scene::Scene& scene : scenes()) {
    EnvironmentProbe probe(scene);
    scene::Environment size;
    size.width = probe.frames[0].environment.width;
    size.height = probe.frames[0].environment.height;
    const double turn = double(probe.frames[0].environment.turn) - 0.5;
    double sum = 0;
    for (uint32_t row = 0; row <= size.height; ++row) {
      for (uint32_t column = 0; column < size.width; ++column) {
        const Cell cell = cell_of(size, column, row);
        sum += double(probe.environment_pdf(direction_at(cell.u - turn, cell.v))) * cell.solid_angle;
      }
    }
    EXPECT_NEAR(sum, 1, 1e-6) << scene.name << " " << size.width << " x " << size.height;
  }
}

TEST(EnvironmentDensity, FollowsTheMeanLuminanceOfTheFourTexelsAround) {
  const scene::Environment map = sunny_environment(64, 32, 2);
  EnvironmentProbe probe(scene_in(map));
  const auto light = [&](uint32_t x, int y) {
    const auto row = static_cast<uint32_t>(std::clamp(y, 0, int(map.height) - 1));
    return luminance(map.radiance[size_t(row) * map.width + x % map.width]);
  };
  const auto mean = [&](uint32_t x, int row) {
    return (light(x, row - 1) + light(x + 1, row - 1) + light(x, row) + light(x + 1, row)) / 4;
  };
  double total = 0;
  for (uint32_t row = 0; row <= map.height; ++row) {
    for (uint32_t x = 0; x < map.width; ++x) total += mean(x, int(row)) * cell_of(map, x, row).solid_angle;
  }
  for (uint32_t row = 0; row <= map.height; ++row) {
    for (uint32_t x = 0; x < map.width; ++x) {
      const Cell cell = cell_of(map, x, row);
      const double expected = mean(x, int(row)) / total;
      // Off by a number of 2^24 in the row, and one in the column of which the row has its share.
      const double step = 3.0 / 16777216 / cell.solid_angle;
      ASSERT_NEAR(double(probe.environment_pdf(direction_at(cell.u, cell.v))), expected,
                  2e-4 * expected + step)
          << x << " " << row;
    }
  }
}

TEST(EnvironmentDensity, IsZeroJustWhereAllIsBlack) {
  for (const scene::Scene& scene : scenes()) {
    if (!scene.environment) continue;
    EnvironmentProbe probe(scene);
    const bool black = std::all_of(scene.environment->radiance.begin(), scene.environment->radiance.end(),
                                   [](const glm::vec3& c) { return c == glm::vec3(0); });
    std::mt19937 random(3);
    for (int i = 0; i < 100000; ++i) {
      const glm::vec3 d = random_direction(random);
      const bool lit = luminance(probe.environment_radiance(d)) > 0;
      ASSERT_EQ(probe.environment_pdf(d) > 0, lit || black) << d.x << " " << d.y << " " << d.z;
    }
  }
}

TEST(EnvironmentDensity, OfBlackIsEven) {
  for (const scene::Scene& scene : {scene_in(even_environment(48, 24, {0, 0, 0})), sky_scene({})}) {
    EnvironmentProbe probe(scene);
    std::mt19937 random(4);
    for (int i = 0; i < 1000; ++i)
      ASSERT_NEAR(probe.environment_pdf(random_direction(random)), 1 / (4 * pi), 1e-4 / (4 * pi));
  }
}

TEST(EnvironmentSamples, HaveUnitLengthAndTheDensityOfTheirDirection) {
  for (const scene::Scene& scene : scenes()) {
    EnvironmentProbe probe(scene);
    std::mt19937 random(5);
    constexpr int count = 100000;
    int other = 0;
    for (int i = 0; i < count; ++i) {
      const auto sample = probe.sample_environment(random_pair(random));
      ASSERT_NEAR(glm::length(sample.direction), 1, 1e-6f);
      ASSERT_GT(sample.pdf, 0);
      if (probe.environment_pdf(sample.direction) == sample.pdf) continue;
      ++other;
      // Only at the border of a cell.
      const auto place = probe.environment_place(sample.direction);
      const auto from_border = [](float x) { return std::min(x, 1 - x); };
      ASSERT_LT(
          std::min(from_border(place.right), from_border(place.lower)),
          4e-7f * float(std::max(probe.frames[0].environment.width, probe.frames[0].environment.height)));
    }
    EXPECT_LT(other, count / 1000) << scene.name;
  }
}

TEST(EnvironmentSamples, OfTheExtremesOfXiAreDirectionsToo) {
  for (const scene::Scene& scene : scenes()) {
    EnvironmentProbe probe(scene);
    for (const float x : {0.0f, 5.9604645e-8f, 0.5f, 0.99999994f}) {
      for (const float y : {0.0f, 5.9604645e-8f, 0.5f, 0.99999994f}) {
        const auto sample = probe.sample_environment({x, y});
        EXPECT_NEAR(glm::length(sample.direction), 1, 1e-6f) << x << " " << y;
        EXPECT_GT(sample.pdf, 0);
        EXPECT_TRUE(std::isfinite(sample.pdf));
      }
    }
  }
}

// The solid angle that a small square of xi becomes is its area through the density.
TEST(EnvironmentSamples, SpreadXiByTheDensity) {
  for (const scene::Scene& scene :
       {scene_in(sunny_environment(12, 6)), scene_in(even_environment(8, 4, {1, 1, 1})),
        sky_scene({{1, 2, 3}, {0.5f, 0.5f, 0.5f}, {0.1f, 0, 0}})}) {
    EnvironmentProbe probe(scene);
    std::mt19937 random(6);
    constexpr float step = 1.0f / 4096;
    int measured = 0;
    for (int i = 0; i < 2000; ++i) {
      const glm::vec2 xi = glm::mix(glm::vec2(2 * step), glm::vec2(1 - 2 * step), random_pair(random));
      const auto at = [&](float x, float y) { return probe.sample_environment(xi + glm::vec2(x, y) * step); };
      const auto left = at(-1, 0), right = at(1, 0), up = at(0, -1), down = at(0, 1), here = at(0, 0);
      const bool one_cell = left.pdf == right.pdf && up.pdf == down.pdf && left.pdf == up.pdf;
      // Chords say what arcs are where these are short, and not around the poles, where rows become circles.
      const bool small = glm::distance(left.direction, right.direction) < 0.2f &&
                         glm::distance(up.direction, down.direction) < 0.2f &&
                         std::abs(here.direction.y) < 0.98f;
      if (!one_cell || !small) continue;
      ++measured;
      const glm::dvec3 across = glm::dvec3(right.direction) - glm::dvec3(left.direction),
                       along = glm::dvec3(down.direction) - glm::dvec3(up.direction);
      const double area = glm::length(glm::cross(across, along)) / (4.0 * double(step) * double(step));
      ASSERT_NEAR(area * double(here.pdf), 1, 0.01) << xi.x << " " << xi.y;
    }
    EXPECT_GT(measured, 500);
  }
}

// Pearson's test of a million independent samples, a bin a cell; cells of few samples are one bin.
TEST(EnvironmentSamples, HaveTheDensityByChiSquare) {
  const scene::Environment map = sunny_environment(64, 32, 1);
  EnvironmentProbe probe(scene_in(map));
  constexpr int count = 1000000;
  std::vector<int> found(size_t(map.width) * (map.height + 1));
  std::mt19937 random(7);
  int in_the_sun = 0;
  for (int i = 0; i < count; ++i) {
    const auto sample = probe.sample_environment(random_pair(random));
    const auto place = probe.environment_place(sample.direction);
    ++found[size_t(place.row) * map.width + place.column];
    in_the_sun += luminance(probe.environment_radiance(sample.direction)) > 10 ? 1 : 0;
  }
  EXPECT_GT(in_the_sun, count / 4);  // it is a two-thousandth of all directions
  double chi_square = 0, rest_expected = 0;
  int rest_found = 0, bins = 0;
  const auto add = [&](double expected, int seen) {
    chi_square += (seen - expected) * (seen - expected) / expected;
    ++bins;
  };
  for (uint32_t row = 0; row <= map.height; ++row) {
    for (uint32_t column = 0; column < map.width; ++column) {
      const Cell cell = cell_of(map, column, row);
      const double expected =
          count * double(probe.environment_pdf(direction_at(cell.u, cell.v))) * cell.solid_angle;
      const int seen = found[size_t(row) * map.width + column];
      if (expected >= 10) {
        add(expected, seen);
      } else {
        rest_expected += expected;
        rest_found += seen;
      }
    }
  }
  add(rest_expected, rest_found);
  EXPECT_GT(bins, 1000);
  // Mean and variance of the distribution: bins - 1 and twice that; beyond 4 deviations one time in 10,000.
  EXPECT_LT(chi_square, bins - 1 + 4 * std::sqrt(2.0 * (bins - 1)));
}

TEST(EnvironmentSamples, OfAWhiteMapSeeRadianceOne) {
  EnvironmentProbe probe(scene_in(even_environment(48, 24, {1, 1, 1})));
  std::mt19937 random(8);
  double sum = 0;
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i) {
    const auto sample = probe.sample_environment(random_pair(random));
    const glm::vec3 radiance = probe.environment_radiance(sample.direction);
    // Weights of bilinear look-ups add up to 1 but for their rounding.
    ASSERT_NEAR(radiance.x, 1, 3e-7f);
    sum += double(radiance.x / sample.pdf);
  }
  EXPECT_NEAR(sum / count / (4 * pi), 1, 1e-4);
}

// The mean of radiance by density is the light of all directions, and no sample is far brighter.
TEST(EnvironmentSamples, AddUpToTheLight) {
  const scene::Environment map = sunny_environment(64, 32, 1);
  EnvironmentProbe probe(scene_in(map));
  constexpr int across = 64 * 24, down = 32 * 24;
  double light = 0;
  for (int y = 0; y < down; ++y) {
    const double v = (y + 0.5) / down;
    for (int x = 0; x < across; ++x) {
      light += luminance(probe.environment_radiance(direction_at((x + 0.5) / across, v))) * std::sin(pi * v);
    }
  }
  light *= 2 * pi * pi / across / down;
  std::mt19937 random(9);
  constexpr int count = 1000000;
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const auto sample = probe.sample_environment(random_pair(random));
    const double value = luminance(probe.environment_radiance(sample.direction)) / double(sample.pdf);
    ASSERT_LT(value, 4.5 * light);  // a corner of four is all of a cell's light
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count, deviation = std::sqrt((squares / count - mean * mean) / count);
  EXPECT_NEAR(mean, light, 4 * deviation);
  EXPECT_LT(deviation, 0.001 * light);
}

TEST(EnvironmentTables, AreTheSameForAnyNumberOfThreads) {
  const scene::Scene scene = scene_in(sunny_environment(512, 256, 3));
  set_thread_count(1);
  const render::EnvironmentData one = render::make_environment(scene);
  set_thread_count(2);
  const render::EnvironmentData two = render::make_environment(scene);
  set_thread_count(0);
  EXPECT_EQ(one.quads, two.quads);
  EXPECT_EQ(one.cells, two.cells);
}

// Light so faint beside a sun that its share is less than a number.
TEST(EnvironmentTables, LeaveNothingThatHasLightWithoutANumber) {
  scene::Environment map = even_environment(256, 128, {1e-9f, 1e-9f, 1e-9f});
  map.radiance[40 * 256 + 50] = glm::vec3(1e6f);
  EnvironmentProbe probe(scene_in(map));
  for (uint32_t row = 0; row <= map.height; ++row) {
    for (uint32_t column = 0; column < map.width; ++column) {
      const Cell cell = cell_of(map, column, row);
      ASSERT_GT(probe.environment_pdf(direction_at(cell.u, cell.v)), 0) << column << " " << row;
    }
  }
}

TEST(Atan2Turns, IsTheAngle) {
  std::mt19937 random(10);
  double worst = 0;
  for (int i = 0; i < 1000000; ++i) {
    const auto number = [&] {
      const float x = static_cast<float>(random()) / 4294967296.0f * 2 - 1;
      return i % 2 == 0 ? x : std::ldexp(x, -static_cast<int>(random() % 40));
    };
    const float y = number(), x = number();
    const double expected = std::atan2(double(y), double(x)) / (2 * pi);
    worst = std::max(worst, std::abs(double(layout::atan2_turns(y, x)) - expected));
  }
  EXPECT_LT(worst, 1e-7);
}

TEST(Atan2Turns, IsExactAlongTheAxes) {
  EXPECT_EQ(layout::atan2_turns(0, 0), 0);
  EXPECT_EQ(layout::atan2_turns(0, 2), 0);
  EXPECT_EQ(layout::atan2_turns(3, 3), 0.125f);
  EXPECT_EQ(layout::atan2_turns(1, 0), 0.25f);
  EXPECT_EQ(layout::atan2_turns(-1, 0), -0.25f);
  EXPECT_EQ(layout::atan2_turns(0, -1), 0.5f);
  EXPECT_EQ(layout::atan2_turns(-0.0f, -1), 0.5f);
  EXPECT_EQ(layout::atan2_turns(-2, -2), -0.375f);
}

}  // namespace
}  // namespace lodestone::test
