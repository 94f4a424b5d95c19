// SPDX-License-Identifier: MIT
// Surfaces for the tests of the base complex.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lodestone/base_complex/half_edge_mesh.h"

namespace lodestone::base_complex::test {

struct Surface {
  std::vector<glm::dvec3> positions;
  std::vector<glm::uvec3> triangles;

  HalfEdgeMesh mesh() const { return {positions, triangles}; }

  uint32_t add(const glm::dvec3& position) {
    positions.push_back(position);
    return static_cast<uint32_t>(positions.size() - 1);
  }
  void add_quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {  // counterclockwise
    triangles.emplace_back(a, b, c);
    triangles.emplace_back(a, c, d);
  }
  void append(const Surface& other, const glm::dvec3& offset) {
    const auto first = static_cast<uint32_t>(positions.size());
    for (const glm::dvec3& p : other.positions) positions.push_back(p + offset);
    for (const glm::uvec3& t : other.triangles) triangles.push_back(t + first);
  }
};

inline const double pi = std::acos(-1.0);

// columns x rows squares of size 1; those for which `hole` says so are left out.
inline Surface plane(uint32_t columns, uint32_t rows,
                     const std::function<bool(uint32_t, uint32_t)>& hole = {}) {
  Surface s;
  for (uint32_t y = 0; y <= rows; ++y)
    for (uint32_t x = 0; x <= columns; ++x) s.add({x, y, 0});
  for (uint32_t y = 0; y < rows; ++y) {
    for (uint32_t x = 0; x < columns; ++x) {
      const uint32_t a = y * (columns + 1) + x, d = a + columns + 1;
      if (!hole || !hole(x, y)) s.add_quad(a, a + 1, d + 1, d);
    }
  }
  return s;
}

// A plane whose columns meet round: sample (x, y) at `at`(x / columns, y / rows). `turned`: the last column
// meets the first upside down, as in a Moebius strip. `closed`: rows meet too.
inline Surface ring(uint32_t columns, uint32_t rows, bool turned, bool closed,
                    const std::function<glm::dvec3(double, double)>& at) {
  Surface s;
  const uint32_t lines = closed ? rows : rows + 1;
  for (uint32_t x = 0; x < columns; ++x)
    for (uint32_t y = 0; y < lines; ++y) s.add(at(double(x) / columns, double(y) / rows));
  const auto index = [&](uint32_t x, uint32_t y) {
    if (x == columns && turned) return lines - 1 - y;
    return (x % columns) * lines + y % lines;
  };
  for (uint32_t x = 0; x < columns; ++x)
    for (uint32_t y = 0; y < rows; ++y)
      s.add_quad(index(x, y), index(x + 1, y), index(x + 1, y + 1), index(x, y + 1));
  return s;
}

inline Surface annulus(uint32_t columns, uint32_t rows) {
  return ring(columns, rows, false, false, [](double u, double v) {
    return (1 + v) * glm::dvec3(std::cos(2 * pi * u), -std::sin(2 * pi * u), 0);
  });
}

inline Surface tube(uint32_t columns, uint32_t rows, double length) {
  return ring(columns, rows, false, false, [=](double u, double v) {
    return glm::dvec3(std::cos(2 * pi * u), std::sin(2 * pi * u), length * v);
  });
}

inline Surface moebius(uint32_t columns, uint32_t rows) {
  return ring(columns, rows, true, false, [](double u, double v) {
    const double turn = pi * u, across = v - 0.5, radius = 2 + across * std::cos(turn);
    return glm::dvec3(radius * std::cos(2 * pi * u), radius * std::sin(2 * pi * u), across * std::sin(turn));
  });
}

inline Surface torus(uint32_t columns, uint32_t rows) {
  return ring(columns, rows, false, true, [](double u, double v) {
    const double radius = 2 + std::cos(2 * pi * v);
    return glm::dvec3(radius * std::cos(2 * pi * u), radius * std::sin(2 * pi * u), std::sin(2 * pi * v));
  });
}

// `rows` rows of 2 * rows squares, triangles at the poles.
inline Surface sphere(uint32_t rows) {
  Surface s;
  const uint32_t columns = 2 * rows;
  const uint32_t top = s.add({0, 0, 1}), bottom = s.add({0, 0, -1});
  for (uint32_t row = 1; row < rows; ++row) {
    for (uint32_t column = 0; column < columns; ++column) {
      const double latitude = pi * row / rows, longitude = 2 * pi * column / columns;
      s.add({std::sin(latitude) * std::cos(longitude), std::sin(latitude) * std::sin(longitude),
             std::cos(latitude)});
    }
  }
  const auto index = [&](uint32_t row, uint32_t column) {
    return 2 + (row - 1) * columns + column % columns;
  };
  for (uint32_t column = 0; column < columns; ++column) {
    s.triangles.emplace_back(top, index(1, column), index(1, column + 1));
    for (uint32_t row = 1; row + 1 < rows; ++row)
      s.add_quad(index(row, column), index(row + 1, column), index(row + 1, column + 1),
                 index(row, column + 1));
    s.triangles.emplace_back(bottom, index(rows - 1, column + 1), index(rows - 1, column));
  }
  return s;
}

// A closed plate with holes through it, of cubes with `fine` x `fine` squares a side.
inline Surface plate_with_holes(uint32_t holes, uint32_t fine) {
  Surface s;
  std::map<std::array<uint32_t, 3>, uint32_t> points;
  const auto point = [&](const glm::uvec3& p) {
    const auto [place, is_new] = points.emplace(std::array<uint32_t, 3>{p.x, p.y, p.z}, 0);
    if (is_new) place->second = s.add(glm::dvec3(p) / double(fine));
    return place->second;
  };
  const auto is_full = [&](int x, int y, int z) {
    const bool in_plate = x >= 0 && x <= int(2 * holes) && y >= 0 && y < 3 && z == 0;
    return in_plate && !(y == 1 && x % 2 == 1);
  };
  for (int x = 0; x <= int(2 * holes); ++x) {
    for (int y = 0; y < 3; ++y) {
      for (int side = 0; is_full(x, y, 0) && side < 6; ++side) {
        const glm::length_t axis = side / 2, second = (axis + 1) % 3, third = (axis + 2) % 3;
        const bool high = side % 2 == 1;
        glm::ivec3 beside(x, y, 0);
        beside[axis] += high ? 1 : -1;
        if (is_full(beside.x, beside.y, beside.z)) continue;
        glm::uvec3 corner = glm::uvec3(x, y, 0) * fine;
        corner[axis] += high ? fine : 0;
        glm::uvec3 u(0), v(0);
        u[high ? second : third] = 1;
        v[high ? third : second] = 1;
        for (uint32_t i = 0; i < fine; ++i) {
          for (uint32_t j = 0; j < fine; ++j) {
            const glm::uvec3 p = corner + i * u + j * v;
            s.add_quad(point(p), point(p + u), point(p + u + v), point(p + v));
          }
        }
      }
    }
  }
  return s;
}

inline Surface single_triangle() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
}

inline Surface tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

// Two triangles back to back.
inline Surface pillow() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
}

// `sheets` triangles at one edge, every other one the other way round.
inline Surface sheets(uint32_t count) {
  Surface s;
  s.add({0, 0, 0});
  s.add({0, 0, 2});
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t tip = s.add({std::cos(2 * pi * i / count), std::sin(2 * pi * i / count), 1});
    s.triangles.emplace_back(i % 2, 1 - i % 2, tip);
  }
  return s;
}

// Two spheres that share their north poles.
inline Surface touching_spheres(uint32_t rows) {
  Surface s = sphere(rows);
  const Surface other = sphere(rows);
  const auto first = static_cast<uint32_t>(s.positions.size());
  for (const glm::dvec3& p : other.positions) s.add(glm::dvec3(p.x, p.y, 2 - p.z));
  for (const glm::uvec3& t : other.triangles) {
    const auto renamed = [&](uint32_t p) { return p == 0 ? 0 : first + p; };
    s.triangles.emplace_back(renamed(t.x), renamed(t.z), renamed(t.y));
  }
  return s;
}

// Different triangles of three different points each, of few points: edges and points of any number of faces.
inline Surface soup(uint32_t seed, uint32_t points, uint32_t triangles) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  Surface s;
  for (uint32_t i = 0; i < points; ++i) {
    const double x = coordinate(random), y = coordinate(random);
    s.add({x, y, coordinate(random)});
  }
  std::set<std::set<uint32_t>> known;
  while (s.triangles.size() < triangles) {
    const auto a = uint32_t(random() % points), b = uint32_t(random() % points),
               c = uint32_t(random() % points);
    const std::set<uint32_t> corners = {a, b, c};
    if (corners.size() == 3 && known.insert(corners).second) s.triangles.emplace_back(a, b, c);
  }
  return s;
}

// Tetrahedra and triangles, in turn, that have nothing in common.
inline Surface many_components(uint32_t count) {
  Surface s;
  for (uint32_t i = 0; i < count; ++i)
    s.append(i % 2 == 0 ? tetrahedron() : single_triangle(), {3 * (i % 10), 3 * (i / 10), 0});
  return s;
}

// Makes barriers of the edges for which `is_one`(position, position) says so.
inline void add_barriers(HalfEdgeMesh& mesh,
                         const std::function<bool(const glm::dvec3&, const glm::dvec3&)>& is_one) {
  for (uint32_t h = 0; h < 3 * mesh.faces(); ++h)
    if (is_one(mesh.position(mesh.from(h)), mesh.position(mesh.to(h)))) mesh.make_barrier(h);
}

struct Sample {
  std::string name;
  HalfEdgeMesh mesh;
};

inline std::vector<Sample> all_samples() {
  const auto is_hole = [](uint32_t x, uint32_t y) { return x % 5 == 2 && (y % 7 == 3 || y % 7 == 4); };
  std::vector<Sample> samples;
  samples.push_back({"sphere", sphere(16).mesh()});
  samples.push_back({"torus", torus(32, 20).mesh()});
  samples.push_back({"small torus", torus(3, 3).mesh()});
  samples.push_back({"genus 2", plate_with_holes(2, 3).mesh()});
  samples.push_back({"genus 3", plate_with_holes(3, 2).mesh()});
  samples.push_back({"genus 3, coarse", plate_with_holes(3, 1).mesh()});
  samples.push_back({"plane", plane(17, 9).mesh()});
  samples.push_back({"plane with holes", plane(25, 21, is_hole).mesh()});
  // A ring that is open but for one point, where its ends touch.
  for (const uint32_t fine : {1u, 3u})
    samples.push_back({"pinched ring", plane(3 * fine, 3 * fine, [=](uint32_t x, uint32_t y) {
                                         return x / fine == y / fine && x < 2 * fine;
                                       }).mesh()});
  samples.push_back({"annulus", annulus(24, 6).mesh()});
  samples.push_back({"small annulus", annulus(3, 1).mesh()});
  samples.push_back({"tube", tube(12, 40, 20).mesh()});
  samples.push_back({"moebius", moebius(30, 5).mesh()});
  samples.push_back({"small moebius", moebius(5, 1).mesh()});
  samples.push_back({"touching spheres", touching_spheres(10).mesh()});
  samples.push_back({"triangle", single_triangle().mesh()});
  samples.push_back({"tetrahedron", tetrahedron().mesh()});
  samples.push_back({"pillow", pillow().mesh()});
  for (const uint32_t count : {2u, 3u, 4u, 9u})
    samples.push_back({std::to_string(count) + " sheets", sheets(count).mesh()});
  samples.push_back({"components", many_components(60).mesh()});
  for (uint32_t seed = 0; seed < 6; ++seed) {
    samples.push_back({"soup " + std::to_string(seed), soup(seed, 30 + 20 * seed, 200).mesh()});
    samples.push_back({"dense soup " + std::to_string(seed), soup(seed, 8 + seed, 40).mesh()});
  }
  // Barriers along a line that ends inside, along a closed one, and strewn.
  samples.push_back({"slit", plane(12, 12).mesh()});
  add_barriers(samples.back().mesh, [](const glm::dvec3& a, const glm::dvec3& b) {
    return a.y == 6 && b.y == 6 && a.x + b.x > 8 && a.x + b.x < 17;
  });
  samples.push_back({"one barrier", plane(2, 2).mesh()});
  add_barriers(samples.back().mesh, [](const glm::dvec3& a, const glm::dvec3& b) {
    return a.x == 1 && b.x == 1 && a.y + b.y == 1;
  });
  samples.push_back({"equator", sphere(12).mesh()});
  add_barriers(samples.back().mesh, [](const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(a.z) < 1e-9 && std::abs(b.z) < 1e-9;
  });
  for (const unsigned seed : {1u, 2u, 3u}) {
    samples.push_back({"strewn " + std::to_string(seed), torus(16, 12).mesh()});
    std::mt19937 random(seed);
    add_barriers(samples.back().mesh,
                 [&](const glm::dvec3&, const glm::dvec3&) { return random() % (2 * seed) == 0; });
  }
  return samples;
}

}  // namespace lodestone::base_complex::test
