// SPDX-License-Identifier: MIT
// Motion blur: pixels get as much of a surface as it covers them of the time, whatever moves.
#include <gtest/gtest.h>

#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/test_support/bulging_sphere.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/picture.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

using geometry_image::AtlasKind;

constexpr uint32_t side = 48;

render::Settings settings_of(uint32_t segments, uint32_t spp) {
  render::Settings settings;
  settings.width = settings.height = side;
  settings.spp = spp;
  settings.shutter_segments = segments;
  return settings;
}

class Motion : public testing::TestWithParam<std::string> {
 protected:
  // At the poses at the ends of the segments; lit as at the first of them.
  image::Image render(const ReadyScene& ready, const std::vector<scene::Pose>& poses,
                      render::Settings settings) const {
    return render_on(*backend_, ready, poses, settings);
  }

  static image::Image render_on(render::Backend& backend, const ReadyScene& ready,
                                const std::vector<scene::Pose>& poses, const render::Settings& settings) {
    render::Renderer renderer(backend, ready.scene, ready.assembly, ready.atlas, settings);
    std::vector<render::Moment> moments;
    for (const scene::Pose& pose : poses)
      moments.push_back({pose, render::find_view(ready.scene, pose, "0", {}, side, side)});
    const render::View view = moments.front().view;
    if (settings.shutter_segments == 0) moments.clear();
    return renderer.render(poses.front(), view, {}, moments)->linear;
  }

  const std::unique_ptr<render::Backend> backend_ = open(GetParam(), {.validate = GetParam() != "cpu"});
};

// Node `node` so far to the right.
scene::Pose moved(const ReadyScene& ready, uint32_t node, float x) {
  scene::Pose pose = ready.pose(0);
  pose.node_world[node][3].x += x;
  return pose;
}

float pixel_center(uint32_t x) {
  return 3 * (static_cast<float>(x) + 0.5f) / side - 1.5f;
}

// How much of the way from -1 to 1 a point is within 1 of.
float covered(float x) {
  return std::max(0.0f, std::min(1.0f, x + 1) - std::max(-1.0f, x - 1)) / 2;
}

constexpr uint32_t samples = 64;
// The times of a pixel's samples fall one in each 64th, and a pixel is a 32nd of the way.
constexpr float share_error = 2.0f / samples + 1.0f / 32;

TEST_P(Motion, CoversAPixelForItsShareOfTheTime) {
  const ReadyScene ready(facing_camera({square(0, 0)}, {{}}), AtlasKind::exact);
  const image::Image image =
      render(ready, {moved(ready, 0, -1), moved(ready, 0, 1)}, settings_of(1, samples));
  uint32_t partly = 0;
  for (uint32_t x = 0; x < side; ++x) {
    const float share = covered(pixel_center(x));
    EXPECT_NEAR(value(image, "A", x, side / 2), share, share_error) << x;
    partly += share > 0.1f && share < 0.9f ? 1 : 0;
  }
  EXPECT_GT(partly, side / 2);
}

// Rests, goes, rests.
TEST_P(Motion, IsAlongALineInEachSegment) {
  const ReadyScene ready(facing_camera({square(0, 0)}, {{}}), AtlasKind::exact);
  const scene::Pose left = moved(ready, 0, -1), right = moved(ready, 0, 1);
  const image::Image image = render(ready, {left, left, right, right}, settings_of(3, samples));
  for (uint32_t x = 0; x < side; ++x) {
    const float at = pixel_center(x), on_left = at < 0 ? 1 : 0, on_right = at > 0 ? 1 : 0;
    EXPECT_NEAR(value(image, "A", x, side / 2), (on_left + covered(at) + on_right) / 3, share_error) << x;
  }
}

TEST_P(Motion, OfTheCameraIsThatOfTheSceneTheOtherWayRound) {
  const ReadyScene ready(facing_camera({square(0, 0)}, {{}}), AtlasKind::exact);
  const uint32_t camera = 1;
  ASSERT_EQ(ready.scene.nodes[camera].camera, 0u);
  const image::Image scene_moves =
      render(ready, {moved(ready, 0, -1), moved(ready, 0, 1)}, settings_of(1, samples));
  const image::Image camera_moves =
      render(ready, {moved(ready, camera, 1), moved(ready, camera, -1)}, settings_of(1, samples));
  for (uint32_t x = 0; x < side; ++x) {
    // Rounding may put a sample on the other side of an edge.
    EXPECT_NEAR(value(scene_moves, "A", x, side / 2), value(camera_moves, "A", x, side / 2), 1.5f / samples)
        << x;
  }
}

scene::Pose bulged(const ReadyScene& ready, float weight) {
  scene::Pose pose = ready.pose(0);
  scene::override_weights(ready.scene, {{"bulge", weight}}, pose);
  return pose;
}

// Morph targets move vertices along lines: in the middle of the time they are where half of the weight puts
// them.
TEST_P(Motion, IsWhereItShouldBeInTheMiddleOfTheTime) {
  const ReadyScene ready(bulging_sphere(12), AtlasKind::exact);
  render::Settings settings = settings_of(1, 1);
  settings.aovs = {"depth", "normal", "uv", "id"};
  const image::Image moving = render(ready, {bulged(ready, 0.2f), bulged(ready, 0.8f)}, settings);
  settings.shutter_segments = 0;
  const image::Image still = render(ready, {bulged(ready, 0.5f)}, settings);
  uint32_t hits = 0, different = 0;
  for (uint32_t i = 0; i < side * side; ++i) {
    const float a = moving.find("depth.Z")->values[i], b = still.find("depth.Z")->values[i];
    if (std::isinf(b)) {
      different += std::isinf(a) ? 0 : 1;
      continue;
    }
    ++hits;
    different += std::abs(a - b) < 1e-4f * b ? 0 : 1;
  }
  EXPECT_GT(hits, 300u);
  EXPECT_LE(different, 4u);  // silhouettes
}

TEST_P(Motion, OfWhatRestsLeavesThePictureAlone) {
  for (const auto kind : {AtlasKind::exact, AtlasKind::charts}) {
    const ReadyScene ready(bulging_sphere(8), kind);
    render::Settings settings = settings_of(0, 4);
    settings.integrator = render::Integrator::path;
    settings.max_bounces = 3;
    settings.aovs = {"depth", "normal", "uv", "id"};
    const scene::Pose pose = bulged(ready, 0.7f);
    const image::Image still = render(ready, {pose}, settings);
    settings.shutter_segments = 2;
    const image::Image moving = render(ready, {pose, pose, pose}, settings);
    ASSERT_EQ(still.channels.size(), moving.channels.size());
    for (size_t c = 0; c < still.channels.size(); ++c) {
      EXPECT_EQ(still.channels[c].values, moving.channels[c].values) << still.channels[c].name;
      EXPECT_EQ(still.channels[c].ids, moving.channels[c].ids) << still.channels[c].name;
    }
  }
}

TEST_P(Motion, IsTheSameWithEveryTraversal) {
  const ReadyScene ready(bulging_sphere(10), AtlasKind::charts);
  const std::vector<scene::Pose> poses = {bulged(ready, 0), bulged(ready, 1), bulged(ready, 0.3f)};
  render::Settings settings = settings_of(2, 4);
  settings.lens_radius = 0.1f;
  settings.focus_distance = 4;
  std::vector<image::Image> images;
  for (const auto traversal : {render::Traversal::threaded, render::Traversal::octant,
                               render::Traversal::wide, render::Traversal::automatic}) {
    settings.traversal = traversal;
    images.push_back(render(ready, poses, settings));
  }
  for (size_t i = 1; i < images.size(); ++i) {
    for (const char* channel : {"R", "G", "B", "A"})
      EXPECT_EQ(images[0].find(channel)->values, images[i].find(channel)->values) << i << " " << channel;
  }
}

class MotionParity : public Motion {};

TEST_P(MotionParity, OfEveryPass) {
  const auto cpu = open("cpu");
  for (const auto kind : {AtlasKind::exact, AtlasKind::charts}) {
    scene::Scene scene = bulging_sphere(8);
    scene.materials.assign(1, {});
    scene.materials[0].base_color.w = 0.5f;
    scene.materials[0].alpha_mask = kind == AtlasKind::exact;
    const ReadyScene ready(std::move(scene), kind);
    const std::vector<scene::Pose> poses = {bulged(ready, 0), bulged(ready, 1), bulged(ready, 0.3f)};
    for (const auto traversal : {render::Traversal::threaded, render::Traversal::octant,
                                 render::Traversal::wide, render::Traversal::automatic}) {
      render::Settings settings = settings_of(2, 2);
      settings.traversal = traversal;
      settings.integrator = render::Integrator::path;
      settings.max_bounces = 2;
      settings.loop_budget = 40;  // rays rest on their way
      settings.aovs = {"depth", "normal", "albedo", "uv", "id", "lod", "steps"};
      render::ParityBackend both(*backend_, *cpu);
      render_on(both, ready, poses, settings);
      EXPECT_GE(both.differences().size(), 20u);
      for (const render::PassDifference& row : both.differences())
        EXPECT_EQ(row.different, 0u) << row.pass << " " << row.buffer << " word " << row.first;
    }
  }
}

TEST(MotionBlur, WantsTheMomentsAtTheEndsOfItsSegments) {
  const auto cpu = open("cpu");
  const ReadyScene ready(facing_camera({square(0, 0)}, {{}}), AtlasKind::exact);
  const scene::Pose pose = ready.pose(0);
  const render::View view = render::find_view(ready.scene, pose, "0", {}, side, side);
  for (const uint32_t segments : {0u, 2u}) {
    render::Renderer renderer(*cpu, ready.scene, ready.assembly, ready.atlas, settings_of(segments, 1));
    EXPECT_THROW(renderer.render(pose, view, {}, {{pose, view}, {pose, view}}), Error) << segments;
  }
}

INSTANTIATE_TEST_SUITE_P(, MotionParity, testing::ValuesIn(vulkan_device_names()),
                         [](const auto& each) { return each.param; });
INSTANTIATE_TEST_SUITE_P(, Motion, testing::ValuesIn(judged_device_names()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace lodestone::test
