// SPDX-License-Identifier: MIT
// The charts of a base complex, sampled with one set of sizes after another. What a new set leaves as it was
// is kept: between two attempts most charts do not change.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/geometry_image/chart_sampler.h"
#include "lodestone/geometry_image/chart_sizes.h"
#include "lodestone/geometry_image/chart_stretch.h"
#include "lodestone/geometry_image/mapped_charts.h"
#include "lodestone/geometry_image/shape_metrics.h"
#include "lodestone/scene/assembly.h"

namespace lodestone::geometry_image {

// What charts are made of. All must outlive what refers to it.
struct ChartSource {
  const base_complex::BaseComplex& complex;
  const scene::Assembly& assembly;
  const std::vector<uint32_t>& welded;
  const std::vector<uint32_t>& triangles;  // those of the assembly that the complex was made of
  const ShapeMetrics* metrics = nullptr;   // what maps have little stretch for; null: the rest pose
  bool keep_maps = false;

  std::vector<base_complex::TriangleShape> shapes(uint32_t cell) const;  // of the cell's faces
};

class SampledCharts {
 public:
  explicit SampledCharts(const ChartSource& source);
  const ChartSource& source() const { return source_; }

  // Makes those charts anew that the sizes change. Returns the cells that could not be mapped, ascending; if
  // there are any, only resize() may be called next.
  std::vector<uint32_t> resize(const std::vector<ChartSize>& sizes);

  // Unfolds the samples (unfold.h) of all charts that have folds. Comes last: resize() would not know.
  void unfold();
  // Takes that back for the marked charts.
  void fold_again(const std::vector<bool>& marked);

  // Which charts the last of these calls made anew.
  const std::vector<bool>& changed() const { return changed_; }
  const ChartStretch& stretch(uint32_t chart) const { return charts_[chart].stretch; }
  // Of all charts, one after the other.
  const std::vector<layout::ChartRecord>& records() const { return records_; }
  std::vector<glm::uvec4> texels() const;

  MappedCharts result() const;  // without what was left out

 private:
  struct Chart {
    // The sizes of the chart and of its arcs: what its samples depend on.
    std::vector<uint32_t> made_for;
    std::vector<glm::uvec4> texels;
    ChartStretch stretch;
    ChartMaps maps;
    uint64_t repeated_texels = 0;
    bool folded = false;
  };
  ChartSampler sampler() const;
  Chart make(const ChartSampler& sampler, uint32_t cell, Folds folds) const;

  const ChartSource source_;
  std::vector<ChartSize> sizes_;
  std::vector<Chart> charts_, folded_;  // `folded_`: those that unfold() made anew, as they were
  std::vector<layout::ChartRecord> records_;
  std::vector<bool> changed_;
};

}  // namespace lodestone::geometry_image
