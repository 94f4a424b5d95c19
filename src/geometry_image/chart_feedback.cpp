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
      before_(complex.cells.size()) {
  need_.found.assign(complex.cells.size(), 0);
}

bool ChartFeedback::learn(const std::vector<ChartSize>& sizes, const std::vector<double>& errors) {
  const std::vector<uint32_t> segments = arc_segments(complex_, sizes);
  bool learnt = false;
  for (uint32_t c = 0; c < errors.size(); ++c) {
    const double known = std::max(tolerance_, error_of_firm_arcs(c, segments));
    const double found = learn_of(c, uint64_t(sizes[c].width) * sizes[c].height, errors[c], known);
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

// The need of a chart that is too far grows step by step, and falls slowly where it was more than enough: all
// share one budget, and who asks for too much makes others coarse.
double ChartFeedback::learn_of(uint32_t chart, uint64_t quads, double error, double known) {
  constexpr double growth = 0.8;  // exponent
  constexpr double most = 0.3, enough = 0.7, decay = 0.9;
  constexpr uint64_t many = 3;  // times as many quads
  constexpr double better = 0.9;
  Before& before = before_[chart];
  const double found = need_.found[chart];
  if (before.in_vain) return found;
  if (quads >= many * before.quads) {
    if (error > known && error > better * before.error) {
      before.in_vain = true;
      return before.found;
    }
    before.quads = quads;
    before.error = error;
    before.found = found;
  }
  if (error > known) {
    before.too_little = std::max(before.too_little, found);
    return std::min(most, std::max(found, need_.flattest) * std::pow(error / known, growth));
  }
  return error < enough * known && decay * found > before.too_little ? decay * found : found;
}

double ChartFeedback::badness(const std::vector<double>& errors) const {
  constexpr double power = 16;
  double sum = 0;
  for (const double error : errors) sum += error > 0 ? std::pow(error / tolerance_, power) : 0.0;
  return sum;
}

std::vector<uint32_t> ChartFeedback::hopeless(const std::vector<double>& errors) const {
  std::vector<uint32_t> list;
  for (uint32_t c = 0; c < errors.size(); ++c)
    if (errors[c] > tolerance_ && before_[c].in_vain) list.push_back(c);
  return list;
}

}  // namespace lodestone::geometry_image
