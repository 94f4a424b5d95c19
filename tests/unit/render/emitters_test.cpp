// SPDX-License-Identifier: MIT
// How often lights and surfaces that shine are drawn.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "lodestone/layout/shading.h"
#include "lodestone/render/emitter_data.h"
#include "lodestone/render/light_choice.h"
#include "lodestone/render/number_shares.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

using geometry_image::AtlasKind;
using render::EmitterData;

std::vector<uint32_t> shared(const std::vector<double>& weights) {
  std::vector<uint32_t> first(weights.size() + 1);
  render::share_out(weights, first);
  return first;
}

TEST(NumberShares, AreOutByWeight) {
  const std::vector<double> weights = {1, 0, 3, 1e-30, 4};
  const std::vector<uint32_t> first = shared(weights);
  EXPECT_EQ(first.front(), 0u);
  EXPECT_EQ(first.back(), render::drawn_numbers);
  EXPECT_EQ(first[1], first[2]) << "no weight, no number";
  EXPECT_GE(first[4] - first[3], 1u) << "every weight gets one";
  for (size_t i = 0; i < weights.size(); ++i)
    EXPECT_NEAR(double(first[i + 1] - first[i]) / render::drawn_numbers, weights[i] / 8, 1e-6);
  EXPECT_EQ(shared({0, 0}), (std::vector<uint32_t>{0, render::drawn_numbers / 2, render::drawn_numbers}));
}

TEST(NumberShares, AreOutEvenWhereThereAreTooFew) {
  const std::vector<uint32_t> first = shared(std::vector<double>(render::drawn_numbers + 5000, 1.0));
  EXPECT_EQ(first.back(), render::drawn_numbers);
  EXPECT_TRUE(std::is_sorted(first.begin(), first.end()));
}

scene::Scene shining(std::vector<scene::Mesh> meshes, const glm::vec3& emission) {
  scene::Scene scene = facing_camera(std::move(meshes), {scene::Material(), scene::Material()});
  scene.materials[1].emissive = emission;
  return scene;
}

EmitterData emitters_of(const ReadyScene& ready) {
  return render::make_emitters(ready.scene, ready.assembly, ready.atlas);
}

double power_of(const EmitterData& data) {
  double power = 0;
  for (const EmitterData::Object& object : data.objects) power += object.power;
  return power;
}

TEST(Emitters, AreNoneWhereNothingShines) {
  EXPECT_TRUE(emitters_of(ReadyScene(shining({square(0, 0)}, {1, 1, 1}), AtlasKind::exact)).empty())
      << "only what is drawn counts";
  EXPECT_TRUE(emitters_of(ReadyScene(shining({square(0, 1)}, {0, 0, 0}), AtlasKind::exact)).empty());
}

// Whatever charts there are, and in a node of another size.
TEST(Emitters, HaveThePowerOfTheirArea) {
  for (const AtlasKind kind : {AtlasKind::exact, AtlasKind::charts, AtlasKind::automatic}) {
    scene::Scene scene = shining({square(0, 1), square(1, 0)}, {1, 2, 3});
    scene.nodes[0].scale = {3, 2, 1};
    const ReadyScene ready(scene, kind);
    const EmitterData data = emitters_of(ready);
    ASSERT_FALSE(data.empty());
    EXPECT_NEAR(power_of(data), 24 * double(layout::luminance({1, 2, 3})), 1e-3);
    EXPECT_EQ(data.numbers.size(), 2 * data.texels.size());
    for (size_t c = 0; c < ready.atlas.charts.size(); ++c) {
      const layout::ChartRecord& chart = ready.atlas.charts[c];
      const uint32_t part = ready.assembly.triangles[ready.atlas.texel_map[chart.first_texel].x].w;
      EXPECT_EQ(data.first_of_charts[c] != 0, ready.assembly.parts[part].material == 1);
      if (data.first_of_charts[c] == 0) continue;
      EXPECT_EQ(data.texels[data.first_of_charts[c] - 1], chart.first_texel);
    }
    EXPECT_EQ(data.numbers.back(), render::drawn_numbers);
    EXPECT_TRUE(std::is_sorted(data.numbers.begin(), data.numbers.end()));
  }
}

TEST(Emitters, OfInstancesAreInTheirOwnSpaceObjectByObject) {
  scene::Scene scene = shining({square(0, 1), grid_sphere(8).meshes[0]}, {1, 1, 1});
  for (scene::Part& part : scene.meshes[1].parts) part.material = 0;
  scene.nodes[0].scale = glm::vec3(5);
  scene.nodes.push_back(scene.nodes[0]);
  const ReadyScene ready(scene, AtlasKind::exact, scene::Instancing::on);
  ASSERT_EQ(ready.assembly.objects.size(), 2u);
  const EmitterData data = emitters_of(ready);
  ASSERT_EQ(data.objects.size(), 2u);
  EXPECT_NEAR(data.objects[0].power, 4, 1e-5);
  EXPECT_EQ(data.objects[1].power, 0);
  EXPECT_EQ(data.objects[1].first_half, data.objects[1].end_half);
}

// A texture of one white texel in sixteen, of one in colour, and the rest black.
TEST(Emitters, AreDrawnWhereTheirTextureIsBright) {
  scene::Scene scene = shining({square(0, 1)}, {2, 2, 2});
  scene.materials[1].emissive_texture.image = 0;
  scene.materials[1].emissive_texture.nearest = true;
  scene::Image image;
  image.width = image.height = 4;
  image.rgba.assign(64, 0);
  for (size_t i = 0; i < 4; ++i) image.rgba[i] = 255;
  image.rgba[4 * 5] = 188;  // red, half as bright
  scene.images = {image};
  geometry_image::AtlasSettings settings = AtlasKind::charts;
  settings.charts.texel_budget = 33 * 33;
  const ReadyScene ready(scene, settings);
  const EmitterData data = emitters_of(ready);
  const std::vector<glm::vec3> texels = ready.texels(ready.pose(0));
  const double red = double(layout::luminance({1, 0, 0})) * 0.5, all = 1 + red;
  EXPECT_NEAR(power_of(data), 2 * 4 * all / 16, 0.08);
  double white = 0, coloured = 0, other = 0;
  for (size_t i = 0; i + 1 < data.texels.size(); ++i) {
    const glm::vec3& p = texels[data.texels[i]];
    const double share = double(data.numbers[2 * i + 2] - data.numbers[2 * i]) / render::drawn_numbers;
    // Quads reach a little beyond their corner; v runs down.
    const int x = int(std::floor((p.x + 1.03f) * 2)), y = int(std::floor((1.03f - p.y) * 2));
    (x == 0 && y == 0 ? white : x == 1 && y == 1 ? coloured : other) += share;
  }
  EXPECT_NEAR(white, 1 / all, 0.12);
  EXPECT_NEAR(coloured, red / all, 0.05);
  EXPECT_LT(other, 0.2);
}

layout::LightRecord light_of(uint32_t kind, float color) {
  layout::LightRecord light{};
  light.kind = kind;
  light.color = glm::vec3(color);
  light.cone_scale = 1;
  return light;
}

TEST(LightChoice, IsHalfByPowerAndHalfAny) {
  std::vector<layout::LightRecord> lights = {
      light_of(layout::light_point, 1), light_of(layout::light_directional, 4),
      light_of(layout::light_sky, 0), light_of(layout::light_emitters, 0)};
  // Over 4 pi: 1, 4, 3 and 0.
  const render::LightChoice choice = render::choose_lights(lights, {2, 3, 0});
  const double numbers = render::drawn_numbers;
  EXPECT_NEAR(lights[0].numbers / numbers, 0.5 / 8 + 0.5 / 3, 1e-6);
  EXPECT_NEAR(lights[1].numbers / numbers, 4 * 0.5 / 8 + 0.5 / 3, 1e-6);
  EXPECT_NEAR(double(choice.sky_chance), 3 * 0.5 / 8 + 0.5 / 3, 1e-6);
  EXPECT_EQ(choice.emitter_chance, 0);
  EXPECT_EQ(choice.first_emitter_number, render::drawn_numbers);
  EXPECT_EQ(choice.step, 2u);
  uint32_t first = 0;
  for (const layout::LightRecord& light : lights) {
    EXPECT_EQ(light.first_number, first);
    first += light.numbers;
  }
  EXPECT_EQ(first, render::drawn_numbers);
}

TEST(LightChoice, IsEvenWherePowersAreNone) {
  std::vector<layout::LightRecord> lights(2, light_of(layout::light_sky, 0));
  lights[1].kind = layout::light_directional;
  render::choose_lights(lights, {1, 0, 0});
  EXPECT_EQ(lights[0].numbers, lights[1].numbers);
  lights[1].color = glm::vec3(std::numeric_limits<float>::max());
  render::choose_lights(lights, {std::numeric_limits<double>::max(), 1, 0});
  EXPECT_EQ(lights[0].numbers + lights[1].numbers, render::drawn_numbers);
}

}  // namespace
}  // namespace lodestone::test
