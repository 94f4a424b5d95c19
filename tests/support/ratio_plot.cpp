// SPDX-License-Identifier: MIT
#include "lodestone/test_support/ratio_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lodestone/test_support/svg_text.h"

namespace lodestone::test {
namespace {

constexpr double width = 800, names = 290, right = 60, row = 20, title_row = 26, axis = 40;

struct Axis {
  double lo = 0, hi = 0;  // whole powers of 2, 1 within
  double place(double exponent) const {
    return names + (width - names - right) * (exponent - lo) / (hi - lo);
  }
};

Axis axis_of(const std::vector<RatioGroup>& groups) {
  Axis axis_range;
  size_t bars = 0;
  for (const RatioGroup& group : groups) {
    for (const RatioBar& bar : group.bars) {
      if (!(bar.ratio > 0 && std::isfinite(bar.ratio)))
        throw std::invalid_argument(bar.name + ": a ratio is a number above 0");
      axis_range.lo = std::min(axis_range.lo, std::floor(std::log2(bar.ratio)));
      axis_range.hi = std::max(axis_range.hi, std::ceil(std::log2(bar.ratio)));
      ++bars;
    }
  }
  if (bars == 0) throw std::invalid_argument("nothing to plot: there is no bar");
  if (axis_range.lo == axis_range.hi) axis_range.hi += 1;
  return axis_range;
}

std::string bar_svg(const RatioBar& bar, double y, const Axis& axis_range) {
  const double one = axis_range.place(0), end = axis_range.place(std::log2(bar.ratio));
  const double from = std::min(one, end), length = std::abs(end - one);
  return svg_text(names - 8, y + 14, "end", bar.name) +
         fmt::format("<path class=\"bar\" d=\"M{:.1f} {:.1f}h{:.1f}v13h-{:.1f}z\" fill=\"{}\"/>\n", from,
                     y + 3, length, length, bar.ratio < 1 ? "#d55e00" : "#0072b2") +
         svg_text(std::max(one, end) + 5, y + 14, "start", fmt::format("{:.2f}", bar.ratio));
}

}  // namespace

std::string ratio_plot(const std::vector<RatioGroup>& groups, const std::string& label) {
  const Axis axis_range = axis_of(groups);
  std::string bars;
  double y = 6;
  for (const RatioGroup& group : groups) {
    bars += svg_text(12, y + 18, "start", group.title, " font-weight=\"bold\"");
    y += title_row;
    for (const RatioBar& bar : group.bars) {
      bars += bar_svg(bar, y, axis_range);
      y += row;
    }
  }
  std::string grid;
  for (double e = axis_range.lo; e <= axis_range.hi; ++e) {
    grid += fmt::format("<path d=\"M{0:.1f} 6V{1:.1f}\" stroke=\"{2}\"/>\n", axis_range.place(e), y,
                        e == 0 ? "#444" : "#ddd");
    grid += svg_text(axis_range.place(e), y + 16, "middle", fmt::format("{:g}", std::exp2(e)));
  }
  grid += svg_text((names + width - right) / 2, y + 33, "middle", label);
  return svg_document(width, y + axis, grid + bars);
}

}  // namespace lodestone::test
