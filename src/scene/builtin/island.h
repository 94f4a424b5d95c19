// SPDX-License-Identifier: MIT
// The landscape of the teapots, in their units: a bare island that rises from a lagoon, and palms on it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

#include "lodestone/scene/scene.h"

namespace lodestone::scene::builtin {

inline constexpr float sea_level = -2.6f;
inline constexpr float ground_half_width = 112;
inline constexpr float plateau_radius = 12;  // around the origin the ground is at y = 0

// The height of the ground at (x, z).
float island_height(glm::vec2 place);
// A height field of 9 charts, ground_half_width to each side; its border lies below the sea. Texture
// coordinates are those of island_picture.
Mesh island_ground(uint32_t material);
// Sand and grass from above: u along +X, v along +Z.
Image island_picture();
// A ring of 8 charts, from below the island to the horizon. Coloured by vertex.
Mesh island_sea(uint32_t material);
// One palm of about 24 units, rooted in y = 0. Different `kind`s, 0 and up, grow and bend differently.
// Coloured by vertex; leaves are single sheets.
Mesh palm(const std::string& name, uint32_t kind, uint32_t material);

}  // namespace lodestone::scene::builtin
