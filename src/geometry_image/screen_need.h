// SPDX-License-Identifier: MIT
// How large what is near, and small what is far from the scene's cameras appears (Signal::screen).
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/scene/scene.h"

namespace lodestone::geometry_image {

// A camera of the scene in the rest pose.
struct ScreenView {
  glm::dvec3 origin, right, up, forward;  // of length 1
  bool perspective = true;
  double half_width = 1, half_height = 1;  // of the picture: at distance 1, or all over without perspective
};
// Of all nodes with a camera, in order. A camera without an aspect of its own sees 16 : 9. Throws
// Error(usage) where the scene has none.
std::vector<ScreenView> screen_views(const scene::Scene& scene);

// How many half heights of the picture a unit of length at that point is long, facing the camera; a quarter
// of it where the point is outside of the picture, for shadows and reflections may still show it.
double screen_size(const ScreenView& view, const glm::dvec3& point);

// Of each cell the largest size of its points in any view, as a fraction of the largest of all; at least
// 1/16, so that what is far away keeps its shape.
std::vector<double> screen_weights(const base_complex::BaseComplex& complex,
                                   const std::vector<ScreenView>& views);

}  // namespace lodestone::geometry_image
