// SPDX-License-Identifier: MIT
// Rays for tests and benches: two vec4 each, origin and tmin, direction and tmax. Deterministic.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "lodestone/render/renderer.h"

namespace lodestone::test {

using Rays = std::vector<glm::vec4>;

void add_ray(Rays& rays, const glm::vec3& origin, const glm::vec3& direction);

// One through each pixel of a size x size picture (`size`: a multiple of 8), in tiles of 8 x 8. The second
// form needs a view of the aspect 1.
Rays primary_rays(const glm::vec3& eye, const glm::vec3& target, float half_angle, uint32_t size);
Rays primary_rays(const render::View& view, uint32_t size);

// From points around the bounds through them, and between points within: hits and misses, no coherence.
Rays random_rays(const glm::vec3& lo, const glm::vec3& hi, uint32_t count, uint32_t seed);

// From `clearance` above random points of the triangles into the half space of their outward side,
// cosine-distributed. Throws std::invalid_argument where no triangle has an area.
Rays surface_rays(const std::vector<glm::vec3>& points, const std::vector<glm::uvec3>& triangles,
                  uint32_t count, uint32_t seed, float clearance = 1e-4f);

glm::vec3 random_direction(std::mt19937& random);

}  // namespace lodestone::test
