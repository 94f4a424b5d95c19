// SPDX-License-Identifier: MIT
// Surfaces for the tests of distances.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "lodestone/mesh/surface.h"

namespace lodestone::mesh::test {

struct Shape {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;

  Surface surface() const { return {positions, triangles}; }
  operator Surface() const { return surface(); }

  void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const auto first = static_cast<uint32_t>(positions.size());
    positions.insert(positions.end(), {a, b, c});
    triangles.emplace_back(first, first + 1, first + 2);
  }
};

// cells x cells squares over [0, 1] x [0, 1] at height z, two triangles each.
inline Shape plane(uint32_t cells, float z) {
  Shape shape;
  for (uint32_t y = 0; y <= cells; ++y) {
    for (uint32_t x = 0; x <= cells; ++x)
      shape.positions.emplace_back(float(x) / float(cells), float(y) / float(cells), z);
  }
  for (uint32_t y = 0; y < cells; ++y) {
    for (uint32_t x = 0; x < cells; ++x) {
      const uint32_t a = y * (cells + 1) + x, c = a + cells + 1;
      shape.triangles.emplace_back(a, a + 1, c);
      shape.triangles.emplace_back(c + 1, c, a + 1);
    }
  }
  return shape;
}

// A sphere around the origin, from pole to pole in `rows` rows of 2 * rows squares. The triangles at the
// poles that have no area are there as well.
inline Shape sphere(uint32_t rows, double radius) {
  const double pi = std::acos(-1.0);
  Shape shape;
  const uint32_t columns = 2 * rows;
  for (uint32_t row = 0; row <= rows; ++row) {
    for (uint32_t column = 0; column < columns; ++column) {
      const double latitude = pi * row / rows, longitude = 2 * pi * column / columns;
      const double ring = row == 0 || row == rows ? 0 : std::sin(latitude);
      shape.positions.emplace_back(
          radius * glm::dvec3(ring * std::cos(longitude), ring * std::sin(longitude), std::cos(latitude)));
    }
  }
  for (uint32_t row = 0; row < rows; ++row) {
    for (uint32_t column = 0; column < columns; ++column) {
      const uint32_t next = (column + 1) % columns, top = row * columns, bottom = top + columns;
      shape.triangles.emplace_back(top + column, bottom + column, top + next);
      shape.triangles.emplace_back(bottom + next, top + next, bottom + column);
    }
  }
  return shape;
}

// The surface of [-1, 1]^3.
inline Shape cube() {
  Shape shape;
  for (uint32_t i = 0; i < 8; ++i)
    shape.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  for (const glm::uvec4& face : {glm::uvec4(0, 1, 2, 3), glm::uvec4(4, 5, 6, 7), glm::uvec4(0, 1, 4, 5),
                                 glm::uvec4(2, 3, 6, 7), glm::uvec4(0, 2, 4, 6), glm::uvec4(1, 3, 5, 7)}) {
    shape.triangles.emplace_back(face[0], face[1], face[2]);
    shape.triangles.emplace_back(face[3], face[2], face[1]);
  }
  return shape;
}

inline glm::vec3 random_point(std::mt19937& random) {
  std::uniform_real_distribution<float> coordinate(-1, 1);
  const float x = coordinate(random), y = coordinate(random);
  return {x, y, coordinate(random)};
}

// Triangles of many sizes anywhere in [-2, 2]^3; of eight in a row one each is a point, has two equal
// corners, lies on a line (about, or exactly), and is a needle.
inline Shape soup(uint32_t seed, uint32_t count) {
  std::mt19937 random(seed);
  Shape shape;
  for (uint32_t i = 0; i < count; ++i) {
    const float size = std::exp2(-float(random() % 12));
    const glm::vec3 a = random_point(random);
    const glm::vec3 b = a + size * random_point(random), c = a + size * random_point(random);
    switch (i % 8) {
      case 0:
        shape.add(a, a, a);
        break;
      case 1:
        shape.add(a, b, i % 16 == 1 ? a : b);
        break;
      case 2:
        shape.add(a, b, a + 0.3f * (b - a));
        break;
      case 3:
        shape.add(a, a + glm::vec3(size, 0, 0), a - glm::vec3(size / 2, 0, 0));
        break;
      case 4:
        shape.add(a, b, b + 1e-6f * (c - a));
        break;
      default:
        shape.add(a, b, c);
    }
  }
  return shape;
}

}  // namespace lodestone::mesh::test
