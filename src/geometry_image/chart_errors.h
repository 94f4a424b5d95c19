// SPDX-License-Identifier: MIT
// How far each mapped chart is from the surface that it resamples, for one set of charts after another: what
// cannot have changed since the last is not measured again.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/layout/atlas.h"
#include "lodestone/mesh/surface.h"
#include "lodestone/mesh/triangle_tree.h"

namespace lodestone::geometry_image {

// Charts as rectangles of points, one after the other.
struct ChartPoints {
  std::span<const layout::ChartRecord> charts;  // first_texel: the first of its points
  std::span<const glm::vec3> points;
};

class ChartErrors {
 public:
  // The complex is one of the input's triangles, in their order. All must outlive it. Charts are measured
  // at the middles of their triangles and of their edges, and where these are farther than `apart` (at least
  // 0) from each other at points between them; the input at corners and middles of triangles, and long ones
  // likewise at points between.
  ChartErrors(const base_complex::BaseComplex& complex, const mesh::Surface& input,
              const mesh::TriangleTree& input_tree, double apart);

  // Of each chart the farthest that a point of its triangles is from the input, or a point of one of its
  // input triangles from all charts. `changed` says which charts are not those of the last call; a triangle
  // counts if it is near one that changed.
  const std::vector<double>& measure(const ChartPoints& image, const std::vector<bool>& changed);

 private:
  void measure_image(const ChartPoints& image, const std::vector<bool>& changed);
  void measure_input(const ChartPoints& image, const std::vector<bool>& changed);

  const mesh::Surface input_;
  const mesh::TriangleTree& input_tree_;
  const double apart_;
  std::vector<std::vector<uint32_t>> neighbours_;  // of each chart: those beside it and itself
  std::vector<std::vector<uint32_t>> triangles_;   // of each chart: those of which it has a piece
  std::vector<uint32_t> chart_of_triangle_;        // the one that answers for it
  std::vector<double> of_image_, of_triangle_, errors_;
};

}  // namespace lodestone::geometry_image
