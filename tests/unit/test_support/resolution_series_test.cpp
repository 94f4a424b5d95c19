// SPDX-License-Identifier: MIT
#include "lodestone/test_support/resolution_series.h"

#include <gtest/gtest.h>

#include "lodestone/base/error.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/grid_sphere.h"

namespace lodestone::test {
namespace {

// Figure 11 of the paper, on a smooth closed surface.
TEST(ResolutionSeries, EveryErrorFallsAsTheResolutionRises) {
  scene::Scene sphere = grid_sphere(48);
  sphere.meshes[0].grids.clear();
  const auto backend = open("cpu");
  const auto series = resolution_series(sphere, {32, 64, 128}, {96, 4, ""}, *backend);
  ASSERT_EQ(series.size(), 3u);
  for (size_t i = 1; i < series.size(); ++i) {
    EXPECT_GT(series[i].texels, series[i - 1].texels);
    for (const auto value : {&SeriesPoint::from_input, &SeriesPoint::from_image, &SeriesPoint::hausdorff,
                             &SeriesPoint::root_mean_square, &SeriesPoint::pixel_error, &SeriesPoint::flip})
      EXPECT_LT(series[i].*value, series[i - 1].*value);
    EXPECT_LE(series[i].texels, uint64_t(series[i].resolution) * series[i].resolution);
    EXPECT_GE(series[i].hausdorff, series[i].root_mean_square);
  }
}

}  // namespace
}  // namespace lodestone::test
