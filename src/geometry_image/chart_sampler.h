// SPDX-License-Identifier: MIT
// The samples of mapped charts. What lies on an arc is worked out once for the arc and seen from all the
// charts beside it, so their borders are equal to the bit; everything else is where the chart's map says.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/base_complex/cell_map.h"
#include "lodestone/geometry_image/chart_sizes.h"
#include "lodestone/geometry_image/surface_sample.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

// Of each point of a lattice (row by row, columns x rows of them, `spacing` apart in the rectangle of the
// map) the face of the map that holds it, or comes nearest to, for numbers are rounded; and where in that
// face.
struct FacePoint {
  uint32_t face = base_complex::none;  // index into CellMap::faces
  glm::dvec3 barycentrics{0};          // none below 0
};
std::vector<FacePoint> find_lattice(const base_complex::CellMap& map, uint32_t columns, uint32_t rows,
                                    double spacing);

class ChartSampler {
 public:
  // All must outlive it. `triangles` are those of the assembly that the complex was made of.
  ChartSampler(const base_complex::BaseComplex& complex, const scene::Assembly& assembly,
               const std::vector<uint32_t>& welded, const std::vector<uint32_t>& triangles,
               const std::vector<ChartSize>& sizes);

  // Where the boundary of a cell must go for its samples to be those of its arcs.
  base_complex::Rectangle rectangle(uint32_t cell) const;

  // (width + 1) x (height + 1) samples, row by row.
  std::vector<SurfaceSample> sample(uint32_t cell, const base_complex::CellMap& map) const;

  // Samples on the chart's border that repeat their neighbour, because the chart beside it is coarser.
  uint64_t repeated(uint32_t cell) const;

 private:
  struct ArcSample {
    uint32_t edge;  // of the arc, from its start
    double fraction;
  };

  std::array<uint32_t, 3> corners(uint32_t triangle) const;
  uint32_t input_triangle(uint32_t half_edge) const;
  SurfaceSample seen(const SurfaceSample& sample, uint32_t half_edge) const;
  SurfaceSample at_point(uint32_t half_edge) const;
  SurfaceSample on_passage(const base_complex::Passage& passage, const std::vector<uint32_t>& run,
                           uint32_t index) const;
  void sample_border(uint32_t cell, std::vector<SurfaceSample>& samples) const;

  const base_complex::BaseComplex& complex_;
  const base_complex::HalfEdgeMesh& mesh_;
  const scene::Assembly& assembly_;
  const std::vector<uint32_t>&welded_, &triangles_;
  const std::vector<ChartSize>& sizes_;
  std::vector<std::vector<double>> places_;          // of each arc, the distances of its samples
  std::vector<std::vector<ArcSample>> arc_samples_;  // and the samples
  std::vector<uint32_t> point_owner_;                // of each point a half-edge that starts there
};

}  // namespace lodestone::geometry_image
