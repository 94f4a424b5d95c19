// SPDX-License-Identifier: MIT
#include "lodestone/test_support/image_scene.h"

#include <gtest/gtest.h>

#include "lodestone/test_support/mapped_charts.h"

namespace lodestone::test {
namespace {

TEST(ImageScene, IsTheSurfaceOfTheChartsToTheBit) {
  const ReadyScene ready = straddled_squares();
  const scene::Pose pose = ready.pose(0);
  const scene::Scene made = image_scene(ready, pose);
  scene::validate(made);
  const auto texels = ready.texels(pose);
  const auto quads = quad_triangles(ready.atlas).texels;
  const scene::Assembly assembly = scene::assemble(made);
  const auto positions = scene::rest_positions(made, assembly);
  ASSERT_EQ(assembly.triangles.size(), quads.size());
  for (size_t i = 0; i < quads.size(); ++i) {
    for (int corner = 0; corner < 3; ++corner)
      EXPECT_EQ(positions[assembly.triangles[i][corner]], texels[quads[i][corner]]);
  }
}

}  // namespace
}  // namespace lodestone::test
