// SPDX-License-Identifier: MIT
// Levels of detail: every ray sees the finest surface with its texels slid, whatever the traversal and the
// device, and that surface is closed and near enough.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/mesh/triangle_tree.h"
#include "lodestone/render/detail.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/embree_scene.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/leak_check.h"
#include "lodestone/test_support/picture.h"
#include "lodestone/test_support/rays.h"
#include "lodestone/test_support/ready_scene.h"
#include "lodestone/test_support/slid_texels.h"

namespace lodestone::test {
namespace {

using geometry_image::AtlasKind;

constexpr uint32_t side = 64;

// From `from` to the origin, 40 degrees wide.
render::View view_from(const glm::vec3& from) {
  render::View view;
  const float half = std::tan(glm::radians(20.0f));
  view.origin = from;
  view.forward = glm::normalize(-from);
  view.right = glm::normalize(glm::cross(view.forward, glm::vec3(0, 1, 0))) * half;
  view.up = glm::normalize(glm::cross(view.right, view.forward)) * half;
  return view;
}

render::Settings settings_of(float pixels_of_error, render::Traversal traversal, uint32_t budget = 4000) {
  render::Settings settings;
  settings.width = settings.height = side;
  settings.pixels_of_error = pixels_of_error;
  settings.traversal = traversal;
  settings.loop_budget = budget;
  return settings;
}

std::vector<glm::uvec4> hits_of(render::Backend& backend, const ReadyScene& ready, const render::View& view,
                                const render::Settings& settings, const Rays& rays) {
  render::Renderer renderer(backend, ready.scene, ready.assembly, ready.atlas, settings);
  renderer.update(ready.pose(0), &view);
  renderer.load_rays(rays);
  renderer.trace_loaded();
  return renderer.hits();
}

struct Case {
  const char* name;
  ReadyScene (*make)();
  glm::vec3 from;
  float pixels_of_error;
};

ReadyScene mapped_sphere() {
  geometry_image::AtlasSettings settings = AtlasKind::charts;
  settings.charts.texel_budget = 16384;
  return ReadyScene(grid_sphere(96), settings);
}

const Case cases[] = {
    {"BumpySphereNear", [] { return ReadyScene(grid_sphere(96)); }, {0.4f, 0.3f, 1.6f}, 2},
    {"BumpySphereFar", [] { return ReadyScene(grid_sphere(96)); }, {3, 4, 20}, 1},
    {"OddSphere", [] { return ReadyScene(grid_sphere(75)); }, {0.9f, 0.7f, 1}, 8},
    {"MappedSphere", mapped_sphere, {0.4f, 0.3f, 2}, 4},
    {"Spheres", [] { return ReadyScene("builtin:spheres"); }, {0.5f, 2, 6}, 3},
    {"Terrain", [] { return ReadyScene("builtin:terrain"); }, {0.5f, 3, 6}, 4},
};

class Details : public testing::TestWithParam<Case> {
 protected:
  const ReadyScene ready_ = GetParam().make();
  const render::View view_ = view_from(GetParam().from);
  const std::vector<glm::vec3> texels_ = ready_.texels(ready_.pose(0));
  const layout::RayCone camera_ = render::camera_cone(view_, side, side, GetParam().pixels_of_error);

  Rays rays(uint32_t count) const {
    glm::vec3 lo(1e30f), hi(-1e30f);
    for (const glm::uvec3& t : quad_triangles(ready_.atlas).texels) {
      lo = glm::min(lo, texels_[t.x]);
      hi = glm::max(hi, texels_[t.x]);
    }
    Rays all = random_rays(lo, hi, count, 5);
    const Rays primary = primary_rays(view_, side);
    all.insert(all.end(), primary.begin(), primary.end());
    return all;
  }
};

TEST_P(Details, ShowTheFinestSurfaceWithItsTexelsSlid) {
  const std::vector<glm::vec3> slid = slid_texels(ready_, texels_, camera_);
  uint64_t moved = 0;
  for (size_t i = 0; i < slid.size(); ++i) moved += slid[i] != texels_[i] ? 1 : 0;
  EXPECT_GT(moved, slid.size() / 20);
  const QuadTriangles quads = quad_triangles(ready_.atlas);
  const Rays all = rays(200000);
  const EmbreeScene embree(slid, quads.texels, true);
  std::vector<EmbreeHit> expected;
  embree.intersect(all, expected);
  const auto backend = open("cpu");
  const auto hits = hits_of(*backend, ready_, view_,
                            settings_of(GetParam().pixels_of_error, render::Traversal::octant), all);
  uint64_t wrong = 0, coarse = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const bool hit = hits[i].w != layout::no_index;
    coarse += hit && layout::primitive_level(hits[i].w) > 0 ? 1 : 0;
    const float t = std::bit_cast<float>(hits[i].x);
    wrong += hit != (expected[i].triangle != ~0u) || (hit && std::abs(t - expected[i].t) > 3e-5f) ? 1 : 0;
  }
  EXPECT_GT(coarse, hits.size() / 100);
  EXPECT_LE(wrong, hits.size() / 50000);
}

TEST_P(Details, AreTheSameForAllTraversalsAndDevices) {
  const Rays all = rays(20000);
  const auto cpu = open("cpu");
  const float error = GetParam().pixels_of_error;
  using render::Traversal;
  const auto expected = hits_of(*cpu, ready_, view_, settings_of(error, Traversal::threaded), all);
  EXPECT_EQ(hits_of(*cpu, ready_, view_, settings_of(error, Traversal::octant), all), expected);
  EXPECT_EQ(hits_of(*cpu, ready_, view_, settings_of(error, Traversal::octant, 7), all), expected);
  for (const std::string& name : vulkan_device_names()) {
    // SwiftShader takes seconds for every kernel: the two kinds of chart are enough.
    const std::string scene = GetParam().name;
    if (name == "SwiftShader" && scene != "OddSphere" && scene != "MappedSphere") continue;
    const auto device = open(name, {.validate = true});
    for (const Traversal traversal : {Traversal::threaded, Traversal::octant, Traversal::wide})
      EXPECT_EQ(hits_of(*device, ready_, view_, settings_of(error, traversal), all), expected)
          << name << " " << to_string(traversal);
    EXPECT_EQ(hits_of(*device, ready_, view_, settings_of(error, Traversal::wide, 20), all), expected);
  }
}

// No point of the finest surface is farther from what a ray sees than the ray tolerates there.
TEST_P(Details, AreAsNearAsIsAskedFor) {
  const std::vector<glm::vec3> slid = slid_texels(ready_, texels_, camera_);
  const std::vector<glm::uvec3> triangles = quad_triangles(ready_.atlas).texels;
  const mesh::TriangleTree tree({slid, triangles});
  const layout::Tolerance tolerance{camera_, layout::no_cone()};
  for (const glm::uvec3& t : triangles) {
    const glm::vec3 middle = (texels_[t.x] + texels_[t.y] + texels_[t.z]) / 3.0f;
    for (const glm::vec3& point : {texels_[t.x], middle})
      ASSERT_LE(tree.nearest(point).distance, layout::tolerance_at(tolerance, point) * 1.01 + 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(, Details, testing::ValuesIn(cases),
                         [](const auto& each) { return each.param.name; });

// From within a closed surface, aimed at the corners and edges that rays see.
LeakReport leaks(const ReadyScene& ready, const render::View& view, float pixels_of_error,
                 const std::string& device, uint64_t rays) {
  const auto texels = ready.texels(ready.pose(0));
  const layout::RayCone camera = render::camera_cone(view, side, side, pixels_of_error);
  const std::vector<glm::vec3> slid = slid_texels(ready, texels, camera);
  const QuadTriangles quads = quad_triangles(ready.atlas);
  const auto origins = points_inside(slid, quads, 8, 3);
  EXPECT_EQ(origins.size(), 8u);
  const auto backend = open(device);
  render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas,
                            settings_of(pixels_of_error, render::Traversal::automatic));
  renderer.update(ready.pose(0), &view);
  if (device != "cpu") rays /= 8;  // software devices take their time
  return check_leaks(renderer, slid, quads, origins, rays, 11);
}

class DetailLeaks : public testing::TestWithParam<std::string> {};

TEST_P(DetailLeaks, NoneFromABumpySphere) {
  const ReadyScene ready(grid_sphere(96));
  EXPECT_EQ(leaks(ready, view_from({0.5f, 0.4f, 1.3f}), 4, GetParam(), 800000).leaks, 0u);
  EXPECT_EQ(leaks(ready, view_from({2, 1, 6}), 4, GetParam(), 400000).leaks, 0u);
}

TEST_P(DetailLeaks, NoneFromAMappedSphere) {
  EXPECT_EQ(leaks(mapped_sphere(), view_from({0.5f, 0.4f, 1.6f}), 6, GetParam(), 400000).leaks, 0u);
}

TEST_P(DetailLeaks, NoneFromTheArmadillo) {
  const auto file = data_file("armadillo.obj");
  if (!file) GTEST_SKIP() << "shared data are absent";
  const ReadyScene ready(*file, AtlasKind::charts);
  EXPECT_EQ(leaks(ready, view_from({20, 40, 150}), 4, GetParam(), 400000).leaks, 0u);
}

INSTANTIATE_TEST_SUITE_P(, DetailLeaks, testing::ValuesIn(judged_device_names()),
                         [](const auto& each) { return each.param; });

// The sphere's last column is no longer the same point as its first in every pose, so texels there collapse
// by themselves: a crack, where errors differ on both sides.
TEST(DetailLeakCheck, FindsACrackPutInOnPurpose) {
  scene::Scene scene = grid_sphere(96);
  scene::Mesh& mesh = scene.meshes[0];
  const uint32_t width = mesh.grids[0].width;
  for (uint32_t y = 1; y + 1 < mesh.grids[0].height; ++y) {
    const uint32_t vertex = mesh.grids[0].vertices[size_t(y) * width];
    const auto copy = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back(mesh.positions[vertex]);
    mesh.normals.push_back(mesh.normals[vertex]);
    mesh.grids[0].vertices[size_t(y) * width + width - 1] = copy;
  }
  mesh.triangles.clear();
  const auto& v = mesh.grids[0].vertices;
  for (uint32_t y = 0; y + 1 < mesh.grids[0].height; ++y) {
    for (uint32_t x = 0; x + 1 < width; ++x) {
      const size_t a = size_t(y) * width + x;
      mesh.triangles.emplace_back(v[a], v[a + 1], v[a + width]);
      mesh.triangles.emplace_back(v[a + width + 1], v[a + width], v[a + 1]);
    }
  }
  scene::MorphTarget target;
  target.name = "apart";
  for (uint32_t y = 1; y + 1 < mesh.grids[0].height; ++y) {
    target.vertices.push_back(v[size_t(y) * width + width - 1]);
    target.positions.emplace_back(0, 0.5f, 0);
  }
  mesh.targets = {target};
  mesh.weights = {0};
  const ReadyScene ready(std::move(scene));
  const render::View view = view_from({1.3f, 0.4f, 0.5f});
  EXPECT_EQ(leaks(ready, view, 0, "cpu", 100000).leaks, 0u);
  EXPECT_GT(leaks(ready, view, 6, "cpu", 1000000).leaks, 0u);
}

// Pictures.

image::Image image_of(render::Backend& backend, const ReadyScene& ready, const render::View& view,
                      const render::Settings& settings) {
  render::Renderer renderer(backend, ready.scene, ready.assembly, ready.atlas, settings);
  return renderer.render(ready.pose(0), view)->linear;
}

TEST(DetailPictures, AreThoseOfFullResolutionWhereNothingIsTolerated) {
  const auto backend = open("cpu");
  const render::View view = view_from({0.4f, 0.6f, 4});
  for (const ReadyScene& ready : {ReadyScene(grid_sphere(48)), mapped_sphere()}) {
    render::Settings settings = settings_of(0, render::Traversal::octant);
    settings.aovs = {"depth", "normal", "uv", "id", "lod"};
    const image::Image fine = image_of(*backend, ready, view, settings);
    settings.pixels_of_error = 1e-9f;
    const image::Image image = image_of(*backend, ready, view, settings);
    ASSERT_EQ(image.channels.size(), fine.channels.size());
    for (size_t c = 0; c < fine.channels.size(); ++c) {
      EXPECT_EQ(image.channels[c].ids, fine.channels[c].ids) << fine.channels[c].name;
      for (size_t i = 0; i < fine.channels[c].values.size(); ++i)
        ASSERT_EQ(image.channels[c].values[i], fine.channels[c].values[i])
            << fine.channels[c].name << " " << i;
    }
  }
}

TEST(DetailPictures, AreCoarserFartherAway) {
  const auto backend = open("cpu");
  const ReadyScene ready("builtin:terrain");
  render::Settings settings = settings_of(1, render::Traversal::octant);
  settings.aovs = {"lod"};
  double before = -1;
  for (const float distance : {4.0f, 16.0f, 64.0f}) {
    const image::Image image = image_of(*backend, ready, view_from({0, distance / 2, distance}), settings);
    double sum = 0;
    uint32_t hits = 0;
    for (uint32_t i = 0; i < side * side; ++i) {
      if (value(image, "A", i % side, i / side) == 0) continue;
      sum += value(image, "lod.L", i % side, i / side);
      ++hits;
    }
    ASSERT_GT(hits, 20u);
    EXPECT_GT(sum / hits, before + 0.5) << distance;
    before = sum / hits;
  }
}

// In a slow zoom the picture changes hardly more from frame to frame than at full resolution.
TEST(DetailPictures, DoNotPop) {
  const auto backend = open("cpu");
  const ReadyScene ready("builtin:terrain");
  const auto changes = [&](float pixels_of_error) {
    render::Settings settings = settings_of(pixels_of_error, render::Traversal::octant);
    settings.spp = 16;
    std::vector<float> all;
    image::Image before;
    for (uint32_t frame = 0; frame < 12; ++frame) {
      const float distance = 14 * std::pow(1.01f, float(frame));
      image::Image image = image_of(*backend, ready, view_from({0, distance / 2, distance}), settings);
      for (uint32_t i = 0; frame > 0 && i < side * side; ++i)
        all.push_back(
            std::abs(value(image, "G", i % side, i / side) - value(before, "G", i % side, i / side)));
      before = std::move(image);
    }
    std::sort(all.begin(), all.end());
    return all[all.size() * 999 / 1000];
  };
  EXPECT_LE(changes(1), 1.5f * changes(0));
}

// A lamp in a closed body: a ray that started below the surface that it sees would find it. All other light
// is no brighter than the world around.
TEST(DetailPictures, ShowNoRayThatStartsBelowItsSurface) {
  const auto backend = open("cpu");
  uint32_t coarse = 0;
  for (const float roughness : {0.0f, 0.3f, 1.0f}) {
    scene::Scene scene = grid_sphere(96);
    scene::Material body, lamp;
    body.roughness = roughness;
    lamp.emissive = glm::vec3(10000);
    scene.materials = {body, lamp};
    scene.meshes.push_back(scene.meshes[0]);
    for (uint32_t m = 0; m < 2; ++m)
      for (scene::Part& part : scene.meshes[m].parts) part.material = m;
    scene.nodes.push_back(scene.nodes[0]);
    scene.nodes[1].mesh = 1;
    scene.nodes[1].scale = glm::vec3(0.6f);
    scene.sky = scene::Sky{glm::vec3(0.5f), glm::vec3(0.5f), glm::vec3(0.5f)};
    const ReadyScene ready(std::move(scene));
    for (const auto integrator :
         {render::Integrator::specular, render::Integrator::glossy, render::Integrator::path}) {
      for (const float distance : {1.5f, 8.0f}) {
        render::Settings settings = settings_of(6, render::Traversal::octant);
        settings.integrator = integrator;
        settings.max_bounces = 64;
        settings.spp = 16;
        settings.aovs = {"lod"};
        const glm::vec3 from = glm::normalize(glm::vec3(0.5f, 0.4f, 1)) * distance;
        const image::Image image = image_of(*backend, ready, view_from(from), settings);
        for (uint32_t i = 0; i < side * side; ++i) {
          coarse += value(image, "lod.L", i % side, i / side) > 0.5f ? 1 : 0;
          ASSERT_LE(value(image, "G", i % side, i / side), 10.0f)
              << to_string(integrator) << " " << i % side << " " << i / side;
        }
      }
    }
  }
  EXPECT_GT(coarse, 1000u);
}

class DetailParity : public testing::TestWithParam<std::string> {};

TEST_P(DetailParity, OfEveryPass) {
  const auto device = open(GetParam(), {.validate = true}), cpu = open("cpu");
  render::ParityBackend both(*device, *cpu);
  const render::View view = view_from({0.4f, 0.6f, 6});
  for (const auto integrator : {render::Integrator::eye, render::Integrator::ao, render::Integrator::specular,
                                render::Integrator::path}) {
    const ReadyScene ready("builtin:spheres",
                           integrator == render::Integrator::path ? AtlasKind::charts : AtlasKind::automatic);
    render::Settings settings = settings_of(3, render::Traversal::automatic);
    settings.width = settings.height = 24;
    settings.integrator = integrator;
    settings.max_bounces = 3;
    settings.spp = 2;
    settings.aovs = {"depth", "normal", "uv", "id", "lod"};
    image_of(both, ready, view, settings);
  }
  EXPECT_FALSE(both.differences().empty());
  for (const render::PassDifference& difference : both.differences())
    EXPECT_EQ(difference.different, 0u) << difference.pass << " " << difference.buffer;
}

INSTANTIATE_TEST_SUITE_P(, DetailParity, testing::ValuesIn(vulkan_device_names()),
                         [](const auto& each) { return each.param; });

TEST(DetailRefusals, SayWhatToDo) {
  const auto backend = open("cpu");
  const ReadyScene ready("builtin:spheres");
  render::Settings settings = settings_of(1, render::Traversal::automatic);
  settings.shutter_segments = 1;
  try {
    render::Renderer renderer(*backend, ready.scene, ready.assembly, ready.atlas, settings);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--shutter"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace lodestone::test
