// SPDX-License-Identifier: MIT
#include "lodestone/app/check_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "lodestone/app/clock.h"
#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"

namespace lodestone::app {
namespace {

namespace fs = std::filesystem;

void remove_file(const fs::path& file) {
  std::error_code ignored;
  fs::remove(file, ignored);
}

bool names_device(const std::vector<std::string>& arguments) {
  return std::any_of(arguments.begin(), arguments.end(), [](const std::string& argument) {
    return argument == "--device" || argument.starts_with("--device=");
  });
}

class TestRun {
 public:
  TestRun(const GoldenTest& test, const CheckContext& context)
      : test_(test),
        context_(context),
        rendered_(place("img", test.golden.extension().string())),
        reference_(place("ref", test.golden.extension().string())),
        difference_(place("diff", ".png")) {
    result_.name = test.name;
  }

  GoldenResult run() {
    const double start = now_ms();
    for (const fs::path& stale : {rendered_, reference_, difference_}) remove_file(stale);
    try {
      if (render()) judge();
    } catch (const Error& error) {
      if (error.code() == ExitCode::machine) throw;
      give(Outcome::broken, error.code(), error.what());
    }
    if (result_.good()) remove_file(rendered_);
    result_.seconds = (now_ms() - start) / 1000;
    return std::move(result_);
  }

 private:
  fs::path place(const char* role, const std::string& extension) const {
    return context_.results / fmt::format("{}.{}{}", test_.name, role, extension);
  }

  void give(Outcome outcome, ExitCode code, std::string problem) {
    result_.outcome = outcome;
    result_.code = code;
    result_.problems.push_back(std::move(problem));
  }

  bool render() {
    std::vector<std::string> arguments = {"render"};
    arguments.insert(arguments.end(), test_.arguments.begin(), test_.arguments.end());
    if (!context_.device.empty() && !names_device(test_.arguments))
      arguments.insert(arguments.end(), {"--device", context_.device});
    arguments.insert(arguments.end(), {"-o", rendered_.string()});
    arguments.push_back(log::level() == log::Level::verbose ? "-v" : "-q");
    const int code = context_.run_program(arguments);
    if (code == int(ExitCode::done)) return true;
    if (code == int(ExitCode::interrupted))
      give(Outcome::interrupted, ExitCode::interrupted, "interrupted");
    else
      give(Outcome::broken, ExitCode(code),
           fmt::format("the render ended with exit code {}; standard error says why", code));
    return false;
  }

  void judge() {
    const image::Image rendered = image::read(rendered_);
    std::error_code ignored;
    const bool exists = fs::exists(test_.golden, ignored);
    if (context_.update) return update(rendered, exists);
    if (!exists) {
      give(Outcome::failed, ExitCode::different,
           fmt::format("{}: there is no golden image; look at the picture that was rendered, then "
                       "make it one with --update",
                       test_.golden.string()));
      keep_picture("img", rendered);
      return;
    }
    const image::Image golden = image::read(test_.golden);
    result_.comparison = image::compare(rendered, golden, test_.thresholds);
    if (result_.comparison->pass) return;
    for (const std::string& failure : result_.comparison->failures)
      give(Outcome::failed, ExitCode::different, failure);
    keep_evidence(rendered, golden);
  }

  // Goldens that show the same already keep their bytes, so that a repository sees no change.
  void update(const image::Image& rendered, bool exists) {
    image::Thresholds exact;
    exact.ignore = test_.thresholds.ignore;
    if (exists && image::compare(rendered, image::read(test_.golden), exact).pass) return;
    write_file(test_.golden, read_file(rendered_));
    result_.outcome = Outcome::updated;
  }

  void keep_evidence(const image::Image& rendered, const image::Image& golden) {
    write_file(reference_, read_file(test_.golden));
    keep_picture("img", rendered);
    keep_picture("ref", golden);
    if (!result_.comparison->same_size) return;
    const image::Image difference = image::difference_image(rendered, golden);
    image::write(difference_, difference);
    keep_picture("diff", difference);
  }

  void keep_picture(const char* role, const image::Image& image) {
    if (context_.pictures.empty()) return;
    result_.pictures.push_back(fmt::format("{}.{}.png", test_.name, role));
    image::write(context_.pictures / result_.pictures.back(), image::for_display(image));
  }

  const GoldenTest& test_;
  const CheckContext& context_;
  fs::path rendered_, reference_, difference_;
  GoldenResult result_;
};

}  // namespace

GoldenResult run_golden_test(const GoldenTest& test, const CheckContext& context) {
  return TestRun(test, context).run();
}

}  // namespace lodestone::app
