// SPDX-License-Identifier: MIT
#include "lodestone/test_support/log_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "lodestone/test_support/svg_text.h"

namespace lodestone::test {
namespace {

constexpr double panel_width = 400, panel_height = 300, left = 64, right = 14, top = 34, bottom = 44,
                 legend_row = 22;
constexpr double legend_item = 190;
// Okabe and Ito's colours, which the colour-blind tell apart.
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#e69f00", "#56b4e9", "#000000"};

struct Range {
  double lo = 0, hi = 0;  // whole exponents
};

// The whole powers of `base` round all values of an axis.
template <class Value>
Range range_of(const std::vector<LogPanel>& panels, double base, Value value) {
  double lo = INFINITY, hi = -INFINITY;
  for (const LogPanel& panel : panels) {
    for (const Curve& curve : panel.curves) {
      for (const glm::dvec2& point : curve.points) {
        if (!(point.x > 0 && point.y > 0)) continue;
        const double exponent = std::log(value(point)) / std::log(base);
        lo = std::min(lo, exponent);
        hi = std::max(hi, exponent);
      }
    }
  }
  if (!(lo <= hi)) throw std::invalid_argument("nothing to plot: no value is above 0");
  constexpr double slack = 1e-6;  // a power of the base is its own bound, however its logarithm is rounded
  lo = std::floor(lo + slack);
  return {lo, std::max(std::ceil(hi - slack), lo + 1)};
}

std::string line(double x0, double y0, double x1, double y1, const char* colour) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\"/>\n", x0, y0, x1, y1, colour);
}

// A mark of a shape of its own for each colour.
std::string mark(double x, double y, size_t style) {
  const char* colour = colours[style % std::size(colours)];
  switch (style % 3) {
    case 0:
      return fmt::format("<circle class=\"mark\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", x, y,
                         colour);
    case 1:
      return fmt::format("<path class=\"mark\" d=\"M{:.1f} {:.1f}h6v6h-6z\" fill=\"{}\"/>\n", x - 3, y - 3,
                         colour);
    default:
      return fmt::format("<path class=\"mark\" d=\"M{:.1f} {:.1f}l4 7h-8z\" fill=\"{}\"/>\n", x, y - 4,
                         colour);
  }
}

std::string stroke(const std::string& path, bool guide, size_t style) {
  return guide
             ? fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#888\" stroke-dasharray=\"5 4\"/>\n", path)
             : fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>\n", path,
                           colours[style % std::size(colours)]);
}

using Styles = std::map<std::string, size_t>;  // by the name of a curve, in the order of the legend

std::string panel_svg(const LogPanel& panel, double x0, double y0, const Range& x_range,
                      const std::string& x_label, const Styles& styles) {
  const Range y_range = range_of({panel}, 10, [](const glm::dvec2& p) { return p.y; });
  const double width = panel_width - left - right, height = panel_height - top - bottom;
  const auto x_of = [&](double exponent) {
    return x0 + left + width * (exponent - x_range.lo) / (x_range.hi - x_range.lo);
  };
  const auto y_of = [&](double exponent) {
    return y0 + top + height * (y_range.hi - exponent) / (y_range.hi - y_range.lo);
  };
  std::string svg = svg_text(x0 + left, y0 + top - 12, "start", panel.title, " font-weight=\"bold\"");
  for (double e = x_range.lo; e <= x_range.hi; ++e) {
    svg += line(x_of(e), y_of(y_range.lo), x_of(e), y_of(y_range.hi), "#ddd");
    svg += svg_text(x_of(e), y_of(y_range.lo) + 16, "middle", fmt::format("{:g}", std::exp2(e)));
  }
  for (double e = y_range.lo; e <= y_range.hi; ++e) {
    svg += line(x_of(x_range.lo), y_of(e), x_of(x_range.hi), y_of(e), "#bbb");
    svg += svg_text(x_of(x_range.lo) - 6, y_of(e) + 4, "end", fmt::format("{:g}", std::pow(10, e)));
  }
  svg += svg_text(x0 + left + width / 2, y0 + panel_height - 10, "middle", x_label);
  for (const Curve& curve : panel.curves) {
    const size_t style = styles.at(curve.name);
    std::string path, marks;
    for (const glm::dvec2& point : curve.points) {
      if (!(point.x > 0 && point.y > 0)) continue;
      const double x = x_of(std::log2(point.x)), y = y_of(std::log10(point.y));
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
      if (!curve.guide) marks += mark(x, y, style);
    }
    if (!path.empty()) svg += stroke(path, curve.guide, style) + marks;
  }
  return svg;
}

}  // namespace

std::string log_plot(const std::vector<LogPanel>& panels, const std::string& x_label, uint32_t columns) {
  const Range x_range = range_of(panels, 2, [](const glm::dvec2& p) { return p.x; });
  const double width = panel_width * columns;
  const auto items_a_row = static_cast<size_t>(width / legend_item);
  Styles styles;
  std::string legend;
  for (const LogPanel& panel : panels) {
    for (const Curve& curve : panel.curves) {
      const size_t style = styles.size();
      if (!styles.emplace(curve.name, style).second) continue;
      const double x = 12 + legend_item * static_cast<double>(style % items_a_row);
      const double y = 18 + legend_row * static_cast<double>(style / items_a_row);
      legend += stroke(fmt::format("M{:.1f} {:.1f}h26", x, y - 4), curve.guide, style);
      if (!curve.guide) legend += mark(x + 13, y - 4, style);
      legend += svg_text(x + 32, y, "start", curve.name);
    }
  }
  const double legend_height =
      8 + legend_row * static_cast<double>((styles.size() + items_a_row - 1) / items_a_row);
  const size_t rows = (panels.size() + columns - 1) / columns;
  const double height = legend_height + panel_height * static_cast<double>(rows);
  std::string svg = legend;
  for (size_t i = 0; i < panels.size(); ++i) {
    svg +=
        panel_svg(panels[i], panel_width * static_cast<double>(i % columns),
                  legend_height + panel_height * static_cast<double>(i / columns), x_range, x_label, styles);
  }
  return svg_document(width, height, svg);
}

}  // namespace lodestone::test
