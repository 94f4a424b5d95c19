// SPDX-License-Identifier: MIT
// What each integrator must show, in scenes whose light can be worked out by hand; on every device.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "lodestone/base/error.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/environments.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/picture.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

using geometry_image::AtlasKind;
using render::Integrator;

render::Settings settings_of(Integrator integrator, uint32_t size, uint32_t spp) {
  render::Settings settings;
  settings.integrator = integrator;
  settings.width = settings.height = size;
  settings.spp = spp;
  return settings;
}

// Reflects `albedo` of all light, in all directions alike.
scene::Material chalk(const glm::vec3& albedo) {
  scene::Material material;
  material.base_color = glm::vec4(albedo, 1);
  material.metallic = 0;
  material.specular = 0;
  return material;
}

scene::Material mirror() {
  scene::Material material;
  material.roughness = 0;
  return material;
}

scene::Material glass() {
  scene::Material material;
  material.metallic = 0;
  material.roughness = 0;
  material.transmission = 1;
  return material;
}

scene::Scene without_light(scene::Scene scene) {
  scene.sky = scene::Sky{};
  return scene;
}

// A lamp that shines along -z turned by `angle` about y.
void add_sun(scene::Scene& scene, float intensity, float angle) {
  scene::Light light;
  light.kind = scene::Light::Kind::directional;
  light.intensity = intensity;
  scene.lights.push_back(light);
  scene::Node node;
  node.light = static_cast<uint32_t>(scene.lights.size() - 1);
  node.rotation = glm::angleAxis(angle, glm::vec3(0, 1, 0));
  scene.nodes.push_back(node);
}

class Integrators : public testing::TestWithParam<std::string> {
 protected:
  image::Image render(const scene::Scene& scene, const render::Settings& settings) const {
    return picture(*backend_, ReadyScene(scene, AtlasKind::exact), 0, settings);
  }
  const std::unique_ptr<render::Backend> backend_ = open(GetParam(), {.validate = GetParam() != "cpu"});
};

double mean(const image::Image& image, const char* channel) {
  double sum = 0, weight = 0;
  for (size_t i = 0; i < image.pixels(); ++i) {
    const bool covered = image.find("A")->values[i] == 1;
    sum += covered ? double(image.find(channel)->values[i]) : 0;
    weight += covered ? 1 : 0;
  }
  EXPECT_GT(weight, 50);
  return sum / weight;
}

scene::Scene sphere_of(const scene::Material& material) {
  scene::Scene scene = grid_sphere(24);
  scene.materials = {material};
  for (scene::Part& part : scene.meshes[0].parts) part.material = 0;
  return scene;
}

// A body that reflects a share of all light looks the same from everywhere in a world that is evenly bright,
// whatever it meets on the way: each bounce off it takes that share once more.
TEST_P(Integrators, PathsInAFurnaceKeepTheLight) {
  for (const bool map : {false, true}) {
    scene::Scene white = sphere_of(chalk({1, 1, 1})), metal = sphere_of(mirror()), clear = sphere_of(glass());
    clear.materials[0].thickness = 1;
    for (scene::Scene* scene : {&white, &metal, &clear}) {
      if (map) {
        scene->environment = even_environment(8, 4, {0.5f, 0.5f, 0.5f});
        scene->sky.reset();
      } else {
        scene->sky = scene::Sky{glm::vec3(0.5f), glm::vec3(0.5f), glm::vec3(0.5f)};
      }
      render::Settings settings = settings_of(Integrator::path, 24, 64);
      settings.max_bounces = 64;
      EXPECT_NEAR(mean(render(*scene, settings), "G"), 0.5, 0.01) << "map " << map;
    }
  }
}

TEST_P(Integrators, PathsAndTheEyeAgreeOnDirectLight) {
  scene::Scene scene = without_light(facing_camera({square(0, 0)}, {chalk({0.8f, 0.4f, 0.2f})}));
  add_sun(scene, 2, 0.7f);
  render::Settings settings = settings_of(Integrator::path, 16, 2);
  settings.max_bounces = 0;
  const image::Image path = render(scene, settings);
  settings.integrator = Integrator::eye;
  const image::Image eye = render(scene, settings);
  const float expected = 2 * std::cos(0.7f) * 0.8f / float(M_PI);
  EXPECT_NEAR(value(path, "R", 8, 8), expected, 1e-5f);
  EXPECT_NEAR(value(eye, "R", 8, 8), expected, 1e-5f);
}

// Two walls that face each other, one of them lit: the other sees it.
TEST_P(Integrators, PathsCarryLightFromSurfaceToSurface) {
  scene::Mesh lit = square(0, 0), dark = square(0.8f, 1);
  for (glm::vec3& p : dark.positions) p.x += 2.2f;  // beside what the camera sees of the first
  scene::Scene scene = without_light(facing_camera({lit, dark}, {chalk({1, 1, 1}), chalk({1, 0, 0})}));
  scene.materials[1].emissive = {0, 0, 4};
  const image::Image image = render(scene, settings_of(Integrator::path, 16, 256));
  EXPECT_GT(value(image, "B", 12, 8), 0.01f);
  EXPECT_EQ(value(image, "R", 12, 8), 0);
  // It shines on the first itself, and reflects nothing of its colour.
  render::Settings none = settings_of(Integrator::path, 16, 256);
  none.max_bounces = 0;
  EXPECT_NEAR(value(render(scene, none), "B", 12, 8), value(image, "B", 12, 8), 0.03f);
}

// A mirror in front of the camera at half a right angle shows the wall at its side.
TEST_P(Integrators, MirrorsShowWhatIsBesideThem) {
  scene::Scene scene = facing_camera({square(0, 0), square(-4, 1)}, {mirror(), chalk({0, 0, 0})});
  scene.materials[1].emissive = {0.25f, 0.5f, 0.75f};
  scene.nodes[0].rotation = glm::angleAxis(float(M_PI) / 4, glm::vec3(0, 1, 0));
  scene.nodes[1].rotation = glm::angleAxis(-float(M_PI) / 2, glm::vec3(0, 1, 0));
  scene.nodes[1].scale = {3, 3, 1};
  scene = without_light(scene);
  for (const auto integrator : {Integrator::specular, Integrator::glossy, Integrator::path}) {
    const image::Image image = render(scene, settings_of(integrator, 16, 4));
    EXPECT_NEAR(value(image, "G", 8, 8), 0.5f, 1e-3f) << render::to_string(integrator);
    EXPECT_NEAR(value(image, "B", 8, 8), 0.75f, 1e-3f) << render::to_string(integrator);
  }
  render::Settings none = settings_of(Integrator::specular, 16, 1);
  none.max_bounces = 0;
  EXPECT_EQ(value(render(scene, none), "G", 8, 8), 0);
}

// Both sides of a pane reflect some four percent; a pane without thickness here has one.
TEST_P(Integrators, PanesShowWhatIsBehindThem) {
  scene::Scene scene =
      without_light(facing_camera({square(0.5f, 0), square(-0.5f, 1)}, {glass(), chalk({0, 0, 0})}));
  scene.materials[0].base_color = {1, 0.5f, 0.25f, 1};
  scene.materials[1].emissive = {1, 1, 1};
  for (const auto integrator : {Integrator::specular, Integrator::glossy, Integrator::path}) {
    const image::Image image = render(scene, settings_of(integrator, 16, 64));
    EXPECT_NEAR(value(image, "R", 8, 8), 0.96f, 0.02f) << render::to_string(integrator);
    EXPECT_NEAR(value(image, "G", 8, 8), 0.48f, 0.01f) << render::to_string(integrator);
  }
}

// Through the sphere, whose light is absorbed by the length of the way.
TEST_P(Integrators, SolidsAbsorbLight) {
  scene::Scene scene = sphere_of(glass());
  scene.materials[0].thickness = 1;
  scene.materials[0].attenuation_distance = 1;
  scene.materials[0].attenuation_color = {1, 0.5f, 0.25f};
  scene.sky = scene::Sky{glm::vec3(1), glm::vec3(1), glm::vec3(1)};
  for (const auto integrator : {Integrator::specular, Integrator::path}) {
    render::Settings settings = settings_of(integrator, 17, 64);
    settings.max_bounces = 12;
    const image::Image image = render(scene, settings);
    const float green = value(image, "G", 8, 8);
    EXPECT_NEAR(value(image, "R", 8, 8), 1, 0.02f) << render::to_string(integrator);
    // A diameter of about 2, bumps apart; what is reflected outside is not dimmed.
    EXPECT_NEAR(green, 0.25f, 0.12f) << render::to_string(integrator);
    EXPECT_LT(value(image, "B", 8, 8), green) << render::to_string(integrator);
  }
}

TEST_P(Integrators, AmbientOcclusionIsHalfInACorner) {
  scene::Mesh floor = square(0, 0), wall = square(0, 0);
  scene::Scene scene = facing_camera({floor, wall}, {chalk({1, 1, 1})});
  scene.nodes[1].rotation = glm::angleAxis(-float(M_PI) / 2, glm::vec3(0, 1, 0));
  scene.nodes[1].translation = {1, 0, 1};
  scene.nodes[1].scale = {1, 40, 1};
  scene.nodes[0].scale = {1, 40, 1};
  render::Settings settings = settings_of(Integrator::ao, 48, 256);
  const image::Image image = render(scene, settings);
  EXPECT_EQ(value(image, "R", 1, 24), 1) << "where the camera sees nothing";
  EXPECT_EQ(value(image, "A", 1, 24), 0);
  // A long wall of height 2 at x = 1 takes this share of the directions, by the cosine.
  for (const uint32_t x : {9u, 24u, 32u, 39u}) {
    const float away = 2.5f - (static_cast<float>(x) + 0.5f) / 16;
    const float blocked = (1 - away / std::sqrt(away * away + 4)) / 2;
    EXPECT_NEAR(value(image, "R", x, 24), 1 - blocked, 0.03f) << x;
  }
  settings.ao_distance = 0.05f;
  EXPECT_EQ(value(render(scene, settings), "R", 24, 24), 1);
}

// How many pixels are neither covered nor empty.
uint32_t partly_covered(const image::Image& image) {
  uint32_t count = 0;
  for (const float alpha : image.find("A")->values) count += alpha > 0 && alpha < 1 ? 1 : 0;
  return count;
}

TEST_P(Integrators, LensesAreSharpAtTheirFocusAlone) {
  scene::Mesh small = square(0, 0);
  for (glm::vec3& p : small.positions) p = {p.x * 0.53f, p.y * 0.53f, p.z};
  const scene::Scene scene = facing_camera({small}, {chalk({1, 1, 1})});
  render::Settings settings = settings_of(Integrator::eye, 32, 16);
  const uint32_t sharp = partly_covered(render(scene, settings));
  settings.integrator = Integrator::dof;
  settings.lens_radius = 0.3f;
  EXPECT_EQ(partly_covered(render(scene, settings)), sharp) << "by itself it focuses on the square";
  settings.focus_distance = 3;
  EXPECT_EQ(partly_covered(render(scene, settings)), sharp);
  settings.focus_distance = 1.5f;
  EXPECT_GT(partly_covered(render(scene, settings)), 3 * sharp);
}

TEST_P(Integrators, RefuseMoreSplitsThanThereIsRoomFor) {
  render::Settings settings = settings_of(Integrator::specular, 16, 1);
  settings.max_bounces = render::most_specular_bounces + 1;
  EXPECT_THROW(render(facing_camera({square(0, 0)}, {mirror()}), settings), Error);
}

INSTANTIATE_TEST_SUITE_P(, Integrators, testing::ValuesIn(judged_device_names()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace lodestone::test
