// SPDX-License-Identifier: MIT
#include "lodestone/app/compare_command.h"

#include <fmt/format.h>
#include <CLI/App.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "lodestone/app/common_options.h"
#include "lodestone/app/comparison_table.h"
#include "lodestone/app/output_path.h"
#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"
#include "lodestone/image/compare.h"

namespace lodestone::app {
namespace {

constexpr double largest = std::numeric_limits<double>::max();

struct CompareOptions {
  std::string a, b;
  image::Thresholds thresholds;
  std::string difference, json;
};

void write_difference(const CompareOptions& options, const image::Image& a, const image::Image& b,
                      const image::Comparison& comparison) {
  if (comparison.same_size) return image::write(options.difference, image::difference_image(a, b));
  log::warn(
      fmt::format("{}: not written, for images of different sizes have no difference", options.difference));
}

int run_compare(const CompareOptions& options) {
  const bool json_to_stdout = options.json == "-";
  check_distinct({{"--diff", options.difference}, {"--json", options.json}},
                 {{"A", options.a}, {"B", options.b}});
  if (!options.difference.empty()) {
    OutputPattern("--diff", options.difference);  // for its extension
    check_writable(options.difference);
  }
  if (!options.json.empty() && !json_to_stdout) check_writable(options.json);

  const image::Image a = image::read(options.a), b = image::read(options.b);
  const image::Comparison comparison = image::compare(a, b, options.thresholds);
  const std::string json = image::to_json(comparison, options.a, options.b);
  if (json_to_stdout)
    fmt::print("{}", json);
  else if (log::level() != log::Level::quiet)
    fmt::print("{}", comparison_table(comparison));
  if (!options.json.empty() && !json_to_stdout) write_file(options.json, json);
  if (!options.difference.empty()) write_difference(options, a, b, comparison);
  return int(comparison.pass ? ExitCode::done : ExitCode::different);
}

void add_threshold_options(CLI::App& app, image::Thresholds& thresholds) {
  const auto add = [&](const char* name, std::optional<double>& bound, double most, const char* help) {
    add_value(app, name, "X", help,
              [name, &bound, most](const std::string& text) { bound = parse_number(name, text, 0, most); });
  };
  add("--max", thresholds.max, largest, "Largest difference of a sample that passes");
  add("--mean", thresholds.mean, largest, "Largest mean difference that passes");
  add("--rmse", thresholds.rmse, largest, "Largest root of the mean square difference that passes");
  add("--flip-mean", thresholds.flip_mean, 1, "Largest mean FLIP error that passes, 0..1");
  add("--flip-p99", thresholds.flip_p99, 1, "Largest 99th percentile of the FLIP error that passes, 0..1");
  add_value(app, "--pixel", "X", "A pixel differs where a channel differs by more than this (default: 0)",
            [&](const std::string& text) { thresholds.pixel = parse_number("--pixel", text, 0, largest); });
  add_value(
      app, "--pixel-share", "X", "Share of pixels that may differ, 0..1 (default: 0)",
      [&](const std::string& text) { thresholds.pixel_share = parse_number("--pixel-share", text, 0, 1); });
  add_value(app, "--ignore", "CHANNELS", "Leave channels or layers out, e.g. steps.N,depth",
            [&](const std::string& text) { thresholds.ignore = parse_list("--ignore", text); });
}

}  // namespace

void add_compare_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* command = app.add_subcommand("compare", "Say where two images differ, and whether by too much");
  auto options = std::make_shared<CompareOptions>();
  add_path(*command, "A", "", "An image", options->a)->required();
  add_path(*command, "B", "", "The image to compare it with", options->b)->required();
  add_threshold_options(*command, options->thresholds);
  add_path(*command, "--diff", "FILE", "Write a picture of the differences and the FLIP error (.png, .exr)",
           options->difference);
  add_path(*command, "--json", "FILE", "Write the measures as JSON; - is standard output", options->json);
  add_log_options(*command);
  command->footer(
      "Without any threshold only equal images pass; with some, each of them must hold. NaN or infinity "
      "against\n"
      "another value, and differing ids, fail whatever the thresholds, unless --pixel-share allows the "
      "pixels.\n"
      "Exit code 0: passed, 1: did not.\n"
      "Example: lodestone compare golden.exr new.exr --flip-mean 0.01 --ignore steps.N --diff "
      "difference.png");
  command->callback([options, &run] { run = [options] { return run_compare(*options); }; });
}

}  // namespace lodestone::app
