// SPDX-License-Identifier: MIT
// What benches of resampled charts let their users choose.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {

struct ChartsChoice {
  std::vector<std::string> scenes, devices{"cpu", "llvmpipe"};
  std::vector<double> budgets;  // texels a triangle
  int rounds = 7;
  uint32_t size = 512;  // primary rays of a picture of size x size pixels

  void add_options(CLI::App& app);
};

// The scene of `input` with an atlas of resampled charts, of about so many texels a triangle.
ReadyScene with_charts(const ReadyScene& input, double texels_a_triangle);

}  // namespace lodestone::test
