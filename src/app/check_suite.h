// SPDX-License-Identifier: MIT
// A suite of golden images: what to render, what it must look like, and how closely.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lodestone/image/compare.h"

namespace lodestone::app {

struct GoldenTest {
  std::string name;                    // letters, digits, `_`, `-` and `.` (not first): it names files
  std::vector<std::string> arguments;  // of `lodestone render`, without -o
  std::filesystem::path golden;        // .exr or .png; the picture is rendered to a file of the same kind
  image::Thresholds thresholds;
};

struct GoldenSuite {
  std::string name;  // of the file, without its extension
  std::vector<GoldenTest> tests;
};

// Reads a suite, JSON:
//   {"tests": [{"name": "sphere", "render": ["builtin:spheres", "--size", "64x64"], "golden":
//   "golden/sphere.exr",
//               "thresholds": {"max": 0.01, "ignore": ["steps.N"]}}]}
// `golden` is relative to the suite's folder, which `{suite}` in an argument stands for. `thresholds` may be
// missing; its members are those of image::Thresholds. Throws Error(bad_input) for anything else than that.
GoldenSuite read_suite(const std::filesystem::path& file);

}  // namespace lodestone::app
