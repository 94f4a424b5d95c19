// SPDX-License-Identifier: MIT
// Curves over logarithmic axes, as one SVG picture of several panels.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace lodestone::test {

struct Curve {
  std::string name;
  std::vector<glm::dvec2>
      points;          // in the order they are joined; what is not above 0 has no place and is left out
  bool guide = false;  // dashed, grey, without marks: a slope to compare with
};

struct LogPanel {
  std::string title;
  std::vector<Curve> curves;
};

// Panels in rows of `columns` (at least 1), all over one x axis that is marked at powers of 2; y is marked at
// powers of 10, each panel over the decades its curves need. Curves that bear one name have one colour and
// mark, and stand in the legend once. Throws std::invalid_argument where no curve has a point.
std::string log_plot(const std::vector<LogPanel>& panels, const std::string& x_label, uint32_t columns);

}  // namespace lodestone::test
