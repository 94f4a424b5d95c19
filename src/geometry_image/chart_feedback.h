// SPDX-License-Identifier: MIT
// What one attempt at an atlas teaches for the next: which charts are farther from the surface than was
// expected of samples so close, and need more of them.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/geometry_image/arc_errors.h"
#include "lodestone/geometry_image/chart_sizes.h"

namespace lodestone::geometry_image {

class ChartFeedback {
 public:
  // What is farther than `tolerance` is too far. All that is referred to must outlive it.
  ChartFeedback(const base_complex::BaseComplex& complex, const ArcErrors& arc_errors, double tolerance,
                Need need);

  const Need& need() const { return need_; }

  // Takes how far each chart is from the surface with these sizes. False where that changes nothing.
  bool learn(const std::vector<ChartSize>& sizes, const std::vector<double>& errors);

  // Of an attempt, the less the better: what is too far counts the more the farther it is.
  double badness(const std::vector<double>& errors) const;

  // Of the same attempt, charts that are too far and that closer samples do not help: their cells are to
  // blame.
  std::vector<uint32_t> hopeless(const std::vector<double>& errors) const;

 private:
  // The attempt that later ones are compared with, to see whether closer samples help.
  struct Before {
    uint64_t quads = 0;
    double error = std::numeric_limits<double>::infinity();
    double found = 0;       // its need
    bool in_vain = false;   // they did not: its need stays
    double too_little = 0;  // the greatest need of any attempt that was too far
  };
  double error_of_firm_arcs(uint32_t chart, const std::vector<uint32_t>& segments) const;
  double learn_of(uint32_t chart, uint64_t quads, double error, double known);

  const base_complex::BaseComplex& complex_;
  const ArcErrors& arc_errors_;
  const double tolerance_;
  Need need_;
  std::vector<Before> before_;  // of each chart
};

}  // namespace lodestone::geometry_image
