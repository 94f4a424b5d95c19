// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/sampled_charts.h"

#include <utility>

#include "lodestone/base/parallel.h"
#include "lodestone/base_complex/cell_map.h"
#include "lodestone/geometry_image/kept_map.h"

namespace lodestone::geometry_image {
namespace {

using base_complex::Cell;
using base_complex::CellMap;
using base_complex::NotMappable;

std::vector<uint32_t> what_it_depends_on(const Cell& cell, const ChartSize& size,
                                         const std::vector<uint32_t>& segments_of_arcs) {
  std::vector<uint32_t> numbers = {size.width, size.height};
  numbers.insert(numbers.end(), size.segments.begin(), size.segments.end());
  for (const base_complex::Passage& passage : cell.boundary) numbers.push_back(segments_of_arcs[passage.arc]);
  return numbers;
}

}  // namespace

std::vector<base_complex::TriangleShape> ChartSource::shapes(uint32_t cell) const {
  return metrics != nullptr ? metrics->of_cell(complex, triangles, cell) : face_shapes(complex, cell);
}

SampledCharts::SampledCharts(const ChartSource& source)
    : source_(source), charts_(source.complex.cells.size()) {}

std::vector<uint32_t> SampledCharts::resize(const std::vector<ChartSize>& sizes) {
  sizes_ = sizes;
  const ChartSampler sampler = this->sampler();
  const std::vector<uint32_t> segments = arc_segments(source_.complex, sizes);
  std::vector<uint8_t> remade(sizes.size(), 0), failed(sizes.size(), 0);
  parallel_for(sizes.size(), 1, [&](uint64_t begin, uint64_t end) {
    for (auto c = static_cast<uint32_t>(begin); c < end; ++c) {
      std::vector<uint32_t> made_for = what_it_depends_on(source_.complex.cells[c], sizes[c], segments);
      if (made_for == charts_[c].made_for) continue;
      remade[c] = 1;
      try {
        charts_[c] = make(sampler, c, Folds::leave);
        charts_[c].made_for = std::move(made_for);
      } catch (const NotMappable&) {
        charts_[c] = {};
        failed[c] = 1;
      }
    }
  });
  changed_.assign(remade.begin(), remade.end());
  records_.clear();
  uint32_t texels = 0;
  for (const ChartSize& size : sizes) {
    records_.push_back({texels, size.width + 1, size.height + 1, layout::chart_mapped, 0, 0, 0, 0});
    texels += static_cast<uint32_t>(size.texels());
  }
  std::vector<uint32_t> list;
  for (uint32_t c = 0; c < failed.size(); ++c)
    if (failed[c] != 0) list.push_back(c);
  return list;
}

ChartSampler SampledCharts::sampler() const {
  return {source_.complex, source_.assembly, source_.welded, source_.triangles, sizes_};
}

void SampledCharts::unfold() {
  const ChartSampler sampler = this->sampler();
  folded_.assign(charts_.size(), {});
  changed_.assign(charts_.size(), false);
  for (size_t c = 0; c < charts_.size(); ++c) changed_[c] = charts_[c].folded;
  parallel_for(charts_.size(), 1, [&](uint64_t begin, uint64_t end) {
    for (auto c = static_cast<uint32_t>(begin); c < end; ++c)
      if (changed_[c]) folded_[c] = std::exchange(charts_[c], make(sampler, c, Folds::unfold));
  });
}

void SampledCharts::fold_again(const std::vector<bool>& marked) {
  changed_ = marked;
  for (size_t c = 0; c < charts_.size(); ++c)
    if (marked[c]) charts_[c] = folded_[c];
}

SampledCharts::Chart SampledCharts::make(const ChartSampler& sampler, uint32_t cell, Folds folds) const {
  const base_complex::BaseComplex& complex = source_.complex;
  const ChartSize& size = sizes_[cell];
  Chart chart;
  const CellMap map = map_cell(complex, cell, sampler.rectangle(cell), source_.shapes(cell), {});
  chart.stretch = chart_stretch(map, face_shapes(complex, cell), uint64_t(size.width) * size.height);
  chart.texels.reserve(size.texels());
  const ChartSamples sampled = sampler.sample(cell, map, folds);
  for (const SurfaceSample& at : sampled.samples) chart.texels.push_back(at.texel(cell));
  chart.folded = sampled.folded;
  chart.repeated_texels = sampler.repeated(cell);
  if (source_.keep_maps)
    chart.maps = keep_map(complex, cell, map, source_.triangles, sampled.points, size.width + 1);
  return chart;
}

std::vector<glm::uvec4> SampledCharts::texels() const {
  std::vector<glm::uvec4> all;
  for (const Chart& chart : charts_) all.insert(all.end(), chart.texels.begin(), chart.texels.end());
  return all;
}

MappedCharts SampledCharts::result() const {
  MappedCharts result;
  result.charts = records_;
  result.texels = texels();
  std::vector<ChartStretch> stretch;
  for (const Chart& chart : charts_) {
    result.maps.append(chart.maps);
    result.repeated_texels += chart.repeated_texels;
    stretch.push_back(chart.stretch);
  }
  const StretchSummary summary = sum_up(stretch);
  result.mean_stretch = summary.mean;
  result.high_stretch = summary.high;
  return result;
}

}  // namespace lodestone::geometry_image
