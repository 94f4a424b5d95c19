// SPDX-License-Identifier: MIT
// How far each mapped chart is from the surface that it resamples.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lodestone/layout/atlas.h"
#include "lodestone/mesh/surface.h"
#include "lodestone/mesh/triangle_tree.h"

namespace lodestone::geometry_image {

// Charts as rectangles of points, one after the other.
struct ChartPoints {
  std::span<const layout::ChartRecord> charts;  // first_texel: the first of its points
  std::span<const glm::vec3> points;
};

// Of each chart the farthest that the middle of a quad's edge, diagonal or triangle is from the input. The
// points themselves lie on it.
std::vector<double> errors_from_image(const ChartPoints& image, const mesh::TriangleTree& input);

// Of each chart the farthest that a corner or the middle of an input triangle is from all charts;
// `chart_of_triangle` says whose error that is (none: nobody's).
std::vector<double> errors_from_input(const mesh::Surface& input, std::span<const uint32_t> chart_of_triangle,
                                      const ChartPoints& image);

}  // namespace lodestone::geometry_image
