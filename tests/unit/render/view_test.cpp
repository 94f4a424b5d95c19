// SPDX-License-Identifier: MIT
#include "lodestone/render/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "lodestone/base/error.h"

namespace lodestone::render {
namespace {

constexpr uint32_t width = 200, height = 100;

scene::Scene scene_with_camera(scene::Camera camera, scene::Node node = {}) {
  scene::Scene scene;
  scene.name = "room";
  scene.cameras.push_back(std::move(camera));
  node.camera = 0;
  scene.nodes.push_back(std::move(node));
  return scene;
}

scene::Camera named(const std::string& name) {
  scene::Camera camera;
  camera.name = name;
  return camera;
}

View view_of(const scene::Scene& scene, const std::string& name = "") {
  return find_view(scene, scene::evaluate(scene, scene::none, 0), name, scene::Bounds(), width, height);
}

void expect_near(const glm::vec3& a, const glm::vec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-6f) << "xyz"[i];
}

TEST(View, OfPerspectiveCameraSpansItsAngleInHeight) {
  scene::Camera camera = named("Front");
  camera.yfov = 2 * std::atan(0.5f);
  scene::Node node;
  node.translation = {1, 2, 3};
  node.scale = {4, 5, 6};  // a camera that is scaled sees the same
  const View view = view_of(scene_with_camera(camera, node));
  EXPECT_TRUE(view.perspective);
  EXPECT_EQ(view.name, "Front");
  expect_near(view.origin, {1, 2, 3});
  expect_near(view.forward, {0, 0, -1});
  expect_near(view.up, {0, 0.5f, 0});
  expect_near(view.right, {1, 0, 0});
}

TEST(View, OfOrthographicCameraSpansItsHalfHeight) {
  scene::Camera camera = named("Plan");
  camera.perspective = false;
  camera.ymag = 3;
  const View view = view_of(scene_with_camera(camera));
  EXPECT_FALSE(view.perspective);
  expect_near(view.up, {0, 3, 0});
  expect_near(view.right, {6, 0, 0});
}

TEST(View, AutoSeesEveryCornerOfTheBounds) {
  scene::Bounds bounds;
  bounds.include(glm::vec3(-3, 10, 2));
  bounds.include(glm::vec3(5, 11, 90));
  const scene::Scene scene;
  const View view = find_view(scene, scene::evaluate(scene, scene::none, 0), "auto", bounds, width, height);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? 5 : -3, corner & 2 ? 11 : 10, corner & 4 ? 90 : 2);
    const glm::vec3 d = p - view.origin;
    const float along = glm::dot(d, view.forward);
    EXPECT_GT(along, 0) << corner;
    EXPECT_LE(std::abs(glm::dot(d, view.right)) / glm::dot(view.right, view.right), along) << corner;
    EXPECT_LE(std::abs(glm::dot(d, view.up)) / glm::dot(view.up, view.up), along) << corner;
  }
}

struct BadCamera {
  const char* name;
  scene::Node node;
  scene::Camera camera;
};

scene::Node scaled(const glm::vec3& scale) {
  scene::Node node;
  node.scale = scale;
  return node;
}

scene::Node placed_at(const glm::vec3& place) {
  scene::Node node;
  node.translation = place;
  return node;
}

scene::Camera orthographic(float ymag) {
  scene::Camera camera;
  camera.perspective = false;
  camera.ymag = ymag;
  return camera;
}

scene::Camera perspective(float yfov) {
  scene::Camera camera;
  camera.yfov = yfov;
  return camera;
}

class CameraThatSeesNothing : public testing::TestWithParam<BadCamera> {};

TEST_P(CameraThatSeesNothing, IsRefusedByName) {
  scene::Camera camera = GetParam().camera;
  camera.name = "Back";
  try {
    view_of(scene_with_camera(camera, GetParam().node));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    const std::string text = error.what();
    for (const char* part : {"room", "camera Back", "--camera"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
const BadCamera bad_cameras[] = {
    {"ScaledToNothing", scaled({0, 0, 0}), {}},
    {"ScaledToALine", scaled({0, 1, 0}), {}},
    {"WithoutWidth", scaled({0, 1, 1}), {}},
    {"WithoutHeight", scaled({1, 0, 1}), {}},
    {"WithoutDepth", scaled({1, 1, 0}), {}},
    {"TooFarOut", placed_at({0, 1e30f, 0}), {}},
    {"OrthographicOfNoHeight", {}, orthographic(0)},
    {"OrthographicBeyondNumbers", {}, orthographic(infinity)},
    {"AngleOfNothing", {}, perspective(0)},
    {"AngleIsNoNumber", {}, perspective(nan)},
};

std::string name_of(const testing::TestParamInfo<BadCamera>& tested) {
  return tested.param.name;
}

INSTANTIATE_TEST_SUITE_P(Cameras, CameraThatSeesNothing, testing::ValuesIn(bad_cameras), name_of);

}  // namespace
}  // namespace lodestone::render
