// SPDX-License-Identifier: MIT
#include "lodestone/app/atlas_text.h"

#include <fmt/format.h>

namespace lodestone::app {

double texels_used(const geometry_image::Atlas& atlas) {
  const double texels = double(atlas.report.texels);
  return texels > 0 ? 100 * (texels - double(atlas.report.repeated_texels)) / texels : 0.0;
}

std::string atlas_text(const std::string& name, const geometry_image::Atlas& atlas,
                       const std::optional<geometry_image::Fidelity>& fidelity) {
  constexpr double percent = 100;
  const geometry_image::AtlasReport& report = atlas.report;
  std::string text = fmt::format("{}: {} charts, {} quads, {} texels\n", name, atlas.charts.size(),
                                 report.quads, report.texels);
  if (report.mapped_charts > 0) {
    text +=
        fmt::format("  resampled        {} triangles in {} charts, one for {:.1f}\n", report.mapped_triangles,
                    report.mapped_charts, double(report.mapped_triangles) / double(report.mapped_charts));
    text += fmt::format("  texels used      {:.1f} %\n", texels_used(atlas));
    text += fmt::format("  L2 stretch       mean {:.3f}, 95th percentile {:.3f}\n", report.mean_stretch,
                        report.high_stretch);
  }
  if (!atlas.maps.empty()) text += fmt::format("  maps             {} bytes\n", atlas.maps.bytes());
  if (!fidelity) return text;
  text += fmt::format(
      "  distance         {:.4f} % from the input, {:.4f} % from the geometry image, Hausdorff {:.4f} %\n",
      percent * fidelity->from_input, percent * fidelity->from_image, percent * fidelity->hausdorff());
  text +=
      fmt::format("                   mean {:.4f} %, root mean square {:.4f} % (of the diagonal, {:.4g})\n",
                  percent * fidelity->mean, percent * fidelity->root_mean_square, fidelity->diagonal);
  return text;
}

}  // namespace lodestone::app
