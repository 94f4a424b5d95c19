// SPDX-License-Identifier: MIT
// What a picture must show, in scenes small enough to know it beforehand; on every device, with a chart a
// triangle and with resampled ones.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <tuple>

#include "lodestone/base/error.h"
#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/environments.h"
#include "lodestone/test_support/mapped_charts.h"
#include "lodestone/test_support/picture.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/small_scenes.h"

namespace lodestone::test {
namespace {

render::Settings settings_of(uint32_t size) {
  render::Settings settings;
  settings.width = settings.height = size;
  settings.aovs = {"depth", "normal", "albedo", "uv", "id"};
  return settings;
}

scene::Material colored(const glm::vec3& color, float alpha = 1, bool mask = false) {
  scene::Material material;
  material.base_color = glm::vec4(color, alpha);
  material.metallic = 0;
  material.alpha_mask = mask;
  return material;
}

using geometry_image::AtlasKind;

class Pictures : public testing::TestWithParam<std::tuple<std::string, AtlasKind>> {
 protected:
  image::Image render(const scene::Scene& scene, uint32_t size = 16,
                      render::Traversal traversal = render::Traversal::automatic) const {
    render::Settings settings = settings_of(size);
    settings.traversal = traversal;
    return picture(*backend_, ReadyScene(scene, std::get<1>(GetParam())), 0, settings);
  }
  // Of what is the same everywhere: a hit on a resampled surface adds what three triangles say.
  static float rounding() { return std::get<1>(GetParam()) == AtlasKind::exact ? 0 : 1e-6f; }
  static std::unique_ptr<render::Backend> opened() {
    const std::string& device = std::get<0>(GetParam());
    return open(device, {.validate = device != "cpu"});
  }
  const std::unique_ptr<render::Backend> backend_ = opened();
};

const glm::vec3 red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1);

// Whichever comes first in the file, and whether its triangles are the other's own or not.
TEST_P(Pictures, ShowWhatLiesInThePlaneOfACutOutSurface) {
  const std::vector<scene::Material> materials = {colored(red, 0, true), colored(green)};
  for (const uint32_t first : {0u, 1u}) {
    for (const bool same_diagonal : {true, false}) {
      scene::Mesh a = square(0, first), b = square(0, 1 - first);
      if (!same_diagonal) b.triangles = {{2, 3, 0}, {1, 0, 3}};
      for (const auto traversal : {render::Traversal::octant, render::Traversal::threaded}) {
        const image::Image image = render(facing_camera({a, b}, materials), 16, traversal);
        for (uint32_t y = 3; y < 13; ++y) {
          for (uint32_t x = 3; x < 13; ++x) {
            EXPECT_EQ(value(image, "A", x, y), 1) << x << " " << y;
            EXPECT_NEAR(value(image, "albedo.G", x, y), 1, rounding()) << x << " " << y;
          }
        }
      }
    }
  }
}

TEST_P(Pictures, GoThroughManyCutOutLayers) {
  std::vector<scene::Mesh> layers;
  for (int i = 0; i < 40; ++i) layers.push_back(square(1 - 0.01f * static_cast<float>(i), 0));
  layers.push_back(square(-0.5f, 1));
  const image::Image image = render(facing_camera(layers, {colored(red, 0, true), colored(blue)}));
  EXPECT_NEAR(value(image, "albedo.B", 8, 8), 1, rounding());
  // Exact to the last bit where texels are vertices; samples at thirds of a side are rounded.
  EXPECT_NEAR(value(image, "depth.Z", 8, 8), 3.5f, 3.5f * rounding());
}

// Green of a normal map points against v, which runs down: a bump lit from above is light at its upper side.
scene::Scene normal_mapped(bool tangents, const glm::vec3& scale) {
  scene::Material material = colored({1, 1, 1});
  material.normal_texture.image = 0;
  scene::Mesh mesh = square(0, 0);
  if (tangents) mesh.tangents.assign(4, {1, 0, 0, 1});
  scene::Scene scene = facing_camera({mesh}, {material});
  scene::Image up;
  up.width = up.height = 1;
  up.rgba = {128, 218, 218, 255};
  scene.images = {up};
  scene.nodes[0].scale = scale;
  return scene;
}

TEST_P(Pictures, LightNormalMapsTheRightWayUpWithTangentsAndWithout) {
  for (const bool tangents : {true, false}) {
    for (const glm::vec3& scale : {glm::vec3(1, 1, 1), glm::vec3(-1, 1, 1)}) {
      const image::Image image = render(normal_mapped(tangents, scale));
      EXPECT_NEAR(value(image, "normal.Y", 8, 8), 0.707f, 0.01f) << tangents << " " << scale.x;
      EXPECT_NEAR(value(image, "normal.X", 8, 8), 0, 0.01f);
    }
  }
  const image::Image flipped = render(normal_mapped(true, {1, -1, 1}));
  EXPECT_NEAR(value(flipped, "normal.Y", 8, 8), -0.707f, 0.01f);
}

// A diffuse square that faces an even map from everywhere sends its albedo back, whatever of it is the mirror
// part; behind it there is the map itself.
TEST_P(Pictures, SeeAnEnvironmentAsTheySeeASkyOfItsRadiance) {
  scene::Scene scene = facing_camera({square(0, 0)}, {colored({0.5f, 0.25f, 1})});
  const image::Image white_sky = render(scene);
  scene.environment = even_environment(8, 4, {2, 2, 2});
  scene.environment->strength = 0.5f;
  const image::Image map = render(scene);
  EXPECT_NEAR(value(map, "R", 0, 0), 1, 1e-6f);
  EXPECT_EQ(value(map, "A", 0, 0), 0);
  for (const char* channel : {"R", "G", "B"}) {
    double sky_mean = 0, map_mean = 0;
    int texels = 0;
    for (uint32_t y = 3; y < 13; ++y) {
      for (uint32_t x = 3; x < 13; ++x, ++texels) {
        sky_mean += double(value(white_sky, channel, x, y));
        map_mean += double(value(map, channel, x, y));
      }
    }
    // Weights are from 0 to 2 with a deviation of 0.7.
    EXPECT_NEAR(map_mean / sky_mean, 1, 3 * 0.7 / std::sqrt(texels)) << channel;
  }
}

// The camera looks along -Z, with +X to its right.
TEST_P(Pictures, HaveTheEnvironmentBehindThemTheRightWayRound) {
  scene::Scene scene = facing_camera({square(0, 0)}, {colored({1, 1, 1})});
  scene.cameras[0].perspective = true;
  scene.cameras[0].yfov = 2.4f;
  scene.environment = even_environment(256, 128, {0, 0, 0});
  for (uint32_t y = 0; y < 128; ++y) {
    for (uint32_t x = 0; x < 256; ++x)
      scene.environment->radiance[y * 256 + x] = {x < 64 ? 0 : 1, y < 64 ? 1 : 0, 0};  // -Z is at x = 64
  }
  const image::Image image = render(scene);
  EXPECT_NEAR(value(image, "R", 15, 2), 1, 1e-6f);
  EXPECT_NEAR(value(image, "R", 0, 2), 0, 1e-6f);
  EXPECT_NEAR(value(image, "G", 2, 0), 1, 1e-6f);
  EXPECT_NEAR(value(image, "G", 2, 15), 0, 1e-6f);
}

// A small square over a large one, lit straight from the front, far from the origin.
scene::Scene square_over_square(float far) {
  scene::Mesh above = square(0.25f, 0);
  for (glm::vec3& p : above.positions) p = {p.x * 0.5f, p.y * 0.5f, p.z};
  scene::Scene scene = facing_camera({square(0, 0), above}, {colored({1, 1, 1})});
  scene.sky.reset();
  scene::Light light;
  light.kind = scene::Light::Kind::directional;
  scene.lights = {light};
  scene::Node sun;
  sun.light = 0;
  sun.rotation = glm::angleAxis(0.7f, glm::vec3(0, 1, 0));
  scene.nodes.push_back(sun);
  for (scene::Node& node : scene.nodes) node.translation.x += far;
  return scene;
}

TEST_P(Pictures, HaveTheSameShadowsFarFromTheOrigin) {
  const image::Image near = render(square_over_square(0), 96), far = render(square_over_square(4096), 96);
  uint32_t dark = 0, different = 0;
  for (size_t i = 0; i < near.pixels(); ++i) {
    const bool lit = near.find("R")->values[i] > 0;
    if (near.find("A")->values[i] > 0 && !lit) ++dark;
    if (lit != (far.find("R")->values[i] > 0)) ++different;
  }
  EXPECT_GT(dark, 60u) << "there is no shadow to compare";
  EXPECT_LT(different, dark / 10);
}

// Whatever is beside it: the left half of the picture is plain, the right half is not always.
TEST_P(Pictures, OfPlainMaterialsKeepTheirBitsBesideLayeredOnes) {
  const auto halves = [](const scene::Material& right) {
    scene::Mesh a = square(0, 0), b = square(0, 1);
    for (glm::vec3& p : a.positions) p.x = p.x * 0.5f - 0.6f;
    for (glm::vec3& p : b.positions) p.x = p.x * 0.5f + 0.6f;
    scene::Material left = colored({0.75f, 0.5f, 0.25f});
    left.roughness = 0.5f;
    left.emissive = {0.125f, 0, 0};
    scene::Scene scene = facing_camera({a, b}, {left, right});
    scene.sky = scene::Sky{{0.25f, 0.5f, 1}, {1, 1, 1}, {0.5f, 0.25f, 0.125f}};
    return scene;
  };
  scene::Material coat = colored({0.75f, 0.5f, 0.25f}), glass = coat;
  const image::Image plain = render(halves(coat));
  coat.clearcoat = 1;
  glass.transmission = 1;
  for (const scene::Material& right : {coat, glass}) {
    const image::Image image = render(halves(right));
    for (const char* channel : {"R", "G", "B"}) {
      for (uint32_t y = 0; y < 16; ++y) {
        for (uint32_t x = 0; x < 8; ++x)
          ASSERT_EQ(value(image, channel, x, y), value(plain, channel, x, y)) << channel << x << " " << y;
      }
      EXPECT_NE(value(image, channel, 11, 8), value(plain, channel, 11, 8)) << channel;
    }
    EXPECT_EQ(value(image, "normal.Z", 11, 8), value(plain, "normal.Z", 11, 8));
  }
}

TEST_P(Pictures, OfAConvexBodyHaveNoShadowOfItsOwn) {
  for (const float scale : {1e-8f, 1.0f, 1e10f}) {
    scene::Scene scene = square_over_square(0);
    scene.meshes.resize(1);
    scene.nodes.erase(scene.nodes.begin() + 1);
    for (glm::vec3& p : scene.meshes[0].positions) p *= scale;
    scene.cameras[0].xmag = scene.cameras[0].ymag = 1.5f * scale;
    scene.nodes[1].translation.z = 3 * scale;
    const image::Image image = render(scene, 32);
    uint32_t lit = 0;
    for (const float red_of : image.find("R")->values) lit += red_of > 0 ? 1 : 0;
    EXPECT_EQ(value(image, "A", 16, 16), 1) << scale;
    uint32_t covered = 0;
    for (const float alpha : image.find("A")->values) covered += alpha > 0 ? 1 : 0;
    EXPECT_EQ(lit, covered) << scale;
    EXPECT_GT(covered, 400u) << scale;
  }
}

TEST_P(Pictures, RefuseACameraWithoutSizeAndVerticesOutOfRange) {
  scene::Scene flat = facing_camera({square(0, 0)}, {colored(red)});
  flat.nodes.back().scale = {0, 0, 0};
  EXPECT_THROW(render(flat), Error);
  for (const float scale : {3e11f, 1e-10f}) {
    scene::Scene scene = facing_camera({square(0, 0)}, {colored(red)});
    scene.nodes[0].scale = {scale, scale, scale};
    EXPECT_THROW(render(scene), Error) << scale;
  }
  scene::Scene morphed = facing_camera({square(0, 0)}, {colored(red)});
  scene::MorphTarget target;
  target.vertices = {0};
  target.positions = {{3, 0, 0}};
  morphed.meshes[0].targets = {target};
  morphed.meshes[0].weights = {3e38f};
  EXPECT_THROW(render(morphed), Error);
}

// Of several batches, some of the pictures on the way, and the last: the bits of all samples at once.
TEST(ProgressivePictures, EndAsThoseMadeAtOnce) {
  for (const std::string& name : {std::string("cpu"), std::string("llvmpipe")}) {
    const auto backend = open(name);
    const ReadyScene ready("builtin:tiny");
    render::Settings settings;
    settings.width = 600;
    settings.height = 500;
    settings.spp = 6;
    settings.aovs = {"depth"};
    const scene::Pose pose = ready.pose(0);
    const render::View view =
        render::find_view(ready.scene, pose, "", scene::pose_bounds(ready.scene, pose), 600, 500);
    const auto made = [&](uint32_t spp) {
      settings.spp = spp;
      settings.progressive = false;
      return render::Renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings)
          .render(pose, view)
          ->linear;
    };
    const image::Image at_once = made(6);
    settings.spp = 6;
    settings.progressive = true;
    render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
    std::vector<uint32_t> seen;
    std::vector<image::Image> pictures;
    const auto result = renderer.render(pose, view, {}, {}, [&](uint32_t samples, const auto& picture) {
      seen.push_back(samples);
      pictures.push_back(picture().linear);
    });
    EXPECT_EQ(seen, (std::vector<uint32_t>{1, 2, 4}));
    EXPECT_EQ(result->samples, 6u);
    for (const char* channel : {"R", "G", "B", "depth.Z"}) {
      EXPECT_EQ(result->linear.find(channel)->values, at_once.find(channel)->values) << channel;
      EXPECT_NE(pictures[0].find("R")->values, pictures[2].find("R")->values);
    }
    // Stopped in the second of its two batches: what is there is whole.
    uint32_t asked = 0;
    render::Renderer stopped(*backend, ready.scene, ready.assembly, ready.atlas, settings);
    const auto rest = stopped.render(
        pose, view, [&] { return seen.size() > 4 && ++asked > 5; }, {},
        [&](uint32_t samples, const auto&) { seen.push_back(samples); });
    ASSERT_TRUE(rest);
    EXPECT_EQ(rest->samples, 2u);
    for (const float value : rest->linear.find("A")->values) ASSERT_TRUE(value >= 0 && value <= 1);
    double found = 0, wanted = 0;
    for (const float value : rest->linear.find("G")->values) found += value;
    for (const float value : at_once.find("G")->values) wanted += value;
    EXPECT_NEAR(found, wanted, 0.01 * wanted);
  }
}

INSTANTIATE_TEST_SUITE_P(, Pictures,
                         testing::Combine(testing::ValuesIn(judged_device_names()),
                                          testing::Values(AtlasKind::exact, AtlasKind::charts)),
                         [](const auto& each) {
                           const bool exact = std::get<1>(each.param) == AtlasKind::exact;
                           return std::get<0>(each.param) + (exact ? "_exact" : "_charts");
                         });

// Every pass of the CPU that is compiled once a vector width, by what comes out in the end.
TEST(VectorWidths, GiveTheSamePictures) {
  std::vector<ReadyScene> scenes = {ReadyScene("builtin:tiny"), straddled_squares()};
  if (const auto file = data_file("RobotExpressive.glb")) {
    scenes.emplace_back(*file, AtlasKind::exact);
    scenes.emplace_back(*file, AtlasKind::charts);
  }
  for (const ReadyScene& ready : scenes) {
    const auto render = [&] {
      const auto backend = cpu_fallback::make_cpu_backend({});
      return picture(*backend, ready, 0.4f, settings_of(64));
    };
    const image::Image expected = render();
    int widths = 0;
    for (int64_t rest = hwy::SupportedTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1) {
      hwy::SetSupportedTargetsForTest(rest & -rest);
      const image::Image image = render();
      ASSERT_EQ(image.channels.size(), expected.channels.size());
      for (size_t c = 0; c < image.channels.size(); ++c) {
        EXPECT_EQ(image.channels[c].values, expected.channels[c].values)
            << image.channels[c].name << " at " << hwy::TargetName(rest & -rest);
        EXPECT_EQ(image.channels[c].ids, expected.channels[c].ids);
      }
      ++widths;
    }
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_GE(widths, 2);
  }
}

}  // namespace
}  // namespace lodestone::test
