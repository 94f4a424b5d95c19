// SPDX-License-Identifier: MIT
// From the buffers that `resolve` and `aov` wrote to images with named channels.
#pragma once

#include "lodestone/render/renderer.h"

namespace lodestone::render {

// Throws Error(usage) for a name that is none of depth, normal, albedo, uv, id, lod, steps.
void check_aovs(const std::vector<std::string>& names);

// R G B and, with `alpha`, A.
image::Image make_color_image(const Settings& settings, const std::vector<glm::vec4>& pixels, bool alpha);
// Adds noisy.R G B.
void add_noisy(const std::vector<glm::vec4>& pixels, image::Image& image);
// Adds the AOVs that the settings ask for; `quads`: four a pixel, as the `aov` pass writes them.
void add_aovs(const Settings& settings, const std::vector<glm::uvec4>& quads, image::Image& image);

}  // namespace lodestone::render
