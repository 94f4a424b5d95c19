// SPDX-License-Identifier: MIT
#include "lodestone/test_support/regrid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lodestone/scene/builtin/surface.h"

namespace lodestone::test {
namespace {

using scene::Grid, scene::Mesh;

uint64_t quads_of(const Mesh& mesh) {
  return mesh.triangles.size() / 2;
}

void refuse_others(const Mesh& mesh) {
  if (mesh.grids.empty()) throw std::invalid_argument(mesh.name + " is not made of grids");
  if (!mesh.targets.empty() || !mesh.influences.empty())
    throw std::invalid_argument(mesh.name + " is not rigid");
}

uint32_t scaled_side(uint32_t samples, double factor) {
  return std::max(1u, uint32_t(std::lround((samples - 1) * factor))) + 1;
}

// Where a sample of `to` samples lies among `from`: the one below it, and how far on.
struct Place {
  uint32_t below;
  float on;
};
Place place_of(uint32_t sample, uint32_t to, uint32_t from) {
  const uint64_t scaled = uint64_t(sample) * (from - 1);
  const auto below = std::min(uint32_t(scaled / (to - 1)), from - 2);
  return {below, float(double(scaled) / (to - 1) - below)};
}

template <class Item>
void add_sample(std::vector<Item>& to, const std::vector<Item>& from, const uint32_t (&corners)[4], Place x,
                Place y) {
  if (from.empty()) return;
  to.push_back(glm::mix(glm::mix(from[corners[0]], from[corners[1]], x.on),
                        glm::mix(from[corners[2]], from[corners[3]], x.on), y.on));
}

Grid resampled(const Mesh& from, const Grid& grid, double factor, Mesh& to) {
  Grid result;
  result.width = scaled_side(grid.width, factor);
  result.height = scaled_side(grid.height, factor);
  for (uint32_t row = 0; row < result.height; ++row) {
    const Place y = place_of(row, result.height, grid.height);
    for (uint32_t column = 0; column < result.width; ++column) {
      const Place x = place_of(column, result.width, grid.width);
      const uint32_t* corner = &grid.vertices[size_t(y.below) * grid.width + x.below];
      const uint32_t corners[4] = {corner[0], corner[1], corner[grid.width], corner[grid.width + 1]};
      result.vertices.push_back(uint32_t(to.positions.size()));
      add_sample(to.positions, from.positions, corners, x, y);
      add_sample(to.normals, from.normals, corners, x, y);
      add_sample(to.tangents, from.tangents, corners, x, y);
      add_sample(to.colors, from.colors, corners, x, y);
      for (int set = 0; set < 2; ++set) add_sample(to.texcoords[set], from.texcoords[set], corners, x, y);
      glm::vec3& normal = to.normals.back();
      normal = glm::dot(normal, normal) > 1e-6f ? glm::normalize(normal) : from.normals[corners[0]];
      if (!to.tangents.empty()) to.tangents.back().w = from.tangents[corners[0]].w;
    }
  }
  return result;
}

Mesh resampled(const Mesh& mesh, double factor) {
  Mesh result;
  result.name = mesh.name;
  std::vector<Grid> grids = mesh.grids;
  std::sort(grids.begin(), grids.end(),
            [](const Grid& a, const Grid& b) { return a.first_triangle < b.first_triangle; });
  auto grid = grids.begin();
  for (const scene::Part& part : mesh.parts) {
    const auto first = uint32_t(result.triangles.size());
    for (; grid != grids.end() && grid->first_triangle < part.first_triangle + part.triangle_count; ++grid)
      scene::builtin::add_grid(result, resampled(mesh, *grid, factor, result));
    scene::builtin::add_part(result, first, part.material);
  }
  return result;
}

}  // namespace

scene::Scene regridded(scene::Scene scene, uint64_t quads) {
  uint64_t placed = 0;
  for (const scene::Node& node : scene.nodes) {
    if (node.mesh == scene::none) continue;
    refuse_others(scene.meshes[node.mesh]);
    placed += quads_of(scene.meshes[node.mesh]);
  }
  if (placed == 0) throw std::invalid_argument(scene.name + " places no mesh");
  const double factor = std::sqrt(double(quads) / double(placed));
  for (Mesh& mesh : scene.meshes) mesh = resampled(mesh, factor);
  return scene;
}

}  // namespace lodestone::test
