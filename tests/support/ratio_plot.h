// SPDX-License-Identifier: MIT
// Ratios as bars from 1 to the left and to the right over one logarithmic axis, as one SVG picture.
#pragma once

#include <string>
#include <vector>

namespace lodestone::test {

struct RatioBar {
  std::string name;
  double ratio;  // above 0
};

struct RatioGroup {
  std::string title;
  std::vector<RatioBar> bars;
};

// Groups one below the other, the axis marked at powers of 2. Throws std::invalid_argument where there is no
// bar or a ratio is not a number above 0.
std::string ratio_plot(const std::vector<RatioGroup>& groups, const std::string& label);

}  // namespace lodestone::test
