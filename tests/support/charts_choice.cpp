// SPDX-License-Identifier: MIT
#include "lodestone/test_support/charts_choice.h"

#include <algorithm>
#include <cmath>

namespace lodestone::test {

void ChartsChoice::add_options(CLI::App& app) {
  app.add_option("--scenes", scenes, "Files, also of the shared data folder, or builtin:NAME")
      ->delimiter(',');
  app.add_option("--budgets", budgets, "Texels a triangle")->delimiter(',')->check(CLI::PositiveNumber);
  app.add_option("--devices", devices, "cpu, or a part of a device's name")->delimiter(',');
  app.add_option("--rounds", rounds, "Turns of each")->check(CLI::Range(1, 10000));
  const auto in_tiles = [](const std::string& text) {
    return std::stoul(text) % 8 == 0 ? std::string()
                                     : "pictures are made of tiles of 8 x 8; give a multiple of 8";
  };
  app.add_option("--size", size, "Primary rays of a picture of N x N pixels")
      ->check(CLI::Range(8, 8192))
      ->check(CLI::Validator(in_tiles, "multiple of 8"));
}

ReadyScene with_charts(const ReadyScene& input, double texels_a_triangle) {
  constexpr double least = 4;  // one quad
  geometry_image::AtlasSettings settings(geometry_image::AtlasKind::charts);
  settings.charts.texel_budget = static_cast<uint64_t>(
      std::max(least, std::round(texels_a_triangle * static_cast<double>(input.assembly.triangles.size()))));
  return ReadyScene(input.scene, settings);
}

}  // namespace lodestone::test
