// SPDX-License-Identifier: MIT
#include "lodestone/app/check_command.h"

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/App.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "lodestone/app/check_report.h"
#include "lodestone/app/check_run.h"
#include "lodestone/app/check_suite.h"
#include "lodestone/app/common_options.h"
#include "lodestone/app/output_path.h"
#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"

namespace lodestone::app {
namespace {

namespace fs = std::filesystem;

struct CheckOptions {
  std::string suite, device, out, junit, html;
  bool update = false;
};

// A folder that goes when this does; where there is no --out.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "lodestone-check-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr)
      fail(ExitCode::machine, pattern, "no temporary folder can be made; set TMPDIR, or give --out");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void check_options(const CheckOptions& options) {
  const char* automated = std::getenv("CI");
  if (options.update && automated != nullptr && *automated != '\0')
    fail(ExitCode::usage, "--update",
         "golden images are not written by continuous integration (CI is set); update them by hand and look "
         "at them");
  check_distinct({{"--junit", options.junit}, {"--html", options.html}}, {{"the suite", options.suite}});
  for (const std::string& file : {options.junit, options.html}) {
    if (!file.empty()) check_writable(file);
  }
}

void print_result(const GoldenResult& result) {
  if (log::level() == log::Level::quiet) return;
  const char* word = result.good() ? (result.outcome == Outcome::updated ? "updated" : "ok") : "FAILED";
  fmt::print("{:<8}{} ({:.2f} s)\n", word, result.name, result.seconds);
  for (const std::string& problem : result.problems) fmt::print("        {}\n", problem);
  std::fflush(stdout);  // whoever waits for a long suite sees how far it is
}

void write_reports(const CheckOptions& options, const GoldenSuite& suite,
                   const std::vector<GoldenResult>& results, const fs::path& pictures) {
  if (!options.junit.empty()) write_file(options.junit, junit_report(suite.name, results));
  if (!options.html.empty())
    write_file(options.html, html_report(suite.name, results, pictures.filename().string()));
}

// A difference counts most; where there is none, what kept the first broken test from running.
ExitCode exit_code(const std::vector<GoldenResult>& results) {
  ExitCode code = ExitCode::done;
  for (const GoldenResult& result : results) {
    if (result.outcome == Outcome::failed) return ExitCode::different;
    if (code == ExitCode::done) code = result.code;
  }
  return code;
}

int run_check(const CheckOptions& options,
              const std::function<int(const std::vector<std::string>&)>& run_program) {
  check_options(options);
  const GoldenSuite suite = read_suite(options.suite);
  const TemporaryFolder temporary;
  CheckContext context;
  context.run_program = run_program;
  context.results = options.out.empty() ? temporary.path() : fs::path(options.out);
  context.device = options.device;
  context.update = options.update;
  // Pictures of a page `report.html` go to `report_files` beside it.
  if (!options.html.empty()) context.pictures = fs::path(options.html).replace_extension().concat("_files");

  std::vector<GoldenResult> results;
  for (const GoldenTest& test : suite.tests) {
    results.push_back(run_golden_test(test, context));
    print_result(results.back());
    if (results.back().outcome == Outcome::interrupted) return int(ExitCode::interrupted);
  }
  write_reports(options, suite, results, context.pictures);
  const auto failed = std::count_if(results.begin(), results.end(),
                                    [](const GoldenResult& result) { return !result.good(); });
  if (log::level() != log::Level::quiet) fmt::print("{} tests, {} failed\n", results.size(), failed);
  return int(exit_code(results));
}

}  // namespace

void add_check_command(CLI::App& app, std::function<int()>& run,
                       std::function<int(const std::vector<std::string>&)> run_program) {
  CLI::App* command = app.add_subcommand("check", "Render a suite and compare it with golden images");
  auto options = std::make_shared<CheckOptions>();
  add_path(*command, "SUITE", "", "The tests, JSON; see below", options->suite)->required();
  add_value(*command, "--device", "DEVICE",
            "Render on this device, as `lodestone render` takes it, where a test does not name one itself",
            [&device = options->device](const std::string& text) { device = parse_name("--device", text); });
  add_path(*command, "--out", "DIR",
           "Leave NAME.img.exr, NAME.ref.exr and NAME.diff.png of tests that fail in this folder",
           options->out);
  add_path(*command, "--junit", "FILE.xml", "Write JUnit XML", options->junit);
  add_path(*command, "--html", "FILE.html", "Write a page; its pictures go to FILE_files beside it",
           options->html);
  command->add_flag("--update", options->update,
                    "Write golden images that are missing or differ (refused where the environment sets CI)");
  add_log_options(*command);
  command->footer(
      "SUITE holds {\"tests\": [{\"name\": \"sphere\", \"render\": [\"builtin:spheres\", \"--size\", "
      "\"64x64\"],\n"
      "\"golden\": \"golden/sphere.exr\", \"thresholds\": {\"flip_mean\": 0.01}}]}: arguments of `lodestone "
      "render`\n"
      "without -o ({suite} in them is the suite's folder), a golden image relative to the suite, and the\n"
      "thresholds of `lodestone compare`: max mean rmse flip_mean flip_p99 pixel pixel_share ignore. "
      "Without\n"
      "thresholds only equal images pass. A missing golden image is a failure. Exit code 1 where a picture "
      "is\n"
      "another one, else that of the first render that failed.\n"
      "Example: lodestone check tests/golden/suite.json --out failures --junit results.xml");
  command->callback([options, &run, run_program = std::move(run_program)] {
    run = [options, run_program] { return run_check(*options, run_program); };
  });
}

}  // namespace lodestone::app
