// SPDX-License-Identifier: MIT
// Surfaces that shine, drawn as lights by `path`: against what can be worked out by hand, with little noise,
// and however they come to be where they are.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/picture.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

using geometry_image::AtlasKind;

scene::Material black() {
  scene::Material material;
  material.base_color = {0, 0, 0, 1};
  material.metallic = 0;
  material.specular = 0;
  return material;
}
scene::Material chalk() {
  scene::Material material = black();
  material.base_color = {1, 1, 1, 1};
  return material;
}
scene::Material lamp(const glm::vec3& radiance) {
  scene::Material material = black();
  material.emissive = radiance;
  return material;
}

// A white square whose middle alone is in the picture, and behind the camera one from -size to size that
// shines on it from z = 4.
scene::Scene lit_square(float size, const scene::Material& shining) {
  scene::Scene scene = facing_camera({square(0, 0), square(0, 1)}, {chalk(), shining});
  scene.sky = scene::Sky{};
  scene.cameras[0].xmag = scene.cameras[0].ymag = 0.03f;
  scene.nodes[1].scale = {size, size, 1};
  scene.nodes[1].translation = {0, 0, 4};
  return scene;
}
// What a white surface is seen to send back that a square of radiance 1 from -half to half shines on from
// above its middle: four times the form factor of a quarter, as in any table of them.
double lit_by_square(double half, double distance) {
  const double x = half / distance, root = std::sqrt(1 + x * x);
  return 4 / M_PI * x / root * std::atan(x / root);
}

render::Settings settings_of(uint32_t size, uint32_t spp) {
  render::Settings settings;
  settings.integrator = render::Integrator::path;
  settings.width = settings.height = size;
  settings.spp = spp;
  return settings;
}

struct Measured {
  double mean = 0, deviation = 0;  // of single pixels
};
Measured all_of(const image::Image& image, const char* channel) {
  const std::vector<float>& values = image.find(channel)->values;
  double sum = 0, squares = 0;
  for (const float x : values) {
    sum += double(x);
    squares += double(x) * double(x);
  }
  const double mean = sum / double(values.size());
  return {mean, std::sqrt(std::max(squares / double(values.size()) - mean * mean, 0.0))};
}

class EmittersOn : public testing::TestWithParam<std::string> {
 protected:
  image::Image render(const ReadyScene& ready, const render::Settings& settings, float time = 0) const {
    return picture(*backend_, ready, time, settings);
  }
  const std::unique_ptr<render::Backend> backend_ = open(GetParam(), {.validate = GetParam() != "cpu"});
};

// A lamp of a thousandth of the directions, which rays by chance would find in one sample of a hundred: the
// noise would be three times the mean.
TEST_P(EmittersOn, LightAsTheirFormFactorSays) {
  for (const AtlasKind kind : {AtlasKind::exact, AtlasKind::automatic}) {
    for (const float size : {0.2f, 4.0f}) {
      const ReadyScene ready(lit_square(size, lamp({2, 1, 0.5f})), kind);
      const image::Image image = render(ready, settings_of(16, 64));
      const double expected = 2 * lit_by_square(double(size), 4);
      const Measured red = all_of(image, "R");
      EXPECT_NEAR(red.mean, expected, 0.02 * expected) << size;
      EXPECT_LT(red.deviation, (size < 1 ? 0.05 : 0.15) * expected) << size;
      EXPECT_NEAR(all_of(image, "B").mean, expected / 4, 0.005 * expected) << size;
    }
  }
}

// Where nothing goes on from the last surface, no chance shares the light with what is drawn.
TEST_P(EmittersOn, LightTheLastSurfaceInFull) {
  const ReadyScene ready(lit_square(4, lamp({2, 2, 2})));
  render::Settings settings = settings_of(16, 64);
  settings.max_bounces = 0;
  const double expected = 2 * lit_by_square(4, 4);
  EXPECT_NEAR(all_of(render(ready, settings), "R").mean, expected, 0.02 * expected);
}

// Half of the lamp is cut out, and the rest shines in one half only.
TEST_P(EmittersOn, ShineWhereTheirTexturesSayAndAreThere) {
  scene::Material shining = lamp({4, 4, 4});
  shining.emissive_texture.image = 0;
  shining.emissive_texture.nearest = true;
  shining.alpha_mask = true;
  shining.base_color_texture.image = 1;
  shining.base_color_texture.nearest = true;
  scene::Scene scene = lit_square(0.2f, shining);
  scene.images.resize(2);
  for (scene::Image& image : scene.images) image.width = image.height = 2;
  scene.images[0].rgba = {255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255};
  scene.images[1].rgba = {0, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 255, 0, 0, 0, 0};
  const double expected = lit_by_square(0.2, 4);
  for (const AtlasKind kind : {AtlasKind::exact, AtlasKind::charts}) {
    const Measured red = all_of(render(ReadyScene(scene, kind), settings_of(16, 256)), "R");
    EXPECT_NEAR(red.mean, expected, 0.03 * expected);
    EXPECT_LT(red.deviation, 0.2 * expected);
  }
}

// Evenly bright all round, which is the same by surfaces and by a sky, whatever a body reflects, mirrors or
// lets through.
TEST_P(EmittersOn, OfAFurnaceAreASky) {
  scene::Material mirror, rough, glass, frosted, coated = chalk();
  mirror.roughness = 0;
  rough.roughness = 0.3f;
  glass.metallic = 0;
  glass.roughness = 0;
  glass.transmission = 1;
  glass.thickness = 1;
  frosted = glass;
  frosted.thickness = 0;
  frosted.roughness = 0.5f;
  coated.clearcoat = 1;
  coated.clearcoat_roughness = 0.25f;
  // A cube round it and round the camera.
  scene::Scene scene = facing_camera({grid_sphere(24).meshes[0]}, {chalk(), lamp({0.5f, 0.5f, 0.5f})});
  scene.sky = scene::Sky{};
  for (scene::Part& part : scene.meshes[0].parts) part.material = 0;
  scene.meshes.push_back(square(-1, 1));
  for (const auto& [axis, turns] : {std::pair(glm::vec3(0, 1, 0), 4), std::pair(glm::vec3(1, 0, 0), 2)}) {
    for (int i = 0; i < turns; ++i) {
      scene::Node node;
      node.mesh = 1;
      node.scale = glm::vec3(6);
      const float quarters = turns == 4 ? float(i) : float(2 * i + 1);
      node.rotation = glm::angleAxis(quarters * float(M_PI) / 2, axis);
      scene.nodes.push_back(node);
    }
  }
  for (const scene::Material& material : {chalk(), mirror, rough, glass, frosted, coated}) {
    scene.materials[0] = material;
    render::Settings settings = settings_of(16, 256);
    settings.max_bounces = 64;
    const double lit = all_of(render(ReadyScene(scene, AtlasKind::exact), settings), "G").mean;
    scene::Scene under_sky = scene;
    under_sky.nodes.resize(2);
    under_sky.sky = scene::Sky{glm::vec3(0.5f), glm::vec3(0.5f), glm::vec3(0.5f)};
    EXPECT_NEAR(lit, all_of(render(ReadyScene(under_sky, AtlasKind::exact), settings), "G").mean, 0.001);
  }
}

// Instances of a lamp, one larger, one turned over, one without size, beside a lamp that is not shared;
// against the same without instances.
TEST_P(EmittersOn, AreInstances) {
  scene::Scene scene = lit_square(0.1f, lamp({8, 4, 2}));
  for (const float x : {-2.0f, 2.0f, 0.0f}) {
    scene::Node node = scene.nodes[1];
    node.translation = {x, 1, 3};
    node.scale = x == 0 ? glm::vec3(0) : glm::vec3(x < 0 ? 0.3f : -0.2f, 0.2f, 1);
    scene.nodes.push_back(node);
  }
  scene.meshes.push_back(square(3.5f, 2));
  scene.materials.push_back(lamp({0, 0, 60}));
  scene.nodes.emplace_back();
  scene.nodes.back().mesh = 2;
  scene.nodes.back().scale = {0.2f, 0.2f, 1};
  const ReadyScene placed(scene, AtlasKind::exact, scene::Instancing::on), plain(scene, AtlasKind::exact);
  ASSERT_TRUE(placed.assembly.has_instances());
  const image::Image with = render(placed, settings_of(16, 256)),
                     without = render(plain, settings_of(16, 256));
  for (const char* channel : {"R", "G", "B"}) {
    const Measured a = all_of(with, channel), b = all_of(without, channel);
    EXPECT_NEAR(a.mean, b.mean, 0.03 * b.mean) << channel;
    EXPECT_LT(a.deviation, 0.2 * b.mean) << channel;
  }
}

// The lamp is carried from afar to where it is bright, and further.
TEST_P(EmittersOn, MoveWhileTheShutterIsOpen) {
  scene::Scene scene = lit_square(0.2f, lamp({2, 2, 2}));
  scene::Channel channel;
  channel.node = 1;
  channel.times = {0, 1};
  channel.values = {0, 0, 4, 0, 0, 8};
  scene.animations = {{"away", {channel}}};
  ReadyScene ready(scene, AtlasKind::exact);
  ready.animation = 0;
  render::Settings settings = settings_of(16, 64);
  settings.shutter_segments = 2;
  const render::View view = render::find_view(ready.scene, ready.pose(0), "",
                                              scene::pose_bounds(ready.scene, ready.pose(0)), 16, 16);
  std::vector<render::Moment> shutter;
  for (const float time : {0.0f, 0.5f, 1.0f}) shutter.push_back({ready.pose(time), view});
  render::Renderer renderer(*backend_, ready.scene, ready.assembly, ready.atlas, settings);
  const image::Image image = renderer.render(ready.pose(0.5f), view, {}, shutter)->linear;
  double expected = 0;
  for (int i = 0; i < 100; ++i) expected += 2 * lit_by_square(0.2, 4 + 4 * (i + 0.5) / 100) / 100;
  const Measured red = all_of(image, "R");
  EXPECT_NEAR(red.mean, expected, 0.02 * expected);
  EXPECT_LT(red.deviation, 0.1 * expected);
}

INSTANTIATE_TEST_SUITE_P(, EmittersOn, testing::ValuesIn(judged_device_names()),
                         [](const auto& each) { return each.param; });

// A body of each kind of material between lamps of each kind of chart: plain, coated, textured, cut out.
scene::Scene lamps(bool layered) {
  scene::Scene scene = grid_sphere(16);
  scene.sky = scene::Sky{{0.25f, 0.5f, 1}, {1, 1, 1}, {0.5f, 0.25f, 0.125f}};
  scene::Material textured = lamp({3, 2, 1}), holes = lamp({1, 2, 3}), body = chalk();
  textured.emissive_texture.image = holes.base_color_texture.image = 0;
  holes.alpha_mask = true;
  if (layered) {
    body.transmission = 0.5f;
    body.roughness = 0.3f;
    textured.clearcoat = 0.75f;
    textured.clearcoat_roughness = 0.25f;
    textured.clearcoat_normal_texture.image = 0;
  }
  scene.materials = {body, textured, holes};
  for (scene::Part& part : scene.meshes[0].parts) part.material = 0;
  scene::Image image;
  image.width = image.height = 2;
  image.rgba = {200, 40, 230, 90, 130, 128, 255, 255, 90, 160, 220, 30, 255, 0, 128, 200};
  scene.images = {image};
  for (uint32_t i = 0; i < 4; ++i) {
    scene.meshes.push_back(square(0, 1 + i % 2));
    scene::Node node;
    node.mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
    node.translation = {i < 2 ? -1.5f : 1.5f, i % 2 == 0 ? 1 : -1, 0.5f};
    node.scale = glm::vec3(0.4f);
    scene.nodes.push_back(node);
    node.translation.z = -0.5f;  // once more, for instances
    scene.nodes.push_back(node);
  }
  scene.meshes.push_back(grid_sphere(8).meshes[0]);
  for (scene::Part& part : scene.meshes.back().parts) part.material = 1;
  scene::Node node;
  node.mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
  node.translation = {0, 1.5f, 1};
  node.scale = glm::vec3(0.3f);
  scene.nodes.push_back(node);
  return scene;
}

class EmittersParity : public testing::TestWithParam<std::string> {
 protected:
  const std::unique_ptr<render::Backend> device_ = open(GetParam(), {.validate = true}), cpu_ = open("cpu");
  void expect_equal(const ReadyScene& ready, const render::Settings& settings) {
    render::ParityBackend both(*device_, *cpu_);
    const scene::Pose pose = ready.pose(0);
    const render::View view =
        render::find_view(ready.scene, pose, "", scene::pose_bounds(ready.scene, pose), 24, 24);
    std::vector<render::Moment> shutter;
    for (uint32_t i = 0; settings.shutter_segments > 0 && i <= settings.shutter_segments; ++i)
      shutter.push_back({pose, view});
    render::Renderer renderer(both, ready.scene, ready.assembly, ready.atlas, settings);
    renderer.render(pose, view, {}, shutter);
    bool drawn = false;
    for (const render::PassDifference& row : both.differences()) {
      EXPECT_EQ(row.different, 0u) << row.pass << " " << row.buffer << " word " << row.first;
      drawn = drawn || row.pass == "emitters";
    }
    EXPECT_TRUE(drawn);
  }
};

TEST_P(EmittersParity, OfEveryPass) {
  const auto settings = [](uint32_t bounces) {
    render::Settings all = settings_of(24, 2);
    all.max_bounces = bounces;
    return all;
  };
  expect_equal(ReadyScene(lamps(true), AtlasKind::charts), settings(3));
  expect_equal(ReadyScene(lamps(false), AtlasKind::automatic, scene::Instancing::on), settings(2));
  render::Settings moving = settings(2), detailed = settings(2);
  moving.shutter_segments = 2;
  detailed.pixels_of_error = 2;
  expect_equal(ReadyScene(lamps(false), AtlasKind::exact), moving);
  expect_equal(ReadyScene(lamps(false), AtlasKind::automatic), detailed);
}

INSTANTIATE_TEST_SUITE_P(, EmittersParity, testing::ValuesIn(vulkan_device_names()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace lodestone::test
