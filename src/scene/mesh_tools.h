// SPDX-License-Identifier: MIT
// Repairs that every mesh loader needs. Nothing is dropped or reordered.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// Smooth unit normals, one a position: the sum of the normals of the triangles around a vertex, weighted by
// their areas. Vertices at equal positions count as one, so that seams of texture coordinates do not show.
// (0, 0, 1) where a vertex has no triangle with an area. Every index must be less than positions.size().
std::vector<glm::vec3> smooth_normals(std::span<const glm::vec3> positions,
                                      std::span<const glm::uvec3> triangles);

// Brings the normals of a mesh into the state that scene.h asks for: all computed where there are none, else
// scaled to unit length; a zero one is replaced by the smooth normal.
void complete_normals(Mesh& mesh);

}  // namespace lodestone::scene
