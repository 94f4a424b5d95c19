// SPDX-License-Identifier: MIT
// What the distance between surfaces costs: building the tree, asking it for the points nearest to points
// near the surface in no order and far from it, and the whole distance to a slightly moved copy.
// distance_bench [SCENE] [ROUNDS], e.g. distance_bench stanford_dragon.ply 5; SCENE may be a file of the
// shared data folder.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <random>

#include "lodestone/base/error.h"
#include "lodestone/base/parallel.h"
#include "lodestone/mesh/distance.h"
#include "lodestone/mesh/triangle_points.h"
#include "lodestone/scene/load.h"
#include "lodestone/scene/pose.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

struct Triangles {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  float diagonal = 0;

  mesh::Surface surface() const { return {positions, triangles}; }
};

// Of the first mesh of a scene, in its own space.
Triangles load_triangles(const std::string& name) {
  const scene::Scene scene = scene::load(data_file(name).value_or(name));
  Triangles made{scene.meshes.at(0).positions, scene.meshes.at(0).triangles, 0};
  mesh::Box box;
  for (const glm::vec3& position : made.positions) box.add(position);
  made.diagonal = glm::length(box.hi - box.lo);
  return made;
}

// Points of random triangles, moved by up to `reach` along each axis.
std::vector<glm::dvec3> points_near(const Triangles& of, double reach, uint32_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-reach, reach);
  std::vector<glm::dvec3> points;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::uvec3& corners = of.triangles[random() % of.triangles.size()];
    const glm::dvec3 at = mesh::triangle_point(random() % 64);
    points.push_back(at[0] * glm::dvec3(of.positions[corners[0]]) +
                     at[1] * glm::dvec3(of.positions[corners[1]]) +
                     at[2] * glm::dvec3(of.positions[corners[2]]) +
                     glm::dvec3(shift(random), shift(random), shift(random)));
  }
  return points;
}

double milliseconds(int rounds, const std::function<void()>& work) {
  std::vector<double> times;
  for (int round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    work();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  return median(times);
}

// Microseconds a query on one thread.
double query_time(int rounds, const mesh::TriangleTree& tree, const std::vector<glm::dvec3>& points) {
  double sum = 0;
  const double ms = milliseconds(rounds, [&] {
    for (const glm::dvec3& point : points) sum += tree.nearest(point).distance;
  });
  if (!(sum >= 0)) throw std::logic_error("a distance that is no number");
  return ms * 1e3 / static_cast<double>(points.size());
}

int bench(const std::string& name, int rounds) {
  const Triangles of = load_triangles(name);
  fmt::print("{}: {} vertices, {} triangles; medians of {}\n", name, of.positions.size(), of.triangles.size(),
             rounds);
  for (const uint32_t threads : {1u, 0u}) {
    set_thread_count(threads);
    const double build = milliseconds(rounds, [&] { mesh::TriangleTree{of.surface()}; });
    fmt::print("build on {} threads: {:.0f} ms\n", thread_count(), build);
  }
  const mesh::TriangleTree tree(of.surface());
  constexpr uint32_t count = 200'000;
  for (const double reach : {0.0, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0}) {
    const double time = query_time(rounds, tree, points_near(of, reach * of.diagonal, count));
    fmt::print("query, moved by up to {:g} diagonals, in no order: {:.2f} us\n", reach, time);
  }
  Triangles moved = of;
  for (glm::vec3& position : moved.positions) position += 1e-4f * of.diagonal;
  uint64_t samples = 0;
  const double distance =
      milliseconds(rounds, [&] { samples = mesh::one_sided(moved.surface(), tree).samples; });
  fmt::print(
      "one_sided to a copy moved by 1e-4 diagonals along each axis: {:.0f} ms, {} samples, {:.2f} us each\n",
      distance, samples, distance * 1e3 / static_cast<double>(samples));
  return 0;
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  try {
    return lodestone::test::bench(argc > 1 ? argv[1] : "stanford_dragon.ply",
                                  argc > 2 ? std::max(std::atoi(argv[2]), 1) : 5);
  } catch (const std::exception& error) {
    fmt::print(stderr, "distance_bench: {}\n", error.what());
    return 3;
  }
}
