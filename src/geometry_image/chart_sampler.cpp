// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/base/parallel.h"
#include "lodestone/base_complex/arc_places.h"

namespace lodestone::geometry_image {

using base_complex::Arc;
using base_complex::CellMap;
using base_complex::next;
using base_complex::Passage;
using base_complex::PlaceOnFace;

ChartSampler::ChartSampler(const base_complex::BaseComplex& complex, const scene::Assembly& assembly,
                           const std::vector<uint32_t>& welded, const std::vector<uint32_t>& triangles,
                           const std::vector<ChartSize>& sizes)
    : complex_(complex),
      mesh_(complex.mesh),
      assembly_(assembly),
      welded_(welded),
      triangles_(triangles),
      sizes_(sizes),
      places_(complex.arcs.size()),
      arc_samples_(complex.arcs.size()),
      point_owner_(complex.mesh.points(), base_complex::none) {
  constexpr uint64_t arcs_a_task = 64;
  const std::vector<uint32_t> segments = arc_segments(complex, sizes);
  const base_complex::ArcSmoother smoother(complex);
  parallel_for(complex.arcs.size(), arcs_a_task, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const Arc& arc = complex.arcs[i];
      places_[i] = arc_places(complex, static_cast<uint32_t>(i), segments[i]);
      uint32_t edge = 0;
      double walked = 0;
      const auto length = [&](size_t e) {
        return glm::distance(mesh_.position(arc.points[e]), mesh_.position(arc.points[e + 1]));
      };
      const std::vector<PlaceOnFace> moved = smoother.smooth(static_cast<uint32_t>(i), places_[i]);
      for (size_t k = 0; k < moved.size(); ++k) {
        const double place = places_[i][k];
        while (edge + 2 < arc.points.size() && walked + length(edge) <= place) walked += length(edge++);
        const double step = length(edge);
        arc_samples_[i].push_back(
            {edge, step > 0 ? std::clamp((place - walked) / step, 0.0, 1.0) : 0.0, moved[k]});
      }
    }
  });
  for (uint32_t h = 3 * mesh_.faces(); h-- > 0;) point_owner_[mesh_.from(h)] = h;
}

base_complex::Rectangle ChartSampler::rectangle(uint32_t cell) const {
  base_complex::Rectangle rectangle;
  rectangle.width = sizes_[cell].width;
  rectangle.height = sizes_[cell].height;
  rectangle.segments.assign(sizes_[cell].segments.begin(), sizes_[cell].segments.end());
  for (const Passage& passage : complex_.cells[cell].boundary)
    rectangle.places.push_back(places_[passage.arc]);
  return rectangle;
}

std::array<uint32_t, 3> ChartSampler::corners(uint32_t triangle) const {
  const glm::uvec4& t = assembly_.triangles[triangle];
  return {welded_[t.x], welded_[t.y], welded_[t.z]};
}
uint32_t ChartSampler::input_triangle(uint32_t half_edge) const {
  return triangles_[mesh_.triangle(base_complex::face_of(half_edge))];
}

// A sample as the triangle under a half-edge sees it.
SurfaceSample ChartSampler::seen(const SurfaceSample& sample, uint32_t half_edge) const {
  const uint32_t triangle = input_triangle(half_edge);
  return seen_from(sample, corners(sample.triangle), triangle, corners(triangle));
}

// All that share an edge or a point take the numbers from one of its triangles, whichever side they are on.
SurfaceSample ChartSampler::at_point(uint32_t half_edge) const {
  const uint32_t owner = point_owner_[mesh_.from(half_edge)];
  return seen(make_sample(input_triangle(owner), mesh_.barycentrics(owner)), half_edge);
}

// Sample `index` of the passage's arc, counted from the arc's own start. `run` are the half-edges of the
// passage.
SurfaceSample ChartSampler::on_passage(const Passage& passage, const std::vector<uint32_t>& run,
                                       uint32_t index) const {
  const ArcSample& sample = arc_samples_[passage.arc][index];
  if (sample.moved.face != base_complex::none) return in_face(sample.moved.face, sample.moved.barycentrics);
  const uint32_t h = passage.backwards ? run[run.size() - 1 - sample.edge] : run[sample.edge];
  // A half-edge starts at the near end of the arc's edge, or at its far end where the passage runs backwards.
  if (sample.fraction == 0) return at_point(passage.backwards ? next(h) : h);
  if (sample.fraction == 1) return at_point(passage.backwards ? h : next(h));
  const uint32_t owner = mesh_.edge_name(h);
  const uint32_t near = complex_.arcs[passage.arc].points[sample.edge];
  const double fraction = mesh_.from(owner) == near ? sample.fraction : 1 - sample.fraction;
  const glm::dvec3 at =
      mesh_.barycentrics(owner) * (1 - fraction) + mesh_.barycentrics(next(owner)) * fraction;
  return seen(make_sample(input_triangle(owner), at), h);
}

void ChartSampler::sample_border(uint32_t cell, std::vector<SurfaceSample>& samples) const {
  const uint32_t width = sizes_[cell].width, height = sizes_[cell].height, stride = width + 1;
  const auto place = [&](uint32_t along) -> size_t {  // counterclockwise from the first corner
    if (along < width) return along;
    along -= width;
    if (along < height) return size_t(along) * stride + width;
    along -= height;
    if (along < width) return size_t(height) * stride + (width - along);
    return size_t(height - (along - width)) * stride;
  };
  uint32_t along = 0;
  const std::vector<Passage>& boundary = complex_.cells[cell].boundary;
  for (size_t p = 0; p < boundary.size(); ++p) {
    std::vector<uint32_t> run = {boundary[p].first_half_edge};
    while (run.size() + 1 < complex_.arcs[boundary[p].arc].points.size())
      run.push_back(next_on_boundary(complex_, run.back()));
    const uint32_t fine = sizes_[cell].segments[p];
    const auto coarse = static_cast<uint32_t>(places_[boundary[p].arc].size() - 1);
    for (uint32_t i = 0; i < fine; ++i) {
      const auto nearest = static_cast<uint32_t>((2 * uint64_t(i) * coarse + fine) / (2 * uint64_t(fine)));
      samples[place(along + i)] =
          on_passage(boundary[p], run, boundary[p].backwards ? coarse - nearest : nearest);
    }
    along += fine;
  }
}

SurfaceSample ChartSampler::in_face(uint32_t face, const glm::dvec3& at) const {
  const uint32_t h = 3 * face;
  return make_sample(input_triangle(h), mesh_.barycentrics(h) * at.x + mesh_.barycentrics(h + 1) * at.y +
                                            mesh_.barycentrics(h + 2) * at.z);
}

Facet ChartSampler::facet(const SurfaceSample& sample) const {
  const auto& [a, b, c] = corners(sample.triangle);
  const glm::dvec3 &pa = mesh_.position(a), &pb = mesh_.position(b), &pc = mesh_.position(c);
  const glm::dvec3 normal = glm::cross(pb - pa, pc - pa);
  const double length = glm::length(normal);
  const glm::dvec3 weights(sample.weights[0], sample.weights[1], sample.weights[2]);
  return {(pa * weights.x + pb * weights.y + pc * weights.z) / double(SurfaceSample::one),
          length > 0 ? normal / length : glm::dvec3(0)};
}

ChartSamples ChartSampler::sample(uint32_t cell, const CellMap& map, Folds folds) const {
  const uint32_t columns = sizes_[cell].width + 1, rows = sizes_[cell].height + 1;
  ChartSamples chart;
  chart.samples.resize(size_t(columns) * rows);
  chart.points = find_lattice(map, columns, rows, 1);
  sample_border(cell, chart.samples);
  const auto is_inner = [&](size_t i) {
    return i % columns != 0 && i % columns != columns - 1 && i / columns != 0 && i / columns != rows - 1;
  };
  std::vector<Facet> facets;
  for (size_t i = 0; i < chart.points.size(); ++i) {
    if (chart.points[i].face == base_complex::none) throw base_complex::NotMappable{};
    facets.push_back(is_inner(i) ? facet_at(complex_, cell, map, chart.points[i]) : facet(chart.samples[i]));
  }
  chart.folded = has_folds(columns, facets);
  if (chart.folded && folds == Folds::unfold) unfold(complex_, cell, map, columns, facets, chart.points);
  for (size_t i = 0; i < chart.points.size(); ++i) {
    if (!is_inner(i)) continue;
    const FacePoint& point = chart.points[i];
    chart.samples[i] = in_face(complex_.cells[cell].faces[point.face], point.barycentrics);
  }
  return chart;
}

uint64_t ChartSampler::repeated(uint32_t cell) const {
  uint64_t count = 0;
  const std::vector<Passage>& boundary = complex_.cells[cell].boundary;
  for (size_t p = 0; p < boundary.size(); ++p)
    count += sizes_[cell].segments[p] + 1 - places_[boundary[p].arc].size();
  return count;
}

}  // namespace lodestone::geometry_image
