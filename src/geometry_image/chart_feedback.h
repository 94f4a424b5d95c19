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

  // Of the same attempt, charts that are too far and were so in all before.
  std::vector<uint32_t> always_far(const std::vector<double>& errors) const;

 private:
  struct Tried {
    double least_error = std::numeric_limits<double>::infinity();
    Quads best;            // with which that was
    Quads last;            // of the last attempt
    uint32_t in_vain = 0;  // other sizes since the best that were still too far
  };
  double error_of_firm_arcs(uint32_t chart, const std::vector<uint32_t>& segments) const;
  void learn_of(uint32_t chart, Quads size, double error, double known);

  const base_complex::BaseComplex& complex_;
  const ArcErrors& arc_errors_;
  const double tolerance_;
  Need need_;
  std::vector<Tried> tried_;  // of each chart
};

}  // namespace lodestone::geometry_image
