// SPDX-License-Identifier: MIT
#include "lodestone/test_support/rays.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lodestone::test {
namespace {

TEST(Rays, PrimaryOnesFillAViewOfEitherKindInTiles) {
  render::View view;  // from the origin along -z, to x and y of -1 to 1
  view.perspective = false;
  const Rays parallel = primary_rays(view, 16);
  ASSERT_EQ(parallel.size(), 2u * 16 * 16);
  EXPECT_EQ(glm::vec3(parallel[0]), glm::vec3(-1 + 1 / 16.f, 1 - 1 / 16.f, 0));
  EXPECT_EQ(glm::vec3(parallel[2 * 64]), glm::vec3(1 / 16.f, 1 - 1 / 16.f, 0));  // the second tile of 8 x 8
  view.perspective = true;
  const Rays fan = primary_rays(view, 16);
  for (size_t i = 0; i < parallel.size(); i += 2) {
    EXPECT_EQ(glm::vec3(fan[i]), glm::vec3(0));
    const glm::vec3 direction(fan[i + 1]), through = direction / -direction.z;
    EXPECT_NEAR(glm::distance(through, glm::vec3(parallel[i]) - glm::vec3(0, 0, 1)), 0, 1e-6);
    EXPECT_EQ(glm::vec3(parallel[i + 1]), glm::vec3(0, 0, -1));
  }
}

TEST(Rays, SurfaceOnesStartClearOfItOnItsOutwardSide) {
  const std::vector<glm::vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 2, 2}};
  const Rays rays = surface_rays(points, {{0, 1, 2}, {0, 1, 1}}, 100, 1, 0.25f);
  ASSERT_EQ(rays.size(), 200u);
  for (size_t i = 0; i < rays.size(); i += 2) {
    EXPECT_EQ(rays[i].z, 0.25f);
    EXPECT_GE(rays[i].x, 0);
    EXPECT_LE(rays[i].x + rays[i].y, 1 + 1e-6f);
    EXPECT_GT(rays[i + 1].z, 0);
  }
  EXPECT_THROW(surface_rays(points, {{0, 1, 1}}, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace lodestone::test
