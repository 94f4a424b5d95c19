// SPDX-License-Identifier: MIT
#include "lodestone/test_support/contender.h"

#include <gtest/gtest.h>

#include "lodestone/test_support/rays.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

TEST(Contender, TellsPassesApartAndForgetsWhatWasTaken) {
  const ReadyScene ready(facing_camera({square(0, scene::none)}, {}), geometry_image::AtlasKind::exact);
  render::BackendOptions options;
  options.counters = true;
  Contender contender(ready, "cpu", options);
  contender.take_passes();  // `links`
  contender.renderer().update(ready.pose(0));
  const PassSeconds update = contender.take_passes();
  for (const char* pass : {"blend", "rasterise", "bounds"}) EXPECT_GT(update.at(pass), 0) << pass;
  EXPECT_EQ(update.size(), 3u);

  Rays rays;
  add_ray(rays, {0.5f, 0.2f, 3}, {0, 0, -1});  // into the square
  add_ray(rays, {9, 9, 3}, {0, 0, 1});
  contender.renderer().load_rays(rays);
  contender.renderer().trace_loaded();
  const render::Counters counted = contender.take_counters("trace");
  EXPECT_EQ(counted.rays, 2u);
  EXPECT_GE(counted.triangle_tests, 1u);
  EXPECT_TRUE(contender.take_passes().empty());
}

}  // namespace
}  // namespace lodestone::test
