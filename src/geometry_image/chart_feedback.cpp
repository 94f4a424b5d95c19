// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_feedback.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodestone::geometry_image {

ChartFeedback::ChartFeedback(const base_complex::BaseComplex& complex, const ArcErrors& arc_errors,
                             double tolerance, Need need)
    : complex_(complex),
      arc_errors_(arc_errors),
      tolerance_(tolerance),
      need_(std::move(need)),
      tried_(complex.cells.size()) {
  need_.fixed.assign(complex.cells.size(), {});
  need_.found.resize(complex.cells.size(), 0);
}

bool ChartFeedback::learn(const std::vector<ChartSize>& sizes, const std::vector<double>& errors) {
  const std::vector<uint32_t> segments = arc_segments(complex_, sizes);
  bool learnt = false;
  for (uint32_t c = 0; c < errors.size(); ++c) {
    const double known = std::max(tolerance_, error_of_firm_arcs(c, segments));
    const double found = need_.found[c];
    const Quads fixed = need_.fixed[c];
    learn_of(c, {sizes[c].width, sizes[c].height}, errors[c], known);
    learnt = learnt || found != need_.found[c] || fixed != need_.fixed[c];
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

// The need of a chart that is too far grows step by step: all share one budget, and who asks for too much
// makes others coarse. Where it was enough, or does not help any more, the size is settled. Without that all
// sizes would change with all needs, errors with them, and attempts would not get better.
void ChartFeedback::learn_of(uint32_t chart, Quads size, double error, double known) {
  constexpr double growth = 0.8;  // exponent
  constexpr double most = 0.3, better = 0.95;
  constexpr uint32_t patience = 3;
  Tried& tried = tried_[chart];
  double& found = need_.found[chart];
  Quads& fixed = need_.fixed[chart];
  if (error < better * tried.least_error) {
    tried.least_error = error;
    tried.best = size;
    tried.in_vain = 0;
  } else if (error > known && size != tried.last) {
    ++tried.in_vain;
  }
  tried.last = size;
  if (error <= known) {
    if (found > 0) fixed = size;
  } else if (tried.in_vain >= patience) {
    fixed = tried.best;
  } else {
    fixed = {};
    found = std::min(most, std::max(found, need_.flattest) * std::pow(error / known, growth));
  }
}

double ChartFeedback::badness(const std::vector<double>& errors) const {
  constexpr double power = 16;
  double sum = 0;
  for (const double error : errors) sum += error > 0 ? std::pow(error / tolerance_, power) : 0.0;
  return sum;
}

std::vector<uint32_t> ChartFeedback::always_far(const std::vector<double>& errors) const {
  std::vector<uint32_t> list;
  for (uint32_t c = 0; c < errors.size(); ++c)
    if (errors[c] > tolerance_ && tried_[c].least_error > tolerance_) list.push_back(c);
  return list;
}

}  // namespace lodestone::geometry_image
