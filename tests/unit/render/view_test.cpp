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
  std::vector<CameraChoice> choices(1);
  for (const float azimuth : {0.0f, 90.0f, 200.0f, -300.0f}) {
    for (const float elevation : {-90.0f, -10.0f, 0.0f, 89.9999f, 90.0f}) {
      choices.emplace_back().orbit = glm::vec2(azimuth, elevation);
      choices.back().field_of_view = elevation > 0 ? 5 : 120;
    }
  }
  for (const CameraChoice& choice : choices) {
    const View view = find_view(scene, scene::evaluate(scene, scene::none, 0), choice, bounds, width, height);
    EXPECT_NEAR(glm::dot(view.right, view.up), 0, 1e-5f);
    EXPECT_NEAR(glm::dot(view.right, view.forward), 0, 1e-5f);
    EXPECT_NEAR(glm::dot(view.up, view.forward), 0, 1e-5f);
    EXPECT_LT(glm::dot(glm::cross(view.right, view.up), view.forward), 0) << "left and right are swapped";
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 p(corner & 1 ? 5 : -3, corner & 2 ? 11 : 10, corner & 4 ? 90 : 2);
      const glm::vec3 d = p - view.origin;
      const float along = glm::dot(d, view.forward);
      EXPECT_GT(along, 0) << corner;
      EXPECT_LE(std::abs(glm::dot(d, view.right)) / glm::dot(view.right, view.right), along) << corner;
      EXPECT_LE(std::abs(glm::dot(d, view.up)) / glm::dot(view.up, view.up), along) << corner;
    }
  }
}

View view_by(const CameraChoice& choice, const scene::Scene& scene = {}) {
  scene::Bounds bounds;
  bounds.include(glm::vec3(-1));
  bounds.include(glm::vec3(3));
  return find_view(scene, scene::evaluate(scene, scene::none, 0), choice, bounds, width, height);
}

TEST(View, OrbitsRoundTheMiddle) {
  const auto side = [](float azimuth, float elevation) {
    CameraChoice choice;
    choice.orbit = glm::vec2(azimuth, elevation);
    return glm::normalize(view_by(choice).origin - glm::vec3(1));
  };
  const auto expect_side = [](const glm::vec3& found, const glm::vec3& expected) {
    EXPECT_LT(glm::length(found - expected), 1e-5f) << found.x << " " << found.y << " " << found.z;
  };
  expect_side(side(0, 0), {0, 0, 1});
  expect_side(side(90, 0), {1, 0, 0});
  expect_side(side(180, 0), {0, 0, -1});
  expect_side(side(0, 90), {0, 1, 0});
  expect_side(side(0, -90), {0, -1, 0});
}

TEST(View, StandsWhereItIsPutAndLooksWhereItIsTold) {
  CameraChoice choice;
  choice.from = glm::vec3(5, 1, 1);
  choice.field_of_view = 90;
  View view = view_by(choice);
  expect_near(view.origin, {5, 1, 1});
  expect_near(view.forward, {-1, 0, 0});  // to the middle of the bounds
  expect_near(view.up, {0, 1, 0});
  expect_near(view.right, {0, 0, -float(width) / float(height)});
  choice.at = glm::vec3(5, 9, 1);  // straight up
  view = view_by(choice);
  expect_near(view.forward, {0, 1, 0});
  EXPECT_NEAR(glm::length(view.up), 1, 1e-6f);

  // A scene's own camera keeps its place, or its angle.
  scene::Camera camera;
  camera.yfov = 1;
  scene::Node node;
  node.translation = {1, 2, 7};
  CameraChoice turned;
  turned.at = glm::vec3(1, 2, 9);
  view = view_by(turned, scene_with_camera(camera, node));
  expect_near(view.origin, {1, 2, 7});
  expect_near(view.forward, {0, 0, 1});
  EXPECT_NEAR(glm::length(view.up), std::tan(0.5f), 1e-6f);
}

void expect_refused(const CameraChoice& choice, const scene::Scene& scene, const std::string& option,
                    const std::string& said) {
  try {
    view_by(choice, scene);
    ADD_FAILURE() << option << " is taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find(option), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
  }
}

TEST(View, RefusesChoicesThatContradictEachOther) {
  CameraChoice both;
  both.orbit = glm::vec2(10, 10);
  both.from = glm::vec3(1, 2, 3);
  expect_refused(both, {}, "--orbit", "--camera-from");
  CameraChoice named;
  named.orbit = glm::vec2(10, 10);
  named.name = "0";
  expect_refused(named, {}, "--orbit", "the other --camera");
  CameraChoice nowhere;
  nowhere.from = nowhere.at = glm::vec3(4);
  expect_refused(nowhere, {}, "--camera-at", "two places");
  CameraChoice wide;
  wide.field_of_view = 50;
  scene::Camera camera;
  camera.perspective = false;
  expect_refused(wide, scene_with_camera(camera), "--fov", "orthographic");
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
