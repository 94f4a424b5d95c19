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

std::vector<FacePoint> find_lattice(const CellMap& map, uint32_t columns, uint32_t rows, double spacing) {
  constexpr double slack = 1e-6;
  std::vector<FacePoint> points(size_t(columns) * rows);
  std::vector<double> inside(points.size(), -std::numeric_limits<double>::infinity());
  for (uint32_t f = 0; f < map.faces.size(); ++f) {
    const glm::dvec2 a = map.at[map.faces[f][0]] / spacing, b = map.at[map.faces[f][1]] / spacing,
                     c = map.at[map.faces[f][2]] / spacing;
    const glm::dvec2 lo = glm::max(glm::min(a, glm::min(b, c)) - slack, 0.0);
    const glm::dvec2 hi = glm::max(a, glm::max(b, c)) + slack;
    const double det = base_complex::cross(b - a, c - a);
    if (!(det > 0)) continue;
    for (auto y = static_cast<uint32_t>(std::ceil(lo.y)); y < rows && y <= hi.y; ++y) {
      for (auto x = static_cast<uint32_t>(std::ceil(lo.x)); x < columns && x <= hi.x; ++x) {
        const glm::dvec2 p(x, y);
        const double b1 = base_complex::cross(p - a, c - a) / det,
                     b2 = base_complex::cross(b - a, p - a) / det;
        const glm::dvec3 at(1 - b1 - b2, b1, b2);
        const double margin = std::min({at.x, at.y, at.z});
        const size_t i = size_t(y) * columns + x;
        if (margin <= inside[i]) continue;
        inside[i] = margin;
        points[i] = {f, glm::max(at, glm::dvec3(0))};
      }
    }
  }
  return points;
}

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
  parallel_for(complex.arcs.size(), arcs_a_task, [&](uint64_t begin, uint64_t end) {
    for (uint64_t i = begin; i < end; ++i) {
      const Arc& arc = complex.arcs[i];
      places_[i] = arc_places(complex, static_cast<uint32_t>(i), segments[i]);
      uint32_t edge = 0;
      double walked = 0;
      const auto length = [&](size_t e) {
        return glm::distance(mesh_.position(arc.points[e]), mesh_.position(arc.points[e + 1]));
      };
      for (const double place : places_[i]) {
        while (edge + 2 < arc.points.size() && walked + length(edge) <= place) walked += length(edge++);
        const double step = length(edge);
        arc_samples_[i].push_back({edge, step > 0 ? std::clamp((place - walked) / step, 0.0, 1.0) : 0.0});
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

std::vector<SurfaceSample> ChartSampler::sample(uint32_t cell, const CellMap& map) const {
  const uint32_t columns = sizes_[cell].width + 1, rows = sizes_[cell].height + 1;
  std::vector<SurfaceSample> samples(size_t(columns) * rows);
  const std::vector<FacePoint> found = find_lattice(map, columns, rows, 1);
  for (size_t i = 0; i < found.size(); ++i) {
    if (found[i].face == base_complex::none) throw base_complex::NotMappable{};
    const uint32_t h = 3 * complex_.cells[cell].faces[found[i].face];
    const glm::dvec3& at = found[i].barycentrics;
    samples[i] =
        make_sample(input_triangle(h), mesh_.barycentrics(h) * at.x + mesh_.barycentrics(h + 1) * at.y +
                                           mesh_.barycentrics(h + 2) * at.z);
  }
  sample_border(cell, samples);
  return samples;
}

uint64_t ChartSampler::repeated(uint32_t cell) const {
  uint64_t count = 0;
  const std::vector<Passage>& boundary = complex_.cells[cell].boundary;
  for (size_t p = 0; p < boundary.size(); ++p)
    count += sizes_[cell].segments[p] + 1 - places_[boundary[p].arc].size();
  return count;
}

}  // namespace lodestone::geometry_image
