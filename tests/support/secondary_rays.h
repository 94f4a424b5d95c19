// SPDX-License-Identifier: MIT
// The rays behind a camera's: through its lens, and those that a surface sends on.
#pragma once

#include "lodestone/test_support/rays.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {

// One through each pixel as primary_rays(view, size) has them, from a random point of a lens of `radius`,
// sharp at `focus` along the view's direction. Needs a perspective view.
Rays lens_rays(const render::View& view, uint32_t size, float focus, float radius, uint32_t seed);

// Of rays that hit (Renderer::hits() of `ready` at `pose`): one reflection each about a microfacet drawn from
// GGX's distribution of this roughness (alpha: its square) round the interpolated normal, in the order of the
// hits. Hits from behind and reflections into the surface send none on.
Rays glossy_rays(const Rays& rays, const std::vector<glm::uvec4>& hits, const ReadyScene& ready,
                 const scene::Pose& pose, float roughness, uint32_t seed);

}  // namespace lodestone::test
