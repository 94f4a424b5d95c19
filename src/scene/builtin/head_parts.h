// SPDX-License-Identifier: MIT
// The parts of the head beside its skin. Each is a mesh of closed surfaces with the blendshapes that move it.
#pragma once

#include <functional>
#include <vector>

#include "lodestone/scene/builtin/head_expression.h"
#include "lodestone/scene/scene.h"

namespace lodestone::scene::builtin {

using Posing = std::function<std::vector<glm::vec3>(const Expression&)>;

// Gives a mesh, whose triangles are there, its positions, normals and blendshapes.
void sculpt(Mesh& mesh, const Posing& posed);

Mesh head_skin(uint32_t material);
Mesh head_eyes(uint32_t material);
Image iris_image();
// White but for freckles over nose and cheeks; aims become texture coordinates, the back of the head
// mirrored.
Image freckle_image();
glm::vec2 freckle_coordinates(Aim aim);
// How much of the sky what is in the mouth sees: one texel.
Image mouth_shade();
Mesh head_ears(uint32_t material);
Mesh head_brows(uint32_t material);
Mesh head_teeth(uint32_t material);
Mesh head_tongue(uint32_t material);
Mesh head_hair(uint32_t material);
Mesh head_shirt(uint32_t material);

}  // namespace lodestone::scene::builtin
