// SPDX-License-Identifier: MIT
// Zero area, decided exactly.
#pragma once

#include <glm/glm.hpp>

namespace lodestone::geometry_image {

// True only where the three points lie exactly on one line (or on one point). False also in the rare case
// that their coordinates are so far apart in magnitude that double precision cannot tell.
bool exactly_collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace lodestone::geometry_image
