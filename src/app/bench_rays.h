// SPDX-License-Identifier: MIT
// The rays that benchmarks shoot. Deterministic: equal scenes and seeds give equal rays on every machine.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/app/common_options.h"
#include "lodestone/app/prepared_scene.h"
#include "lodestone/render/renderer.h"

namespace lodestone::app {

// Rays as Renderer::load_rays() takes them: origin and tmin, direction (unit length) and tmax.
using Rays = std::vector<glm::vec4>;

// One through the centre of every pixel, row by row.
Rays primary_rays(const render::View& view, const Size& size);

// `count` rays from points spread evenly over the surface, in directions spread evenly over the sphere: what
// a bounce of diffuse light asks of a tracer at its worst.
Rays incoherent_rays(const PreparedScene& prepared, const scene::Pose& pose, uint32_t count, uint32_t seed);

}  // namespace lodestone::app
