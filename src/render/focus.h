// SPDX-License-Identifier: MIT
// Where a camera focuses by itself: on what is nearest to it in the middle of its picture.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "lodestone/render/renderer.h"

namespace lodestone::render {

// Rays through a grid of points of the picture, those of its middle ninth first; two vec4 each, as load_rays
// takes them.
std::vector<glm::vec4> focus_rays(const View& view);

// The distance along the view direction to the nearest of `hits` (t u v primitive) in the middle ninth, else
// of all; where nothing is met one at which all that is far is sharp.
float focus_of(const View& view, const std::vector<glm::vec4>& rays, const std::vector<glm::uvec4>& hits);

}  // namespace lodestone::render
