// SPDX-License-Identifier: MIT
// No ray leaves a closed mesh, on any device; and the check finds a crack that is there.
#include <gtest/gtest.h>

#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/leak_check.h"

namespace lodestone::test {
namespace {

LeakReport leaks(const ReadyScene& ready, const std::string& device, uint64_t rays) {
  const auto texels = ready.texels(ready.pose(0));
  const QuadTriangles quads = quad_triangles(ready.atlas);
  const auto origins = points_inside(texels, quads, 8, 3);
  EXPECT_EQ(origins.size(), 8u);
  const auto backend = open(device);
  render::Settings settings;
  settings.width = settings.height = 8;
  render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
  renderer.update(ready.pose(0));
  return check_leaks(renderer, texels, quads, origins, rays, 11);
}

void expect_none(const LeakReport& report) {
  EXPECT_EQ(report.leaks, 0u) << "the first from " << report.origin.x << " " << report.origin.y << " "
                              << report.origin.z << " towards " << report.direction.x << " "
                              << report.direction.y << " " << report.direction.z;
}

class Leaks : public testing::TestWithParam<std::string> {};

TEST_P(Leaks, NoneFromABumpySphere) {
  expect_none(leaks(ReadyScene(grid_sphere(96)), GetParam(), 1000000));
}

TEST_P(Leaks, NoneFromASphereAsExactCharts) {
  expect_none(leaks(ReadyScene(grid_sphere(40), geometry_image::AtlasKind::exact), GetParam(), 300000));
}

TEST_P(Leaks, NoneFromSpot) {
  const auto file = data_file("spot.obj");
  if (!file) GTEST_SKIP() << "shared data are absent";
  for (const auto kind : {geometry_image::AtlasKind::exact, geometry_image::AtlasKind::charts})
    expect_none(leaks(ReadyScene(*file, kind), GetParam(), 300000));
}

TEST_P(Leaks, NoneFromTheArmadilloAsExactCharts) {
  const auto file = data_file("armadillo.obj");
  if (!file) GTEST_SKIP() << "shared data are absent";
  expect_none(leaks(ReadyScene(*file, geometry_image::AtlasKind::exact), GetParam(), 300000));
}

TEST_P(Leaks, NoneFromASphereAsMappedCharts) {
  geometry_image::AtlasSettings settings = geometry_image::AtlasKind::charts;
  settings.charts.texel_budget = 4096;
  expect_none(leaks(ReadyScene(grid_sphere(40), settings), GetParam(), 300000));
}

TEST_P(Leaks, NoneFromTheArmadilloAsMappedCharts) {
  const auto file = data_file("armadillo.obj");
  if (!file) GTEST_SKIP() << "shared data are absent";
  expect_none(leaks(ReadyScene(*file, geometry_image::AtlasKind::charts), GetParam(), 300000));
}

INSTANTIATE_TEST_SUITE_P(, Leaks, testing::ValuesIn(judged_device_names()),
                         [](const auto& each) { return each.param; });

// One chart's copy of an edge midpoint moved along the edge's other side: a gap as wide as a hundredth of a
// quad.
TEST(LeakCheck, FindsACrackPutInOnPurpose) {
  ReadyScene ready(grid_sphere(40), geometry_image::AtlasKind::exact);
  ASSERT_EQ(leaks(ready, "cpu", 100000).leaks, 0u);
  for (size_t chart = 0; chart < ready.atlas.charts.size(); chart += 50) {
    glm::uvec4& midpoint = ready.atlas.texel_map[ready.atlas.charts[chart].first_texel + 1];
    midpoint.z = std::bit_cast<uint32_t>(0.01f);
  }
  EXPECT_GT(leaks(ready, "cpu", 1000000).leaks, 0u);
}

// Every chart's samples of its first row moved in their triangles, while the chart beside keeps its own.
TEST(LeakCheck, FindsACrackBetweenMappedCharts) {
  geometry_image::AtlasSettings settings = geometry_image::AtlasKind::charts;
  settings.charts.texel_budget = 4096;
  ReadyScene ready(grid_sphere(40), settings);
  ASSERT_EQ(leaks(ready, "cpu", 100000).leaks, 0u);
  for (const layout::ChartRecord& chart : ready.atlas.charts) {
    for (uint32_t x = 1; x + 1 < chart.width; ++x) {
      glm::uvec4& texel = ready.atlas.texel_map[chart.first_texel + x];
      texel.y = texel.z = std::bit_cast<uint32_t>(1 / 3.0f);
    }
  }
  EXPECT_GT(leaks(ready, "cpu", 1000000).leaks, 0u);
}

}  // namespace
}  // namespace lodestone::test
