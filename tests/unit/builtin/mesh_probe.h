// SPDX-License-Identifier: MIT
// What the tests of the built-in scenes ask of a mesh.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::test {

// Positions, or normals, with one blendshape at full weight.
std::vector<glm::vec3> posed_positions(const scene::Mesh& mesh, const scene::MorphTarget& target);
std::vector<glm::vec3> posed_normals(const scene::Mesh& mesh, const scene::MorphTarget& target);

// For every vertex the first one at the same position (and with the same deltas in every blendshape).
std::vector<uint32_t> joined_vertices(const scene::Mesh& mesh);

// Directed edges between joined vertices that do not have exactly one partner running the other way.
// 0: the mesh is closed and consistently oriented.
size_t open_edges(const scene::Mesh& mesh);

// The volume that the triangles enclose; positive where they face outwards.
double volume(const scene::Mesh& mesh, const std::vector<glm::vec3>& positions);

struct Hit {
  std::string mesh;  // empty: none
  float distance = 0;
};
// The mesh that a ray hits first, with blendshape `shape` at full weight on all meshes that have it ("": at
// rest).
Hit first_hit(const scene::Scene& scene, const std::string& shape, glm::vec3 origin, glm::vec3 direction);

}  // namespace lodestone::test
