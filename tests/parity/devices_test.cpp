// SPDX-License-Identifier: MIT
// Every pass of a frame on every device against the CPU, to the bit; and that a fault in any pass is found
// there.
#include <gtest/gtest.h>

#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/layout/tile.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/environments.h"
#include "lodestone/test_support/instanced_scenes.h"
#include "lodestone/test_support/mapped_charts.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

render::Settings small_settings() {
  render::Settings settings;
  settings.width = 72;  // not a multiple of a tile
  settings.height = 51;
  settings.spp = 2;
  settings.aovs = {"depth", "normal", "albedo", "uv", "id", "lod", "steps"};
  return settings;
}

// A device and the CPU, opened once a test: most of the time of a small picture goes into making kernels.
struct Pair {
  explicit Pair(std::unique_ptr<render::Backend> opened) : device(std::move(opened)) {}
  std::unique_ptr<render::Backend> device, cpu = cpu_fallback::make_cpu_backend({});
};

// Renders one frame on the device with the CPU beside it.
std::vector<render::PassDifference> differences(const ReadyScene& ready, const Pair& pair, float time,
                                                const render::Settings& settings,
                                                std::optional<render::Fault> fault = {}) {
  render::ParityBackend both(*pair.device, *pair.cpu, fault);
  render::Renderer renderer(both, ready.scene, ready.assembly, ready.atlas, settings);
  const scene::Pose pose = ready.pose(time);
  const auto bounds = scene::pose_bounds(ready.scene, pose);
  renderer.render(pose, render::find_view(ready.scene, pose, "", bounds, settings.width, settings.height));
  return both.differences();
}

class Devices : public testing::TestWithParam<std::string> {
 protected:
  const Pair pair_{open(GetParam(), {.validate = true})};
};

void expect_equal(const std::vector<render::PassDifference>& rows) {
  EXPECT_GE(rows.size(), 20u);
  for (const auto& row : rows) {
    EXPECT_EQ(row.different, 0u) << row.pass << " " << row.buffer << " word " << row.first << std::hex << ": "
                                 << row.device_value << " against " << row.reference_value;
  }
}

// Those that need no subgroups, and `tile` where there are any of 8.
std::vector<render::Traversal> all_traversals(const Pair& pair) {
  std::vector<render::Traversal> all = {render::Traversal::threaded, render::Traversal::octant,
                                        render::Traversal::wide};
  if (pair.device->info().subgroup_size == layout::tile_lanes) all.push_back(render::Traversal::tile);
  return all;
}

void expect_equal(const ReadyScene& ready, const Pair& pair, const render::Settings& settings) {
  for (const float time : {0.0f, 0.6f}) expect_equal(differences(ready, pair, time, settings));
}

TEST_P(Devices, GiveTheBitsOfTheCpuOnSpheresByOctants) {
  render::Settings settings = small_settings();
  settings.traversal = render::Traversal::octant;
  expect_equal(ReadyScene("builtin:spheres"), pair_, settings);
}

TEST_P(Devices, GiveTheBitsOfTheCpuOnTerrainByLinks) {
  render::Settings settings = small_settings();
  settings.traversal = render::Traversal::threaded;
  expect_equal(ReadyScene("builtin:terrain"), pair_, settings);
}

TEST_P(Devices, GiveTheBitsOfTheCpuOnAnExactAtlas) {
  expect_equal(ReadyScene("builtin:spheres", geometry_image::AtlasKind::exact), pair_, small_settings());
}

TEST_P(Devices, GiveTheBitsOfTheCpuOnResampledSpheres) {
  for (const auto traversal : all_traversals(pair_)) {
    render::Settings settings = small_settings();
    settings.traversal = traversal;
    expect_equal(ReadyScene("builtin:spheres", geometry_image::AtlasKind::charts), pair_, settings);
  }
}

TEST_P(Devices, GiveTheBitsOfTheCpuOnMappedChartsAndBesideThem) {
  ReadyScene spheres("builtin:spheres"), head("builtin:head");
  map_grids(spheres.atlas);
  expect_equal(spheres, pair_, small_settings());
  map_grids(head.atlas, 2);
  expect_equal(head, pair_, small_settings());
  for (const bool tangents : {true, false})
    expect_equal(straddled_squares({.tangents = tangents, .cut_out = tangents}), pair_, small_settings());
}

TEST_P(Devices, GiveTheBitsOfTheCpuOnMorphsSkinsAndTextures) {
  const auto file = data_file("RobotExpressive.glb");
  if (!file) GTEST_SKIP() << "shared data are absent";
  for (const auto kind : {geometry_image::AtlasKind::exact, geometry_image::AtlasKind::charts})
    expect_equal(ReadyScene(*file, kind), pair_, small_settings());
}

// With no light but the map, and with a key light beside it.
TEST_P(Devices, GiveTheBitsOfTheCpuUnderEnvironmentMaps) {
  const Pair split(open_split(GetParam(), 20000, {.validate = true}));
  for (const char* name : {"builtin:spheres", "builtin:tiny"}) {
    ReadyScene ready(name);
    ready.scene.environment = sunny_environment(130, 65, 2);
    ready.scene.environment->rotation = 40;
    render::Settings settings = small_settings();
    settings.spp = 4;
    expect_equal(ready, pair_, settings);
    expect_equal(differences(ready, split, 0.6f, settings));
  }
}

TEST_P(Devices, ResumeRaysThatRunOutOfBudgetWithTheSameBits) {
  render::Settings settings = small_settings();
  for (const auto traversal : all_traversals(pair_)) {
    settings.traversal = traversal;
    settings.aovs = {"depth", "id"};  // for `steps` no tiles are traced
    settings.loop_budget = 7;
    expect_equal(ReadyScene("builtin:tiny"), pair_, settings);
    settings.loop_budget = 40;
    expect_equal(ReadyScene("builtin:spheres"), pair_, settings);
  }
}

// As with scenes whose arrays are larger than a buffer of the device can be: here most of them.
TEST_P(Devices, SplitArraysOverSeveralBuffersWithTheSameBits) {
  using geometry_image::AtlasKind;
  const Pair split(open_split(GetParam(), 20000, {.validate = true}));
  for (const auto kind : {AtlasKind::grid, AtlasKind::exact, AtlasKind::charts}) {
    const ReadyScene ready("builtin:spheres", kind);
    for (const auto traversal : all_traversals(pair_)) {
      render::Settings settings = small_settings();
      settings.traversal = traversal;
      expect_equal(differences(ready, split, 0.6f, settings));
    }
  }
}

// Cut-out layers in one plane and behind each other.
ReadyScene masked_scene(geometry_image::AtlasKind kind) {
  scene::Material cut;
  cut.base_color.w = 0.2f;
  cut.alpha_mask = true;
  return ReadyScene(
      facing_camera({square(0.25f, 0), square(0.25f, 1), square(0.5f, 0), square(-0.5f, 0)}, {cut, {}}),
      kind);
}

TEST_P(Devices, GiveTheBitsOfTheCpuThroughCutOutSurfaces) {
  for (const auto kind : {geometry_image::AtlasKind::exact, geometry_image::AtlasKind::charts}) {
    const ReadyScene ready = masked_scene(kind);
    for (const auto traversal : all_traversals(pair_)) {
      render::Settings settings = small_settings();
      settings.traversal = traversal;
      expect_equal(ready, pair_, settings);
    }
  }
}

TEST_P(Devices, GiveTheBitsOfTheCpuThroughInstances) {
  const ReadyScene ready(grove(), {}, scene::Instancing::on);
  for (const auto traversal : all_traversals(pair_)) {
    render::Settings settings = small_settings();
    settings.traversal = traversal;
    expect_equal(ready, pair_, settings);
  }
  render::Settings settings = small_settings();
  settings.integrator = render::Integrator::path;
  settings.loop_budget = 3;  // rays rest on their way through both levels
  expect_equal(ready, pair_, settings);
}

// A coated, a transparent and a plain square, each beside the others in the picture; all textures used.
scene::Scene layered_squares() {
  scene::Texture texture;
  texture.image = 0;
  scene::Material coat, glass;
  coat.clearcoat = 0.75f;
  coat.clearcoat_roughness = 0.5f;
  coat.emissive = {0.25f, 0.5f, 0.125f};
  coat.clearcoat_texture = coat.clearcoat_roughness_texture = coat.clearcoat_normal_texture = texture;
  glass.metallic = 0;
  glass.ior = 1.75f;
  glass.specular = 0.5f;
  glass.specular_color = {1, 0.5f, 2};
  glass.transmission = 0.75f;
  glass.specular_texture = glass.specular_color_texture = glass.transmission_texture = texture;
  std::vector<scene::Mesh> squares = {square(0, 0), square(0.25f, 1), square(-0.25f, 2)};
  for (uint32_t i = 0; i < 3; ++i) {
    for (glm::vec3& p : squares[i].positions) p.x = p.x * 0.4f + static_cast<float>(i) * 0.9f - 0.9f;
  }
  scene::Scene scene = facing_camera(squares, {coat, glass, {}});
  scene.sky = scene::Sky{{0.25f, 0.5f, 1}, {1, 1, 1}, {0.5f, 0.25f, 0.125f}};
  scene::Image image;
  image.width = image.height = 2;
  image.rgba = {200, 40, 230, 90, 130, 128, 255, 255, 90, 160, 220, 30, 255, 0, 128, 200};
  scene.images = {image};
  scene::Light light;
  light.intensity = 20;
  scene.lights = {light};
  scene::Node lamp;
  lamp.light = 0;
  lamp.translation = {0.5f, 1, 2};
  scene.nodes.push_back(lamp);
  return scene;
}

TEST_P(Devices, GiveTheBitsOfTheCpuOnLayeredMaterials) {
  for (const auto kind : {geometry_image::AtlasKind::exact, geometry_image::AtlasKind::charts})
    expect_equal(ReadyScene(layered_squares(), kind), pair_, small_settings());
}

// Glass, coats and mirrors, lit by lamps, a sky and a map, through cut-out layers, and out of focus.
TEST_P(Devices, GiveTheBitsOfTheCpuWithEveryIntegrator) {
  using enum render::Integrator;
  scene::Scene squares = layered_squares();
  squares.materials[1].thickness = 1;
  squares.materials[1].attenuation_distance = 0.5f;
  squares.materials[1].attenuation_color = {0.25f, 0.5f, 0.75f};
  ReadyScene layers(squares, geometry_image::AtlasKind::charts), spheres("builtin:spheres");
  spheres.scene.environment = sunny_environment(33, 17, 2);
  const ReadyScene masked = masked_scene(geometry_image::AtlasKind::exact);
  for (const auto integrator : {dof, ao, specular, glossy, path}) {
    SCOPED_TRACE(render::to_string(integrator));
    render::Settings settings = small_settings();
    settings.integrator = integrator;
    settings.max_bounces = 4;
    settings.lens_radius = 0.05f;
    for (const ReadyScene* ready : std::initializer_list<const ReadyScene*>{&layers, &spheres, &masked})
      expect_equal(differences(*ready, pair_, 0.6f, settings));
  }
}

// One bit of what a pass wrote, and nothing else, in the row of that pass.
TEST_P(Devices, ShowAFaultInThePassItHappenedIn) {
  constexpr uint32_t bit = 70;
  const ReadyScene ready = masked_scene(geometry_image::AtlasKind::exact);
  for (const char* pass : {"links", "blend", "rasterise", "bounds", "camera", "trace", "mask", "aov", "shade",
                           "occlude", "accumulate", "resolve"}) {
    render::Settings settings = small_settings();
    if (std::string(pass) == "links") settings.traversal = render::Traversal::threaded;
    const auto rows = differences(ready, pair_, 0, settings, render::Fault{pass, bit});
    uint32_t found = 0;
    for (const auto& row : rows) {
      if (row.different == 0) continue;
      ++found;
      EXPECT_EQ(row.pass, pass);
      EXPECT_EQ(row.different, 1u) << pass;
      EXPECT_EQ(row.first, bit / 32) << pass;
      EXPECT_EQ(row.device_value ^ row.reference_value, 1u << bit % 32) << pass;
    }
    EXPECT_EQ(found, 1u) << pass;
  }
}

INSTANTIATE_TEST_SUITE_P(, Devices, testing::ValuesIn(vulkan_device_names()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace lodestone::test
