// SPDX-License-Identifier: MIT
// Where a camera focuses by itself: on what is nearest to the middle of its picture.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "lodestone/render/renderer.h"

namespace lodestone::render {

// Rays through a grid of points of the picture, from its middle outwards; two vec4 each, as load_rays takes
// them.
std::vector<glm::vec4> focus_rays(const View& view);

// The distance along the view direction to the first of `hits` (t u v primitive) that there is; where nothing
// is met one at which all that is far is sharp.
float focus_of(const View& view, const std::vector<glm::vec4>& rays, const std::vector<glm::uvec4>& hits);

}  // namespace lodestone::render
