// SPDX-License-Identifier: MIT
// Scenes for the tests of the atlas.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/scene.h"

namespace lodestone::geometry_image::test {

inline scene::Mesh mesh_of(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles) {
  scene::Mesh mesh;
  mesh.name = "sample";
  mesh.positions = std::move(positions);
  mesh.normals.resize(mesh.positions.size(), glm::vec3(0, 0, 1));
  mesh.triangles = std::move(triangles);
  if (!mesh.triangles.empty())
    mesh.parts.push_back({0, static_cast<uint32_t>(mesh.triangles.size()), scene::none});
  return mesh;
}

inline scene::Scene scene_of(std::vector<scene::Mesh> meshes) {
  scene::Scene scene;
  scene.name = "test";
  scene.meshes = std::move(meshes);
  for (uint32_t i = 0; i < scene.meshes.size(); ++i) {
    scene.nodes.emplace_back();
    scene.nodes.back().mesh = i;
  }
  return scene;
}

// Adds a grid whose sample (x, y) is vertex `vertices[y * width + x]`, with its triangles.
inline void add_grid(scene::Mesh& mesh, uint32_t width, uint32_t height, std::vector<uint32_t> vertices) {
  scene::Grid grid{width, height, static_cast<uint32_t>(mesh.triangles.size()), std::move(vertices)};
  for (uint32_t y = 0; y + 1 < height; ++y) {
    for (uint32_t x = 0; x + 1 < width; ++x) {
      const uint32_t* a = &grid.vertices[size_t(y) * width + x];
      mesh.triangles.emplace_back(a[0], a[1], a[width]);
      mesh.triangles.emplace_back(a[width + 1], a[width], a[1]);
    }
  }
  mesh.parts = {{0, static_cast<uint32_t>(mesh.triangles.size()), scene::none}};
  mesh.grids.push_back(std::move(grid));
}

// A height field of width x height samples, one a unit, with its corner at `origin`.
inline scene::Mesh height_field(uint32_t width, uint32_t height, glm::vec3 origin = glm::vec3(0)) {
  scene::Mesh mesh = mesh_of({}, {});
  std::vector<uint32_t> vertices;
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      vertices.push_back(y * width + x);
      mesh.positions.push_back(origin + glm::vec3(x, y, std::sin(float(3 * x + 7 * y))));
    }
  }
  mesh.normals.resize(mesh.positions.size(), glm::vec3(0, 0, 1));
  add_grid(mesh, width, height, std::move(vertices));
  return mesh;
}

// Triangles between random vertices of a small set at random places: with edges of any number of triangles,
// duplicates and triangles with equal corners.
inline scene::Mesh random_mesh(uint32_t seed, uint32_t vertices, uint32_t triangles) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-1.0f, 1.0f);
  scene::Mesh mesh = mesh_of({}, {});
  for (uint32_t v = 0; v < vertices; ++v) {
    mesh.positions.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    mesh.normals.emplace_back(0, 0, 1);
  }
  const auto vertex = [&] { return static_cast<uint32_t>(random() % vertices); };
  for (uint32_t t = 0; t < triangles; ++t) {
    const uint32_t a = vertex(), b = vertex(), c = vertex();
    mesh.triangles.emplace_back(a, b, c);
  }
  mesh.parts.push_back({0, triangles, scene::none});
  return mesh;
}

// Triangles that share one edge, like the pages of a book. From 256 on they are soup, which is not resampled.
inline scene::Mesh pages(uint32_t count) {
  scene::Mesh mesh = mesh_of({{0, 0, 0}, {0, 0, 1}}, {});
  for (uint32_t i = 0; i < count; ++i) {
    const float angle = 6.2831853f * float(i) / float(count);
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.5f);
    mesh.triangles.emplace_back(0, 1, 2 + i);
  }
  mesh.normals.resize(mesh.positions.size(), glm::vec3(0, 0, 1));
  mesh.parts = {{0, count, scene::none}};
  return mesh;
}

inline Atlas atlas_of(const scene::Scene& scene, const AtlasSettings& settings = {}) {
  return build_atlas(scene, scene::assemble(scene), settings);
}

inline Atlas atlas_of(scene::Mesh mesh, const AtlasSettings& settings = {}) {
  return atlas_of(scene_of({std::move(mesh)}), settings);
}

}  // namespace lodestone::geometry_image::test
