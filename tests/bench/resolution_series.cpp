// SPDX-License-Identifier: MIT
// Figure 11 of the paper: how the error of resampled meshes falls as their resolution rises, as a table and
// as a plot. resolution_series [--scenes armadillo.obj,...] [--resolutions 32,64,...] [--csv FILE] [--svg
// FILE] [--parts FOLDER]
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "lodestone/base/file.h"
#include "lodestone/scene/load.h"
#include "lodestone/test_support/bench_main.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/log_plot.h"
#include "lodestone/test_support/markdown_table.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/resolution_series.h"

namespace lodestone::test {
namespace {

struct Choice {
  std::vector<std::string> scenes{"armadillo.obj", "stanford_bunny.obj",  "spot.obj",
                                  "scallop.glb",   "ict_face_sparse.glb", "counter_assembly.stl"};
  std::vector<uint32_t> resolutions{32, 64, 128, 256, 512};
  SeriesPicture picture;
  std::string device = "cpu", csv, svg, parts;
};

struct Measure {
  const char* title;
  double SeriesPoint::*value;
};
constexpr size_t pixel_error = 2;
constexpr Measure measures[] = {
    {"Hausdorff distance (% of the diagonal)", &SeriesPoint::hausdorff},
    {"Root mean square distance (% of the diagonal)", &SeriesPoint::root_mean_square},
    {"Mean pixel error (% of white)", &SeriesPoint::pixel_error},
    {"Mean FLIP error (%)", &SeriesPoint::flip}};

// As many texels as the charts have, as the side of a square: what a figure's resolution means.
double side(const SeriesPoint& point) {
  return std::sqrt(static_cast<double>(point.texels));
}

// From the top of a panel down, to the square: what smooth surfaces should do between straight pieces.
Curve square_guide(const std::vector<Curve>& curves) {
  glm::dvec2 lo(INFINITY), hi(-INFINITY);
  for (const Curve& curve : curves) {
    for (const glm::dvec2& point : curve.points) {
      lo = glm::min(lo, point);
      hi = glm::max(hi, point);
    }
  }
  const double ratio = hi.x / lo.x;
  return {"falls with the square", {{lo.x, hi.y}, {hi.x, hi.y / (ratio * ratio)}}, true};
}

// Figure 11 itself, a row a resolution.
std::string pixel_error_table(const Choice& choice, const LogPanel& errors) {
  TableRow head{"resolution"};
  std::vector<TableRow> rows;
  for (const uint32_t resolution : choice.resolutions) rows.push_back({std::to_string(resolution)});
  for (const Curve& curve : errors.curves) {
    head.push_back(curve.name);
    for (size_t i = 0; i < rows.size(); ++i) rows[i].push_back(fmt::format("{:.3f}", curve.points[i].y));
  }
  return markdown_table(head, rows);
}

// After each scene: a long run shows what it has.
void save(const Choice& choice, const std::string& csv, std::vector<LogPanel> panels) {
  for (LogPanel& panel : panels) panel.curves.push_back(square_guide(panel.curves));
  if (!choice.csv.empty()) write_file(choice.csv, csv);
  if (!choice.svg.empty())
    write_file(choice.svg, log_plot(panels, "resolution: root of the number of texels", 2));
}

void series(const Choice& choice) {
  const auto backend = open(choice.device);
  std::string csv =
      "scene,resolution,texels,charts,from_input_percent,from_image_percent,hausdorff_percent,rms_percent,"
      "pixel_error_percent,flip_percent\n";
  std::vector<LogPanel> panels;
  for (const Measure& measure : measures) panels.push_back({measure.title, {}});
  fmt::print("{:<22} {:>6} {:>8} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "scene", "side", "texels",
             "charts", "from input", "from image", "Hausdorff", "RMS", "pixels", "FLIP");
  for (const std::string& name : choice.scenes) {
    const auto points = resolution_series(scene::load(data_file(name).value_or(name)), choice.resolutions,
                                          choice.picture, *backend);
    for (const SeriesPoint& p : points) {
      fmt::print("{:<22} {:>6} {:>8} {:>7} {:>8.4f}% {:>8.4f}% {:>8.4f}% {:>8.4f}% {:>8.4f}% {:>8.4f}%\n",
                 name, p.resolution, p.texels, p.charts, 100 * p.from_input, 100 * p.from_image,
                 100 * p.hausdorff, 100 * p.root_mean_square, 100 * p.pixel_error, 100 * p.flip);
      csv += fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", name, p.resolution,
                         p.texels, p.charts, 100 * p.from_input, 100 * p.from_image, 100 * p.hausdorff,
                         100 * p.root_mean_square, 100 * p.pixel_error, 100 * p.flip);
    }
    std::fflush(stdout);
    for (size_t i = 0; i < std::size(measures); ++i) {
      Curve curve{name, {}};
      for (const SeriesPoint& p : points) curve.points.emplace_back(side(p), 100 * p.*measures[i].value);
      panels[i].curves.push_back(curve);
    }
    save(choice, csv, panels);
  }
  if (!choice.parts.empty()) {
    write_file(std::filesystem::path(choice.parts) / "pixel-error.md",
               pixel_error_table(choice, panels[pixel_error]));
  }
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  lodestone::test::Choice choice;
  CLI::App app("How the error of resampled meshes falls as their resolution rises", "resolution_series");
  app.add_option("--scenes", choice.scenes, "Files, also of the shared data folder, or builtin:NAME")
      ->delimiter(',');
  app.add_option("--resolutions", choice.resolutions, "N: N x N texels in all")
      ->delimiter(',')
      ->check(CLI::Range(2, 32768));
  app.add_option("--size", choice.picture.size, "Pictures have N x N pixels")->check(CLI::Range(1, 8192));
  app.add_option("--spp", choice.picture.spp, "Samples a pixel")->check(CLI::Range(1, 1024));
  app.add_option("--camera", choice.picture.camera, "As `lodestone render` takes it");
  app.add_option("--device", choice.device, "cpu, or a part of a device's name");
  app.add_option("--csv", choice.csv, "Write the table to this file");
  app.add_option("--svg", choice.svg, "Write the plot to this file");
  app.add_option("--parts", choice.parts, "Write the pixel errors as a table of Markdown to this folder");
  return lodestone::test::bench_main(app, argc, argv, [&] { lodestone::test::series(choice); });
}
