// SPDX-License-Identifier: MIT
// What does not fit a device's memory is rendered in portions: the same picture, within the memory.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/picture.h"
#include "lodestone/test_support/rays.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

using geometry_image::AtlasKind;

constexpr uint32_t side = 32;
constexpr uint64_t megabyte = 1 << 20;

render::Settings settings_of(render::Integrator integrator, uint64_t memory) {
  render::Settings settings;
  settings.width = settings.height = side;
  settings.integrator = integrator;
  settings.max_bounces = 3;
  settings.spp = 2;
  settings.aovs = {"depth", "normal", "albedo", "uv", "id"};
  settings.device_memory = memory;
  return settings;
}

render::View view_of(const ReadyScene& ready, const scene::Pose& pose) {
  return render::find_view(ready.scene, pose, "", scene::pose_bounds(ready.scene, pose), side, side);
}

// How many portions there were.
uint32_t expect_the_same(render::Backend& backend, const ReadyScene& ready, float time,
                         render::Settings settings, float open = 0) {
  const scene::Pose pose = ready.pose(time);
  const render::View view = view_of(ready, pose);
  std::vector<render::Moment> shutter;
  for (uint32_t i = 0; open > 0 && i <= settings.shutter_segments; ++i) {
    const scene::Pose then = ready.pose(time + open * float(i) / float(settings.shutter_segments));
    shutter.push_back({then, view});
  }
  const uint64_t before = backend.allocated_bytes();
  render::Renderer portions(backend, ready.scene, ready.assembly, ready.atlas, settings);
  const image::Image found = portions.render(pose, view, {}, shutter)->linear;
  const auto streaming = portions.streaming();
  EXPECT_TRUE(streaming) << "it fits: " << backend.allocated_bytes();
  if (!streaming) return 0;
  EXPECT_LE(streaming->peak_bytes - before, settings.device_memory);
  EXPECT_LE(backend.allocated_bytes() - before, settings.device_memory);
  settings.device_memory = 0;
  render::Renderer whole(backend, ready.scene, ready.assembly, ready.atlas, settings);
  const image::Image expected = whole.render(pose, view, {}, shutter)->linear;
  EXPECT_FALSE(whole.streaming());
  EXPECT_EQ(found.channels.size(), expected.channels.size());
  for (const image::Channel& channel : expected.channels) {
    const image::Channel& other = *found.find(channel.name);
    uint64_t different = 0;
    for (size_t i = 0; i < channel.values.size(); ++i)
      different += std::bit_cast<uint32_t>(channel.values[i]) != std::bit_cast<uint32_t>(other.values[i]);
    EXPECT_EQ(different, 0u) << channel.name;
    EXPECT_EQ(channel.ids, other.ids) << channel.name;
  }
  return streaming->portions;
}

class PortionsOn : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<render::Backend> backend_ = open(GetParam());
};

TEST_P(PortionsOn, ShowWhatTheWholeDoesWithEveryIntegrator) {
  const ReadyScene terrain("builtin:terrain");
  for (const auto integrator :
       {render::Integrator::eye, render::Integrator::dof, render::Integrator::ao,
        render::Integrator::specular, render::Integrator::glossy, render::Integrator::path})
    EXPECT_GT(expect_the_same(*backend_, terrain, 0.3f, settings_of(integrator, 4 * megabyte)), 2u)
        << to_string(integrator);
}

TEST_P(PortionsOn, ShowEveryKindOfChart) {
  for (const AtlasKind kind : {AtlasKind::exact, AtlasKind::charts}) {
    geometry_image::AtlasSettings settings = kind;
    if (kind == AtlasKind::charts) settings.charts.texel_budget = 60000;
    const ReadyScene ready("builtin:spheres", settings);
    EXPECT_GT(expect_the_same(*backend_, ready, 0.2f, settings_of(render::Integrator::path, 4 * megabyte)),
              1u);
  }
}

TEST_P(PortionsOn, ShowWhatMovesWhileTheShutterIsOpen) {
  render::Settings settings = settings_of(render::Integrator::path, 4 * megabyte);
  settings.shutter_segments = 2;
  EXPECT_GT(expect_the_same(*backend_, ReadyScene("builtin:terrain"), 0.1f, settings, 0.25f), 2u);
}

// Two squares of a checkered mask before a sphere: rays go on behind what is cut out, through portions that
// they have passed, at the very place where they have been.
TEST_P(PortionsOn, LetRaysThroughMasks) {
  scene::Scene scene = grid_sphere(128);
  scene::Material holes;
  holes.alpha_mask = true;
  holes.base_color_texture.image = 0;
  scene::Image checkers;
  checkers.width = checkers.height = 8;
  for (uint32_t i = 0; i < 64; ++i) {
    const bool there = (i % 8 + i / 8) % 2 == 0;
    checkers.rgba.insert(checkers.rgba.end(), {200, uint8_t(4 * i), 90, uint8_t(there ? 255 : 0)});
  }
  scene.images = {checkers};
  scene.materials = {scene::Material(), holes};
  for (const float z : {1.4f, 1.4f, 1.6f}) {
    scene.meshes.push_back(square(z, 1));
    scene.nodes.emplace_back();
    scene.nodes.back().mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
  }
  for (const AtlasKind kind : {AtlasKind::automatic, AtlasKind::exact}) {
    const ReadyScene ready(scene, kind);
    EXPECT_GT(expect_the_same(*backend_, ready, 0, settings_of(render::Integrator::eye, 3 * megabyte)), 1u);
  }
}

// What shines is large enough to be cut, or many charts; points of it are drawn where none of it is there.
TEST_P(PortionsOn, AreLitByWhatShinesInOthers) {
  scene::Scene scene = grid_sphere(128);
  scene.sky = scene::Sky{};
  scene::Material lamp;
  lamp.emissive = {1, 2, 3};
  lamp.emissive_texture.image = 0;
  scene::Image checkers;
  checkers.width = checkers.height = 2;
  checkers.rgba = {255, 255, 255, 255, 0, 0, 0, 255, 90, 90, 200, 255, 200, 9, 90, 255};
  scene.images = {checkers};
  scene.materials = {scene::Material(), lamp};
  scene.meshes.push_back(grid_sphere(40).meshes[0]);
  scene.meshes.push_back(square(2, 1));
  for (scene::Part& part : scene.meshes[1].parts) part.material = 1;
  for (const float x : {-2.0f, 2.5f}) {
    scene.nodes.emplace_back();
    scene.nodes.back().mesh = x < 0 ? 1 : 2;
    scene.nodes.back().translation = {x, 0.5f, 0.25f};
  }
  scene::Channel channel;
  channel.node = static_cast<uint32_t>(scene.nodes.size() - 1);
  channel.times = {0, 1};
  channel.values = {2.5f, 0.5f, 0.25f, 2, -0.5f, 0.5f};
  scene.animations = {{"carried", {channel}}};
  for (const AtlasKind kind : {AtlasKind::automatic, AtlasKind::exact}) {
    ReadyScene ready(scene, kind);
    ready.animation = 0;
    const bool exact = kind == AtlasKind::exact;
    render::Settings settings = settings_of(render::Integrator::path, (exact ? 8 : 4) * megabyte);
    settings.spp = 1;
    settings.max_bounces = 2;
    EXPECT_GT(expect_the_same(*backend_, ready, 0.5f, settings), 1u);
    if (exact) continue;
    settings.shutter_segments = 2;
    EXPECT_GT(expect_the_same(*backend_, ready, 0.25f, settings, 0.5f), 1u);
  }
}

TEST_P(PortionsOn, FindTheHitsOfTheWholeOnEdgesAndCorners) {
  const ReadyScene ready(grid_sphere(192));
  const std::vector<glm::vec3> texels = ready.texels(ready.pose(0));
  Rays rays = random_rays({-1, -1, -1}, {1, 1, 1}, 2000, 5);
  const glm::vec3 eyes[] = {{0, 0, 0}, {0.1f, 0.2f, 3}, {-2, 1, 0.5f}};
  for (size_t i = 0; i < texels.size(); i += 11) {
    add_ray(rays, eyes[i % 3], texels[i] - eyes[i % 3]);
    if (i + 1 < texels.size()) add_ray(rays, eyes[i % 3], 0.5f * (texels[i] + texels[i + 1]) - eyes[i % 3]);
  }
  const auto hits_of = [&](uint64_t memory, render::Traversal traversal) {
    render::Settings settings;
    settings.width = settings.height = 8;
    settings.traversal = traversal;
    settings.device_memory = memory;
    render::Renderer renderer(*backend_, ready.scene, ready.assembly, ready.atlas, settings);
    EXPECT_EQ(renderer.streaming().has_value(), memory > 0);
    renderer.update(ready.pose(0));
    renderer.load_rays(rays);
    renderer.trace_loaded();
    return renderer.hits();
  };
  const auto expected = hits_of(0, render::Traversal::wide);
  // One traversal of the others is enough: they agree on the whole.
  for (const render::Traversal traversal : {render::Traversal::wide, render::Traversal::threaded}) {
    const auto found = hits_of(4 * megabyte, traversal);
    ASSERT_EQ(found.size(), expected.size());
    uint64_t different = 0;
    for (size_t i = 0; i < found.size(); ++i) different += found[i] != expected[i] ? 1 : 0;
    EXPECT_EQ(different, 0u) << to_string(traversal);
  }
}

TEST_P(PortionsOn, FollowAnAnimation) {
  const ReadyScene ready("builtin:terrain");
  render::Settings settings = settings_of(render::Integrator::eye, 4 * megabyte);
  render::Renderer portions(*backend_, ready.scene, ready.assembly, ready.atlas, settings);
  settings.device_memory = 0;
  const auto other = open(GetParam());
  render::Renderer whole(*other, ready.scene, ready.assembly, ready.atlas, settings);
  for (const float time : {0.0f, 0.4f, 0.4f, 1.1f}) {
    const scene::Pose pose = ready.pose(time);
    const render::View view = view_of(ready, pose);
    EXPECT_EQ(portions.render(pose, view)->display.find("G")->values,
              whole.render(pose, view)->display.find("G")->values)
        << time;
  }
}

INSTANTIATE_TEST_SUITE_P(, PortionsOn, testing::ValuesIn(judged_device_names()),
                         [](const auto& each) { return each.param; });

class PortionsParity : public testing::TestWithParam<std::string> {};

TEST_P(PortionsParity, OfEveryPass) {
  const auto device = open(GetParam(), {.validate = true}), cpu = open("cpu");
  render::ParityBackend both(*device, *cpu);
  for (const AtlasKind kind : {AtlasKind::automatic, AtlasKind::charts}) {
    geometry_image::AtlasSettings charts = kind;
    if (kind == AtlasKind::charts) charts.charts.texel_budget = 60000;
    const ReadyScene ready(kind == AtlasKind::charts ? "builtin:spheres" : "builtin:terrain", charts);
    render::Settings settings = settings_of(render::Integrator::path, 3 * megabyte);
    settings.width = settings.height = 24;
    settings.shutter_segments = kind == AtlasKind::charts ? 0 : 1;
    const scene::Pose pose = ready.pose(0.2f);
    const render::View view = view_of(ready, pose);
    std::vector<render::Moment> shutter;
    if (settings.shutter_segments > 0) shutter = {{ready.pose(0.2f), view}, {ready.pose(0.3f), view}};
    render::Renderer renderer(both, ready.scene, ready.assembly, ready.atlas, settings);
    ASSERT_TRUE(renderer.streaming());
    renderer.render(pose, view, {}, shutter);
  }
  EXPECT_FALSE(both.differences().empty());
  for (const render::PassDifference& difference : both.differences())
    EXPECT_EQ(difference.different, 0u) << difference.pass << " " << difference.buffer;
}

INSTANTIATE_TEST_SUITE_P(, PortionsParity, testing::ValuesIn(vulkan_device_names()),
                         [](const auto& each) { return each.param; });

// Whoever gives too little is told how much would do, and that does.
TEST(PortionsRefusals, SayHowMuchMemoryWouldDo) {
  const auto backend = open("cpu");
  const ReadyScene ready("builtin:terrain");
  render::Settings settings = settings_of(render::Integrator::eye, 1000);
  try {
    render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    const std::string text = error.what();
    const size_t at = text.find("at least ");
    ASSERT_NE(at, std::string::npos) << text;
    settings.device_memory = std::stoull(text.substr(at + 9)) * megabyte;
  }
  EXPECT_GT(expect_the_same(*backend, ready, 0, settings), 2u);
}

TEST(PortionsRefusals, NameTheOptionThatNeedsTheWhole) {
  const auto backend = open("cpu");
  const auto text_of = [&](const ReadyScene& ready, const render::Settings& settings) -> std::string {
    try {
      render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage);
      return error.what();
    }
    return "";
  };
  render::Settings settings = settings_of(render::Integrator::eye, 4 * megabyte);
  settings.pixels_of_error = 1;
  EXPECT_NE(text_of(ReadyScene("builtin:terrain"), settings).find("--pixels-of-error"), std::string::npos);
  settings.pixels_of_error = 0;
  settings.relaxation_sweeps = 2;
  EXPECT_NE(text_of(ReadyScene("builtin:terrain"), settings).find("--relaxation-sweeps"), std::string::npos);
  settings.relaxation_sweeps = 0;
  const ReadyScene instanced("builtin:teapots", AtlasKind::automatic, scene::Instancing::on);
  EXPECT_NE(text_of(instanced, settings).find("--instancing off"), std::string::npos);
}

}  // namespace
}  // namespace lodestone::test
