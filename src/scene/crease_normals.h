// SPDX-License-Identifier: MIT
// Vertices for a mesh that has none of its own: triangles given by nothing but their corners' positions.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "lodestone/scene/scene.h"

namespace lodestone::scene {

// Fills positions, normals and triangles of the mesh from three corners a triangle. Triangles are smooth
// across an edge that exactly two of them share, in opposite directions, where their normals differ by at
// most `crease_angle` radians; every other edge is sharp. The corners around a position that smooth edges
// connect become one vertex, whose normal is the mean of their triangles' weighted by the angles at it. So a
// position has as many vertices as sharp edges divide it into. Vertices are in order of first use. All
// triangles stay; those without an area lean on the vertices of their neighbours. At most 2^32 - 2 corners,
// all finite.
void build_creased_mesh(std::span<const glm::vec3> corners, double crease_angle, Mesh& mesh);

}  // namespace lodestone::scene
