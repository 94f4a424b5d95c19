// SPDX-License-Identifier: MIT
// Table 1 and figure 7 of the paper: five kinds of rays at each resolution of the geometry image. Every round
// runs every kind on every device and traversal in turn; rates are medians, and all must return the same
// hits, to the bit. ray_kinds_bench [--resolutions 8,16,...] [--size 512] [--rounds N] [--devices
// cpu,llvmpipe] [--traversals threaded,auto] [--parts FOLDER] [--svg FILE]
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/scene/load.h"
#include "lodestone/test_support/bench_main.h"
#include "lodestone/test_support/contender.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/head_chart.h"
#include "lodestone/test_support/log_plot.h"
#include "lodestone/test_support/markdown_table.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/regrid.h"
#include "lodestone/test_support/rounds.h"
#include "lodestone/test_support/secondary_rays.h"

namespace lodestone::test {
namespace {

constexpr size_t kind_count = 5;
enum Kind : size_t { eye, blend, dof, glossy, mult };
constexpr std::array<const char*, kind_count> kind_names = {"Eye", "Blend", "DOF", "Glossy", "Mult."};

// Of kinds, Mrays/s; not a number where there is none.
using Rates = std::array<double, kind_count>;
constexpr double no = NAN;

// Table 1. Its text has lost the columns of the rows with blanks; they follow from how each column goes on.
const std::map<uint32_t, Rates> paper_rates = {
    {8, {10.1, 9.31, no, 12.5, no}},         {16, {6.25, 5.71, no, 9.56, no}},
    {32, {3.70, 3.30, no, 6.56, no}},        {64, {2.25, 2.23, 1.97, 4.32, 4.35}},
    {128, {1.37, 1.35, 1.21, 2.80, 2.85}},   {256, {0.818, 0.802, 0.706, 1.78, 1.83}},
    {512, {0.462, 0.453, 0.348, 1.14, 1.08}}};

struct Choice {
  std::vector<uint32_t> resolutions{8, 16, 32, 64, 128, 256, 512};
  std::vector<std::string> devices{"cpu", "llvmpipe"}, traversals{"threaded", "auto"};
  uint32_t size = 512;
  int rounds = 5;
  std::string parts, svg;
};

// The roughness of the head's skin.
constexpr float roughness = 0.5f;

// One scene on every device and traversal.
struct Field {
  ReadyScene ready;
  render::View view;
  std::vector<std::unique_ptr<Contender>> contenders;

  Field(scene::Scene made, const char* camera, const Choice& choice) : ready(std::move(made)) {
    const scene::Pose pose = ready.pose(0);
    view = render::find_view(ready.scene, pose, camera, scene::pose_bounds(ready.scene, pose), choice.size,
                             choice.size);
    for (const std::string& device : choice.devices) {
      for (const std::string& traversal : choice.traversals) {
        contenders.push_back(std::make_unique<Contender>(ready, device, render::BackendOptions{}, traversal));
        contenders.back()->renderer().update(pose);
      }
    }
  }
};

struct Series {
  std::string device, traversal;  // as they were asked for
  std::string became;             // what `auto` took
  std::map<uint32_t, Rates> rates;
  std::string title() const { return device + ", " + became; }
};

struct Result {
  std::map<uint32_t, std::pair<uint64_t, uint64_t>>
      triangles;                            // of the head and of the island, by resolution
  std::map<uint32_t, double> glossy_share;  // of the eye rays, those that are reflected
  std::vector<Series> series;
};

class Resolution {
 public:
  Resolution(uint32_t resolution, const Choice& choice)
      : resolution_(resolution),
        choice_(choice),
        head_(head_chart(resolution), "", choice),
        island_(regridded(scene::load("builtin:teapots"), uint64_t(resolution) * resolution), "teapots",
                choice) {
    const scene::Pose rest = head_.ready.pose(0);
    rays_[eye] = rays_[blend] = primary_rays(head_.view, choice.size);
    const float focus = glm::length(head_.view.origin);  // the head is about the origin
    rays_[dof] = lens_rays(head_.view, choice.size, focus, focus / 40, 7);
    render::Renderer& first = head_.contenders.front()->renderer();
    first.load_rays(rays_[eye]);
    first.trace_loaded();
    rays_[glossy] = glossy_rays(rays_[eye], first.hits(), head_.ready, rest, roughness, 11);
    rays_[mult] = primary_rays(island_.view, choice.size);
    times_.resize(head_.contenders.size());
  }

  void measure(Result& result) {
    for (int round = 0; round < choice_.rounds; ++round) {
      for (size_t kind = 0; kind < kind_count; ++kind) this->round(Kind(kind), round);
    }
    for (size_t c = 0; c < times_.size(); ++c) {
      Series& series = result.series[c];
      series.became = to_string(head_.contenders[c]->renderer().traversal());
      Rates& rates = series.rates[resolution_];
      for (size_t kind = 0; kind < kind_count; ++kind)
        rates[kind] = double(rays_[kind].size() / 2) / median(times_[c][kind]) / 1e6;
    }
    result.triangles[resolution_] = {head_.ready.assembly.triangles.size(),
                                     island_.ready.assembly.triangles.size()};
    result.glossy_share[resolution_] = double(rays_[glossy].size()) / double(rays_[eye].size());
  }

 private:
  // Every contender's turn. Buffers of rays are new ones each time, so that the first run does not count.
  void round(Kind kind, int round) {
    Field& field = kind == mult ? island_ : head_;
    // A frame's update and its rays; poses that differ from round to round.
    const float time = kind == blend ? 2 * float(round + 1) / float(choice_.rounds + 1) : 0;
    const scene::Pose pose = field.ready.pose(time);
    std::vector<glm::uvec4> first_hits;
    for (size_t c = 0; c < field.contenders.size(); ++c) {
      render::Renderer& renderer = field.contenders[c]->renderer();
      renderer.load_rays(rays_[kind]);
      renderer.update(pose);
      renderer.trace_loaded();
      times_[c][kind].push_back(seconds([&] {
        if (kind == blend) renderer.update(pose);
        renderer.trace_loaded();
      }));
      const auto hits = renderer.hits();
      if (c == 0) first_hits = hits;
      if (hits != first_hits)
        fail(ExitCode::different, fmt::format("{} rays at {}", kind_names[kind], resolution_),
             "{} has other hits than {}", field.contenders[c]->device(), field.contenders[0]->device());
    }
  }

  uint32_t resolution_;
  const Choice& choice_;
  Field head_, island_;
  std::array<Rays, kind_count> rays_;
  std::vector<std::array<std::vector<double>, kind_count>> times_;  // by contender
};

std::string rate_text(double rate) {
  return std::isnan(rate) ? "" : fmt::format("{:.3g}", rate);
}

std::string rates_table(const Result& result, const std::map<uint32_t, Rates>& rates) {
  TableRow head{"resolution", "triangles"};
  head.insert(head.end(), kind_names.begin(), kind_names.end());
  std::vector<TableRow> rows;
  for (const auto& [resolution, triangles] : result.triangles) {
    TableRow row{std::to_string(resolution), std::to_string(triangles.first)};
    const auto found = rates.find(resolution);
    for (size_t kind = 0; kind < kind_count; ++kind)
      row.push_back(rate_text(found == rates.end() ? no : found->second[kind]));
    rows.push_back(row);
  }
  return markdown_table(head, rows);
}

// The paper's, then ours.
std::vector<std::pair<std::string, const std::map<uint32_t, Rates>*>> all_rates(const Result& result) {
  std::vector<std::pair<std::string, const std::map<uint32_t, Rates>*>> all{
      {"the paper, GeForce 7800 GTX", &paper_rates}};
  for (const Series& series : result.series) all.emplace_back(series.title(), &series.rates);
  return all;
}

// By how much rates fall from the first to the last resolution at which the paper has all kinds and we have
// any.
std::string falls_table(const Result& result) {
  std::vector<uint32_t> common;
  for (const auto& [resolution, triangles] : result.triangles) {
    const auto found = paper_rates.find(resolution);
    if (found != paper_rates.end() && !std::isnan(found->second[dof])) common.push_back(resolution);
  }
  if (common.size() < 2) return "(Too few resolutions were measured.)\n";
  const uint32_t from = common.front(), to = common.back();
  TableRow head{fmt::format("rate at {} over rate at {}", from, to)};
  head.insert(head.end(), kind_names.begin(), kind_names.end());
  std::vector<TableRow> rows;
  for (const auto& [name, rates] : all_rates(result)) {
    TableRow row{name};
    for (size_t kind = 0; kind < kind_count; ++kind)
      row.push_back(fmt::format("{:.2f}", rates->at(from)[kind] / rates->at(to)[kind]));
    rows.push_back(row);
  }
  return markdown_table(head, rows);
}

// How fast a kind is beside eye rays: the median over the resolutions.
double beside_eye(const std::map<uint32_t, Rates>& rates, size_t kind,
                  const std::function<double(uint32_t)>& factor) {
  std::vector<double> ratios;
  for (const auto& [resolution, of_kinds] : rates) {
    if (!std::isnan(of_kinds[kind])) ratios.push_back(factor(resolution) * of_kinds[kind] / of_kinds[eye]);
  }
  return median(ratios);
}

std::string kinds_table(const Result& result) {
  TableRow head{"times as fast as eye rays, median"};
  head.insert(head.end(), kind_names.begin() + 1, kind_names.end());
  head.emplace_back("Glossy, every pixel counted");
  std::vector<TableRow> rows;
  for (const auto& [name, rates] : all_rates(result)) {
    TableRow row{name};
    for (size_t kind = 1; kind < kind_count; ++kind)
      row.push_back(fmt::format("{:.2f}", beside_eye(*rates, kind, [](uint32_t) { return 1; })));
    const bool ours = rates != &paper_rates;
    row.push_back(!ours ? "" : fmt::format("{:.2f}", beside_eye(*rates, glossy, [&](uint32_t resolution) {
                                             return 1 / result.glossy_share.at(resolution);
                                           })));
    rows.push_back(row);
  }
  return markdown_table(head, rows);
}

std::string plot(const Result& result) {
  std::vector<LogPanel> panels;
  for (const auto& [name, rates] : all_rates(result)) {
    LogPanel panel{name + ": Mrays/s", {}};
    for (size_t kind = 0; kind < kind_count; ++kind) {
      Curve curve{kind_names[kind], {}};
      for (const auto& [resolution, of_kinds] : *rates) {
        if (!std::isnan(of_kinds[kind])) curve.points.emplace_back(resolution, of_kinds[kind]);
      }
      panel.curves.push_back(curve);
    }
    panels.push_back(panel);
  }
  return log_plot(panels, "resolution of the geometry image", 2);
}

std::string devices_text(const Choice& choice) {
  std::vector<std::string> texts;
  for (const std::string& device : choice.devices) {
    const render::DeviceInfo info = open(device)->info();
    texts.push_back(fmt::format("`{}` is {}, {}", device, info.name, info.driver));
  }
  return fmt::format("{}\n", fmt::join(texts, "; "));
}

void write_parts(const Choice& choice, const Result& result) {
  const std::filesystem::path folder = choice.parts;
  write_file(folder / "devices.md", devices_text(choice));
  write_file(folder / "rates-size.md", fmt::format("{0} x {0} pixels", choice.size));
  write_file(folder / "rates-paper.md", rates_table(result, paper_rates));
  std::string ours;
  for (const Series& series : result.series)
    ours += fmt::format("{}:\n\n{}\n", series.title(), rates_table(result, series.rates));
  write_file(folder / "rates.md", ours);
  write_file(folder / "rates-fall.md", falls_table(result));
  write_file(folder / "rates-kinds.md", kinds_table(result));
  TableRow head{"resolution", "triangles of the head", "of the island", "eye rays that are reflected"};
  std::vector<TableRow> rows;
  for (const auto& [resolution, triangles] : result.triangles) {
    rows.push_back({std::to_string(resolution), std::to_string(triangles.first),
                    std::to_string(triangles.second),
                    fmt::format("{:.0f} %", 100 * result.glossy_share.at(resolution))});
  }
  write_file(folder / "rates-scenes.md", markdown_table(head, rows));
}

void bench(const Choice& choice) {
  Result result;
  for (const std::string& device : choice.devices) {
    for (const std::string& traversal : choice.traversals)
      result.series.push_back({device, traversal, traversal, {}});
  }
  for (const uint32_t resolution : choice.resolutions) {
    Resolution(resolution, choice).measure(result);
    for (const Series& series : result.series) {
      fmt::print("{:>4} {:<20}", resolution, series.title());
      for (size_t kind = 0; kind < kind_count; ++kind)
        fmt::print(" {} {:<6}", kind_names[kind], rate_text(series.rates.at(resolution)[kind]));
      fmt::print("\n");
    }
    std::fflush(stdout);
  }
  if (!choice.parts.empty()) write_parts(choice, result);
  if (!choice.svg.empty()) write_file(choice.svg, plot(result));
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  using namespace lodestone::test;
  Choice choice;
  CLI::App app("Table 1 of the paper: five kinds of rays at each resolution", "ray_kinds_bench");
  app.add_option("--resolutions", choice.resolutions, "Geometry images of N x N quads")
      ->delimiter(',')
      ->check(CLI::Range(4, 2048));
  app.add_option("--size", choice.size, "Pictures have N x N pixels, N a multiple of 8")
      ->check(CLI::Range(8, 4096));
  app.add_option("--rounds", choice.rounds, "Turns of each")->check(CLI::Range(1, 10000));
  app.add_option("--devices", choice.devices, "cpu, or a part of a device's name")->delimiter(',');
  app.add_option("--traversals", choice.traversals, "Ours")
      ->delimiter(',')
      ->check(CLI::IsMember({"auto", "threaded", "octant", "wide", "tile"}));
  app.add_option("--parts", choice.parts, "Write tables of Markdown to this folder");
  app.add_option("--svg", choice.svg, "Write the plot to this file");
  return bench_main(app, argc, argv, [&] { bench(choice); });
}
