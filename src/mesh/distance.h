// SPDX-License-Identifier: MIT
// How far apart two surfaces are. All lengths are in the units of the positions; the caller relates them to a
// size. Equal inputs give equal bits, whatever the number of threads.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "lodestone/mesh/surface.h"
#include "lodestone/mesh/triangle_tree.h"

namespace lodestone::mesh {

inline constexpr uint64_t default_samples = 1'000'000;

// A point of a surface and the nearest point of the other one.
struct FarPlace {
  glm::dvec3 point{0};
  uint32_t triangle = none;  // where `point` is; of a corner of several triangles, the first of them
  glm::dvec3 nearest{0};
  uint32_t nearest_triangle = none;
};

// From the points of one surface to another surface; each value is at least 0.
struct OneSidedDistance {
  double maximum = 0;  // never more than the true one, because points between the samples do not count
  double mean = 0;     // over the area
  double root_mean_square = 0;  // over the area
  FarPlace farthest;            // where the maximum is; triangles are `none` where either surface is empty
  uint64_t samples = 0;         // the points that were measured, corners included
};

// Measures at the corners of all triangles of `from` (each vertex once; they count for the maximum only) and
// at about `samples` points inside them, as many a triangle as its area deserves, at least one: its centroid.
// The points of a triangle are evenly spread and do not depend on the other surface. Where the whole surface
// has no area, each triangle counts the same.
//
// An empty `from` gives 0 everywhere and no place; an empty `to` is infinitely far away from any other
// surface. Throws as Surface says.
OneSidedDistance one_sided(const Surface& from, const TriangleTree& to, uint64_t samples = default_samples);
OneSidedDistance one_sided(const Surface& from, const Surface& to, uint64_t samples = default_samples);

struct SymmetricDistance {
  OneSidedDistance forth, back;  // from the first surface to the second; from the second to the first

  double hausdorff() const { return glm::max(forth.maximum, back.maximum); }
};

// `samples` points on each of them.
SymmetricDistance symmetric(const Surface& a, const Surface& b, uint64_t samples = default_samples);

}  // namespace lodestone::mesh
