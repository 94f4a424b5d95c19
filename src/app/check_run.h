// SPDX-License-Identifier: MIT
// One test of a suite: rendered, compared with its golden image, the evidence kept where it fails.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/app/check_suite.h"
#include "lodestone/base/error.h"
#include "lodestone/image/compare.h"

namespace lodestone::app {

enum class Outcome {
  passed,
  updated,     // the golden image was written anew
  failed,      // another picture than the golden one, or there is no golden one
  broken,      // nothing to compare: the render failed, or an image cannot be read
  interrupted  // by the user, while it rendered
};

struct GoldenResult {
  std::string name;
  Outcome outcome = Outcome::passed;
  double seconds = 0;                 // of the render and the comparison
  ExitCode code = ExitCode::done;     // of a program that had run this test alone
  std::vector<std::string> problems;  // a line each; empty unless failed or broken
  std::optional<image::Comparison> comparison;
  std::vector<std::string> pictures;  // file names in CheckContext::pictures: rendered, golden, difference

  bool good() const { return outcome == Outcome::passed || outcome == Outcome::updated; }
};

struct CheckContext {
  std::function<int(const std::vector<std::string>&)> run_program;  // as for add_check_command
  std::string device;  // of tests that do not name one themselves; empty: as `render` chooses
  // Where pictures are rendered to. Of a test that fails, NAME.img.exr, NAME.ref.exr (or .png, as the golden
  // image) and NAME.diff.png stay here; of others nothing does.
  std::filesystem::path results;
  std::filesystem::path pictures;  // where PNGs for a report go, of tests that fail; empty: nowhere
  bool update = false;             // write golden images that are missing or differ at all
};

// Throws Error(machine) where files cannot be written; all else is in the result.
GoldenResult run_golden_test(const GoldenTest& test, const CheckContext& context);

}  // namespace lodestone::app
