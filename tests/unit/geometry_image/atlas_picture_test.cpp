// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/atlas_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

using test::height_field;
using test::mesh_of;
using test::scene_of;

// Samples `x` and `y` apart in the plane.
scene::Mesh flat(uint32_t width, uint32_t height, float x, float y) {
  scene::Mesh mesh = height_field(width, height);
  for (glm::vec3& p : mesh.positions) p = {x * p.x, y * p.y, 0};
  return mesh;
}

AtlasSurface rest_surface(const scene::Scene& scene, const Atlas& atlas) {
  return surface_of(scene, scene::assemble(scene), atlas, scene::evaluate(scene, scene::none, 0));
}

// `kinds`: how many kinds of chart it must have, so that the right thing is looked at.
void expect_each_texel_once(const Atlas& atlas, size_t kinds, size_t texels) {
  std::set<uint32_t> kinds_found;
  for (const layout::ChartRecord& chart : atlas.charts) kinds_found.insert(chart.kind);
  EXPECT_EQ(kinds_found.size(), kinds);
  const AtlasPicture picture = lay_out(atlas, "test");
  ASSERT_EQ(picture.texels.size(), size_t(picture.width) * picture.height);
  std::set<uint32_t> shown;
  for (const uint32_t texel : picture.texels) {
    if (texel == layout::no_index) continue;
    EXPECT_TRUE(shown.insert(texel).second);
    EXPECT_NE(atlas.texel_map[texel].w, 0u);
  }
  EXPECT_EQ(shown.size(), texels);
  for (const layout::ChartRecord& chart : atlas.charts) {
    const auto first = std::find(picture.texels.begin(), picture.texels.end(), chart.first_texel);
    for (uint32_t y = 0; y < chart.height; ++y) {
      for (uint32_t x = 0; x < chart.width; ++x) {
        const uint32_t texel = chart.first_texel + y * chart.width + x;
        const bool is_one = atlas.texel_map[texel].w != 0;
        EXPECT_EQ(*(first + ptrdiff_t(y) * picture.width + x), is_one ? texel : layout::no_index);
      }
    }
  }
}

TEST(AtlasPicture, ShowsEachTexelOnceWhereItsChartIs) {
  const scene::Mesh triangle = mesh_of({{0, 0, 9}, {1, 0, 9}, {0, 1, 9}}, {{0, 1, 2}});
  const scene::Scene scene = scene_of({height_field(9, 5), triangle, height_field(3, 7, {50, 0, 0})});
  const Atlas resampled = test::atlas_of(scene);
  expect_each_texel_once(resampled, 2, resampled.texel_map.size());
  const Atlas exact = test::atlas_of(scene, AtlasKind::exact);
  expect_each_texel_once(exact, 1, 8 * exact.charts.size());
  const Atlas beside_soup = test::atlas_of(scene_of({height_field(9, 5), test::pages(256)}));
  expect_each_texel_once(beside_soup, 2, 9 * 5 + 8 * 256);
}

TEST(AtlasPicture, HasStretchOneWhereTexelsAreEven) {
  const scene::Scene scene = scene_of({flat(6, 4, 0.25f, 0.25f)});
  for (const float stretch : rest_surface(scene, test::atlas_of(scene)).stretch)
    EXPECT_NEAR(stretch, 1, 1e-6);
}

TEST(AtlasPicture, MeasuresStretchByTheMeanDensity) {
  // Quads of 2 x 1, beside as many of 1 x 1: 1.5 is the mean area.
  const scene::Scene scene = scene_of({flat(5, 5, 2, 1), flat(5, 5, 1, 1)});
  const AtlasSurface surface = rest_surface(scene, test::atlas_of(scene));
  for (uint32_t i = 0; i < 25; ++i) {
    EXPECT_NEAR(surface.stretch[i], std::sqrt((4 + 1) / 2.0 / 1.5), 1e-6);
    EXPECT_NEAR(surface.stretch[25 + i], std::sqrt(1 / 1.5), 1e-6);
  }
}

TEST(AtlasPicture, WeighsTheQuadsRoundATexelByTheirArea) {
  scene::Mesh mesh = flat(3, 2, 1, 1);
  for (glm::vec3& p : mesh.positions) p.x = p.x == 2 ? 4 : p.x;  // a quad of 1 x 1, one of 3 x 1
  const scene::Scene scene = scene_of({mesh});
  const AtlasSurface surface = rest_surface(scene, test::atlas_of(scene));
  EXPECT_NEAR(surface.stretch[0], std::sqrt(1 / 2.0), 1e-6);
  EXPECT_NEAR(surface.stretch[1], std::sqrt((1 * 1 + 3 * 5) / 4.0 / 2), 1e-6);
  EXPECT_NEAR(surface.stretch[2], std::sqrt(5 / 2.0), 1e-6);
}

TEST(AtlasPicture, BearsQuadsWithoutAnArea) {
  scene::Mesh mesh = flat(3, 3, 1, 1);
  for (uint32_t x = 0; x < 3; ++x) mesh.positions[x] = {0, 1, 0};  // the first row is a point of the next
  const scene::Scene scene = scene_of({mesh});
  for (const float stretch : rest_surface(scene, test::atlas_of(scene, AtlasKind::grid)).stretch)
    EXPECT_TRUE(std::isfinite(stretch) && stretch > 0) << stretch;
}

TEST(AtlasPicture, ColoursPositionsByTheirBox) {
  const scene::Scene scene = scene_of({flat(5, 3, 2, 3)});
  const Atlas atlas = test::atlas_of(scene);
  const std::vector<glm::vec3> colours = position_colours(atlas, rest_surface(scene, atlas));
  EXPECT_EQ(colours.front(), glm::vec3(0, 0, 0.5f));
  EXPECT_EQ(colours.back(), glm::vec3(1, 1, 0.5f));
  EXPECT_EQ(colours[7], glm::vec3(0.5f, 0.5f, 0.5f));
}

TEST(AtlasPicture, ColoursNormalsOfThePose) {
  scene::Scene scene = scene_of({flat(3, 3, 1, 1)});
  scene.nodes[0].rotation = glm::quat(std::sqrt(0.5f), std::sqrt(0.5f), 0, 0);  // z to -y
  const std::vector<glm::vec3> colours = normal_colours(rest_surface(scene, test::atlas_of(scene)));
  for (const glm::vec3& colour : colours) EXPECT_LT(glm::distance(colour, glm::vec3(0.5f, 0, 0.5f)), 1e-6f);
}

TEST(AtlasPicture, GivesEachChartAColourOfItsOwn) {
  std::vector<scene::Mesh> meshes;
  for (uint32_t i = 0; i < 40; ++i) meshes.push_back(flat(2, 2, 1, 1));
  const scene::Scene scene = scene_of(meshes);
  const Atlas atlas = test::atlas_of(scene);
  const std::vector<glm::vec3> colours = chart_colours(atlas, rest_surface(scene, atlas));
  for (size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(colours[4 * i], colours[4 * i + 3]) << "they all look the same way";
    for (size_t j = 0; j < i; ++j) EXPECT_GT(glm::distance(colours[4 * i], colours[4 * j]), 0.02f);
  }
}

}  // namespace
}  // namespace lodestone::geometry_image
