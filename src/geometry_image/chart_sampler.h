// SPDX-License-Identifier: MIT
// The samples of mapped charts. What lies on an arc is worked out once for the arc and seen from all the
// charts beside it, so their borders are equal to the bit; everything else is where the chart's map says.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lodestone/base_complex/arc_smoothing.h"
#include "lodestone/base_complex/base_complex.h"
#include "lodestone/base_complex/cell_map.h"
#include "lodestone/geometry_image/chart_sizes.h"
#include "lodestone/geometry_image/map_lookup.h"
#include "lodestone/geometry_image/surface_sample.h"
#include "lodestone/geometry_image/unfold.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

struct ChartSamples {
  std::vector<SurfaceSample> samples;  // (width + 1) x (height + 1), row by row
  std::vector<FacePoint> points;       // of the inner ones, where they are in the map
  bool folded = false;                 // as unfold.h says
};
enum class Folds { leave, unfold };

class ChartSampler {
 public:
  // All must outlive it. `triangles` are those of the assembly that the complex was made of.
  ChartSampler(const base_complex::BaseComplex& complex, const scene::Assembly& assembly,
               const std::vector<uint32_t>& welded, const std::vector<uint32_t>& triangles,
               const std::vector<ChartSize>& sizes);

  // Where the boundary of a cell must go for its samples to be those of its arcs.
  base_complex::Rectangle rectangle(uint32_t cell) const;

  // Where the map has them, unless that folds the quads between them and they are to be unfolded. Throws
  // NotMappable where one is in no face.
  ChartSamples sample(uint32_t cell, const base_complex::CellMap& map, Folds folds) const;

  // Samples on the chart's border that repeat their neighbour, because the chart beside it is coarser.
  uint64_t repeated(uint32_t cell) const;

 private:
  struct ArcSample {
    uint32_t edge;  // of the arc, from its start
    double fraction;
    base_complex::PlaceOnFace moved;  // counts instead if it has a face
  };

  std::array<uint32_t, 3> corners(uint32_t triangle) const;
  uint32_t input_triangle(uint32_t half_edge) const;
  SurfaceSample seen(const SurfaceSample& sample, uint32_t half_edge) const;
  SurfaceSample at_point(uint32_t half_edge) const;
  SurfaceSample on_passage(const base_complex::Passage& passage, const std::vector<uint32_t>& run,
                           uint32_t index) const;
  SurfaceSample in_face(uint32_t face, const glm::dvec3& at) const;
  Facet facet(const SurfaceSample& sample) const;
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
