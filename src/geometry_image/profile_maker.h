// SPDX-License-Identifier: MIT
// The profiles of charts: each is mapped with nothing yet decided, and sampled finely.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base_complex/base_complex.h"
#include "lodestone/base_complex/cell_map.h"
#include "lodestone/geometry_image/chart_profile.h"

namespace lodestone::geometry_image {

class ProfileMaker {
 public:
  // Charts are sampled four times as densely as `texel_budget` texels for all of them would be. The complex
  // must outlive it.
  ProfileMaker(const base_complex::BaseComplex& complex, uint64_t texel_budget);

  // `shapes`: see map_cell, which also says what it throws. Any number of threads may ask at once.
  ChartProfile make(uint32_t cell, std::vector<base_complex::TriangleShape> shapes) const;

 private:
  std::vector<FirmArc> lay_out(const base_complex::Cell& cell, base_complex::Rectangle& rectangle) const;

  const base_complex::BaseComplex& complex_;
  double spacing_ = 0;
};

}  // namespace lodestone::geometry_image
