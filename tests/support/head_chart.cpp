// SPDX-License-Identifier: MIT
#include "lodestone/test_support/head_chart.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lodestone/base/parallel.h"
#include "lodestone/scene/builtin/head_clip.h"
#include "lodestone/scene/builtin/head_parts.h"
#include "lodestone/scene/builtin/head_skin.h"
#include "lodestone/scene/builtin/surface.h"
#include "lodestone/scene/load.h"

namespace lodestone::test {
namespace {

using glm::ivec2, glm::vec2, glm::vec3;

// The border of the square is folded onto itself: this is the sample that stands for (x, y).
ivec2 folded(ivec2 sample, int quads) {
  if (sample.x == 0 || sample.x == quads) sample.y = std::min(sample.y, quads - sample.y);
  if (sample.y == 0 || sample.y == quads) sample.x = std::min(sample.x, quads - sample.x);
  return sample;
}

vec3 octahedral_direction(vec2 place) {  // in [-1, 1]
  const vec2 size = glm::abs(place);
  const float z = 1 - size.x - size.y;
  if (z >= 0) return {place, z};
  return {std::copysign(1 - size.y, place.x), std::copysign(1 - size.x, place.y), z};
}

scene::Mesh skin_of(int quads, uint32_t material) {
  namespace builtin = scene::builtin;
  scene::Mesh mesh;
  mesh.name = "skin";
  scene::Grid grid;
  grid.width = grid.height = uint32_t(quads) + 1;
  std::vector<builtin::Aim> aims;
  std::vector<uint32_t> vertex_of(size_t(grid.width) * grid.height, scene::none);
  for (int y = 0; y <= quads; ++y) {
    for (int x = 0; x <= quads; ++x) {
      const ivec2 sample = folded({x, y}, quads);
      uint32_t& vertex = vertex_of[size_t(sample.y) * grid.width + size_t(sample.x)];
      if (vertex == scene::none) {
        vertex = uint32_t(aims.size());
        const vec2 place = 2.0f * vec2(sample) / float(quads) - 1.0f;
        aims.push_back(builtin::aim_at(builtin::head_centre + octahedral_direction(place)));
        mesh.colors.emplace_back(builtin::skin_color(aims.back()), 1);
      }
      grid.vertices.push_back(vertex);
    }
  }
  builtin::add_grid(mesh, std::move(grid));
  builtin::add_part(mesh, 0, material);
  builtin::sculpt(mesh, [&](const builtin::Expression& expression) {
    std::vector<vec3> points(aims.size());
    parallel_for(points.size(), 1024, [&](uint64_t begin, uint64_t end) {
      for (uint64_t v = begin; v < end; ++v)
        points[v] = builtin::snap(builtin::skin_point(aims[v], expression));
    });
    return points;
  });
  for (const vec3& point : mesh.positions)
    mesh.texcoords[0].push_back(builtin::freckle_coordinates(builtin::aim_at(point)));
  return mesh;
}

}  // namespace

scene::Scene head_chart(uint32_t quads) {
  if (quads < 4 || quads % 2 != 0 || quads > 4096)
    throw std::invalid_argument("a head's chart has an even number of quads a side, 4 to 4096");
  scene::Scene scene = scene::load("builtin:head");
  scene.meshes = {skin_of(int(quads), scene.meshes.front().parts.front().material)};
  for (scene::Node& node : scene.nodes) {
    if (node.mesh != 0) node.mesh = scene::none;
  }
  const auto pivot = std::find_if(scene.nodes.begin(), scene.nodes.end(),
                                  [](const scene::Node& node) { return node.name == "head"; });
  scene.animations = {scene::builtin::expressions_clip(scene, uint32_t(pivot - scene.nodes.begin()))};
  return scene;
}

}  // namespace lodestone::test
