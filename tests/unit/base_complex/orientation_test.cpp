// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "lodestone/base_complex/predicates.h"

namespace lodestone::base_complex {
namespace {

__extension__ using Wide = __int128;
using Point = std::array<int64_t, 2>;

// Exact for coordinates below 2^61.
int exact_orientation(const Point& a, const Point& b, const Point& c) {
  const Wide det = Wide(a[0]) * b[1] - Wide(a[0]) * c[1] - Wide(c[0]) * b[1] - Wide(a[1]) * b[0] +
                   Wide(a[1]) * c[0] + Wide(c[1]) * b[0];
  return det > 0 ? 1 : det < 0 ? -1 : 0;
}

int naive_orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const double det = (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x);
  return det > 0 ? 1 : det < 0 ? -1 : 0;
}

glm::dvec2 scaled(const Point& p, int power) {
  return {std::ldexp(double(p[0]), power), std::ldexp(double(p[1]), power)};
}

struct Counts {
  int zero = 0, turned = 0, naive_is_wrong = 0;
};

// Every order of the three points; a power of two for a unit changes nothing.
void expect_exact(const Point& a, const Point& b, const Point& c, Counts& counts) {
  const int expected = exact_orientation(a, b, c);
  for (const int power : {0, -61, 300, -500}) {
    const glm::dvec2 p = scaled(a, power), q = scaled(b, power), r = scaled(c, power);
    ASSERT_EQ(orientation(p, q, r), expected);
    ASSERT_EQ(orientation(q, r, p), expected);
    ASSERT_EQ(orientation(r, p, q), expected);
    ASSERT_EQ(orientation(q, p, r), -expected);
    ASSERT_EQ(orientation(r, q, p), -expected);
    ASSERT_EQ(orientation(p, r, q), -expected);
  }
  ++(expected == 0 ? counts.zero : counts.turned);
  counts.naive_is_wrong += naive_orientation(scaled(a, 0), scaled(b, 0), scaled(c, 0)) != expected ? 1 : 0;
}

// The integer of at most 53 bits next to x, shifted where x is larger: exactly a double.
int64_t as_double(double x) {
  return static_cast<int64_t>(x);
}

TEST(Orientation, SeesWhichWayPlainPointsTurn) {
  EXPECT_EQ(orientation({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orientation({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orientation({0, 0}, {1, 1}, {3, 3}), 0);
  EXPECT_EQ(orientation({2, 5}, {2, 5}, {7, 1}), 0);
  EXPECT_EQ(orientation({2, 5}, {2, 5}, {2, 5}), 0);
}

TEST(Orientation, IsExactNearALine) {
  std::mt19937_64 random(1);
  Counts counts;
  std::uniform_real_distribution<double> coordinate(-0x1p52, 0x1p52), place(-0.5, 1.5);
  for (int i = 0; i < 20000; ++i) {
    const Point a = {as_double(coordinate(random)), as_double(coordinate(random))},
                b = {as_double(coordinate(random)), as_double(coordinate(random))};
    const double t = place(random);
    const Point c = {as_double(double(a[0]) + t * double(b[0] - a[0])) + int64_t(random() % 3) - 1,
                     as_double(double(a[1]) + t * double(b[1] - a[1])) + int64_t(random() % 3) - 1};
    expect_exact(a, b, c, counts);
  }
  EXPECT_GT(counts.turned, 10000);
  EXPECT_GT(counts.naive_is_wrong, 100) << "these inputs are too easy";
}

TEST(Orientation, IsExactOnALine) {
  std::mt19937_64 random(2);
  Counts counts;
  const auto number = [&](int64_t most) { return int64_t(random() % uint64_t(2 * most + 1)) - most; };
  for (int i = 0; i < 20000; ++i) {
    // c - a and b - a are multiples of one step; b or c may then be put off by one.
    const Point a = {number(int64_t(1) << 50), number(int64_t(1) << 50)},
                step = {number(1 << 20), number(1 << 20)};
    const int64_t m = number(1 << 29), n = number(1 << 29);
    const Point b = {a[0] + m * step[0], a[1] + m * step[1]};
    Point c = {a[0] + n * step[0], a[1] + n * step[1]};
    if (i % 3 == 0) c[i % 2] += i % 6 == 0 ? 1 : -1;
    expect_exact(a, b, c, counts);
  }
  EXPECT_GT(counts.zero, 10000);
  EXPECT_GT(counts.turned, 5000);
}

// One point near the origin, one far from it, one very far, nearly on one line.
TEST(Orientation, IsExactWhereCoordinatesAreOfManySizes) {
  std::mt19937_64 random(3);
  Counts counts;
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const auto point = [&](double x, double y, int power) {
      return Point{as_double(std::ldexp(x, power)), as_double(std::ldexp(y, power))};
    };
    const double x = coordinate(random), y = coordinate(random);
    const Point a = point(coordinate(random), coordinate(random), int(random() % 20)),
                b = point(x, y, 30 + int(random() % 20)), c = point(x, y, 50 + int(random() % 11));
    expect_exact(a, b, c, counts);
    expect_exact({0, 0}, b, c, counts);
    expect_exact({c[0], a[1]}, {c[0], b[1]}, c, counts);
  }
  EXPECT_GT(counts.zero, 10000);
  EXPECT_GT(counts.naive_is_wrong, 0);
}

// The classic: a grid of neighbouring doubles beside the line through two far points.
TEST(Orientation, IsExactOnNeighbouringDoubles) {
  Counts counts;
  const int64_t one = int64_t(1) << 53;  // 1, in units of 2^-53
  for (int64_t x = 0; x < 64; ++x)
    for (int64_t y = 0; y < 64; ++y)
      expect_exact({one / 2 + x, one / 2 + y}, {12 * one, 12 * one}, {24 * one, 24 * one}, counts);
  EXPECT_EQ(counts.zero, 64);
  EXPECT_GT(counts.naive_is_wrong, 100);
}

}  // namespace
}  // namespace lodestone::base_complex
