// SPDX-License-Identifier: MIT
// Repairs that every mesh loader needs. Nothing is dropped or reordered.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// A colour of a file, encoded as sRGB (IEC 61966-2-1), as a linear one; cut to 0 to 1.
float decode_srgb(float encoded);

// The unit normal of a triangle, or zero where it has no area.
glm::vec3 facet_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

// Smooth unit normals, one a position: the sum of the normals of the triangles around a vertex, weighted by
// their areas. Vertices at equal positions count as one, so that seams of texture coordinates do not show.
// (0, 0, 1) where a vertex has no triangle with an area. Every index must be less than positions.size().
std::vector<glm::vec3> smooth_normals(std::span<const glm::vec3> positions,
                                      std::span<const glm::uvec3> triangles);

// Brings the normals of a mesh into the state that scene.h asks for: all computed where there are none, else
// scaled to unit length; a zero one is replaced by the smooth normal.
void complete_normals(Mesh& mesh);

}  // namespace lodestone::scene
