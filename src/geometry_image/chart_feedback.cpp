// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_feedback.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodestone::geometry_image {

ChartFeedback::ChartFeedback(const base_complex::BaseComplex& complex,
                             const std::vector<ChartProfile>& profiles, const ArcErrors& arc_errors,
                             double tolerance, Need need)
    : complex_(complex),
      profiles_(profiles),
      arc_errors_(arc_errors),
      tolerance_(tolerance),
      need_(std::move(need)),
      finest_(complex.cells.size()) {
  need_.found.assign(complex.cells.size(), 0);
}

bool ChartFeedback::learn(const std::vector<ChartSize>& sizes, const std::vector<double>& errors) {
  const std::vector<uint32_t> segments = arc_segments(complex_, sizes);
  bool learnt = false;
  for (uint32_t c = 0; c < errors.size(); ++c) {
    const double known = std::max(tolerance_, error_of_firm_arcs(c, segments));
    const double found = learn_of(c, profiles_[c].spacing(sizes[c].width, sizes[c].height), errors[c], known);
    learnt = learnt || found != need_.found[c];
    need_.found[c] = found;
  }
  return learnt;
}

// Counted in full before, and no reason for closer samples inside the chart.
double ChartFeedback::error_of_firm_arcs(uint32_t chart, const std::vector<uint32_t>& segments) const {
  double most = 0;
  for (const base_complex::Passage& p : complex_.cells[chart].boundary)
    if (complex_.arcs[p.arc].firm) most = std::max(most, arc_errors_.error(p.arc, segments[p.arc]));
  return most;
}

double ChartFeedback::learn_of(uint32_t chart, double spacing, double error, double known) {
  constexpr double finer = 0.75, better = 0.9;
  // Of what was found some counts only: others must not become as coarse as this chart was.
  constexpr double share = 0.6, farthest = 0.5;
  Finest& last = finest_[chart];
  double found = need_.found[chart];
  if (error > known && spacing < finer * last.spacing && error > better * last.error) {
    last.in_vain = true;
    found = 0;
  } else if (error > known && !last.in_vain && error < spacing) {
    found = std::max(found, share * std::min(error / spacing, farthest));
  }
  if (spacing < last.spacing) {
    last.spacing = spacing;
    last.error = error;
  }
  return found;
}

double ChartFeedback::badness(const std::vector<double>& errors) const {
  constexpr double power = 8;
  double sum = 0;
  for (const double error : errors) sum += std::pow(error / tolerance_, power);
  return sum;
}

}  // namespace lodestone::geometry_image
