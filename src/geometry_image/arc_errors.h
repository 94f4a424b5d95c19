// SPDX-License-Identifier: MIT
// How far arcs are from their samples, for any number of those.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/base_complex.h"

namespace lodestone::geometry_image {

class ArcErrors {
 public:
  explicit ArcErrors(const base_complex::BaseComplex& complex);

  // The distance (see base_complex::arc_error) with `segments` segments, at least 1, or with somewhat fewer
  // where there are many.
  double error(uint32_t arc, uint32_t segments) const;

 private:
  std::vector<std::vector<double>> errors_;  // of each arc, by number of segments as they are tried
};

}  // namespace lodestone::geometry_image
