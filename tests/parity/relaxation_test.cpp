// SPDX-License-Identifier: MIT
// Relaxation sweeps: what they must leave alone, what they must gain, and that every device makes the same of
// them.
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "lodestone/base/error.h"
#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/geometry_image/fidelity.h"
#include "lodestone/test_support/bulging_sphere.h"
#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

geometry_image::AtlasSettings mapped(uint64_t texels, bool keep_maps = true) {
  geometry_image::AtlasSettings settings = geometry_image::AtlasKind::charts;
  settings.charts.texel_budget = texels;
  settings.charts.keep_maps = keep_maps;
  return settings;
}

render::Settings with_sweeps(uint32_t sweeps) {
  render::Settings settings;
  settings.width = settings.height = 16;
  settings.relaxation_sweeps = sweeps;
  return settings;
}

scene::Pose weighted(const ReadyScene& ready, float weight) {
  scene::Pose pose = ready.pose(0);
  scene::override_weights(ready.scene, {{"bulge", weight}}, pose);
  return pose;
}

std::vector<glm::uvec4> relaxed(render::Backend& backend, const ReadyScene& ready, const scene::Pose& pose,
                                uint32_t sweeps) {
  render::Renderer renderer(backend, ready.scene, ready.assembly, ready.atlas, with_sweeps(sweeps));
  renderer.update(pose);
  return renderer.texel_map();
}

class Relaxation : public testing::TestWithParam<std::string> {
 protected:
  const ReadyScene ready_{bulging_sphere(12), mapped(4000)};
};

TEST_P(Relaxation, LeavesTheRestPoseToTheBit) {
  const auto backend = open(GetParam());
  EXPECT_EQ(relaxed(*backend, ready_, ready_.pose(0), 5), ready_.atlas.texel_map);
}

TEST_P(Relaxation, LeavesAShapeThatIsOnlyTurnedAndShifted) {
  ReadyScene moved(ready_.scene, mapped(4000));
  moved.scene.animations.resize(1);
  scene::Channel turn;
  turn.node = 0;
  turn.path = scene::Channel::Path::rotation;
  turn.times = {0, 1};
  turn.values = {0, 0, 0, 1, 0.4f, 0.2f, 0.1f, 0.888819442f};
  scene::Channel shift;
  shift.node = 0;
  shift.path = scene::Channel::Path::translation;
  shift.times = {0, 1};
  shift.values = {0, 0, 0, 3, -2, 5};
  moved.scene.animations[0].channels = {turn, shift};
  const auto backend = open(GetParam());
  const scene::Pose pose = scene::evaluate(moved.scene, 0, 1);
  EXPECT_EQ(relaxed(*backend, moved, pose, 3), moved.atlas.texel_map);
}

TEST_P(Relaxation, IsTheSameOnEveryDeviceAndForAnyNumberOfThreads) {
  const auto device = open(GetParam()), cpu = open("cpu", {.threads = 1});
  for (const float weight : {1.0f, -0.4f}) {
    const scene::Pose pose = weighted(ready_, weight);
    const std::vector<glm::uvec4> there = relaxed(*device, ready_, pose, 3);
    EXPECT_EQ(there, relaxed(*cpu, ready_, pose, 3)) << weight;
    EXPECT_NE(there, ready_.atlas.texel_map) << weight;
  }
}

TEST_P(Relaxation, OfAFrameDoesNotDependOnTheFramesBefore) {
  const auto backend = open(GetParam());
  render::Renderer renderer(*backend, ready_.scene, ready_.assembly, ready_.atlas, with_sweeps(2));
  renderer.update(weighted(ready_, 1));
  renderer.update(weighted(ready_, 0.5f));
  EXPECT_EQ(renderer.texel_map(), relaxed(*backend, ready_, weighted(ready_, 0.5f), 2));
  renderer.update(ready_.pose(0));
  EXPECT_EQ(renderer.texel_map(), ready_.atlas.texel_map);
}

// Every pass of whole frames, those of relaxation among them.
TEST_P(Relaxation, HasEqualBuffersInEveryPass) {
  const auto device = open(GetParam()), cpu = open("cpu");
  render::ParityBackend parity(*device, *cpu);
  render::Settings settings = with_sweeps(2);
  settings.aovs = {"depth", "normal", "uv", "id"};
  render::Renderer renderer(parity, ready_.scene, ready_.assembly, ready_.atlas, settings);
  const scene::Pose pose = weighted(ready_, 1);
  renderer.render(pose, render::find_view(ready_.scene, pose, "0", {}, 16, 16));
  uint32_t relaxing = 0;
  for (const render::PassDifference& row : parity.differences()) {
    EXPECT_EQ(row.different, 0u) << row.pass << " " << row.buffer;
    relaxing += row.pass == "relax" ? 1 : 0;
  }
  EXPECT_EQ(relaxing, 4u) << "buffers";
}

INSTANTIATE_TEST_SUITE_P(, Relaxation, testing::ValuesIn(device_names()),
                         [](const auto& each) { return each.param; });

// The places of all texels in the rectangles of their charts, from what their entries say.
std::vector<glm::dvec2> places(const geometry_image::Atlas& atlas, const std::vector<glm::uvec4>& texels) {
  const geometry_image::ChartMaps& maps = atlas.maps;
  std::vector<glm::dvec2> at(texels.size(), glm::dvec2(-1));
  for (size_t i = 0; i < texels.size(); ++i) {
    at[i] = maps.sites[i].at;
    if (texels[i] == atlas.texel_map[i]) continue;
    const double b1 = std::bit_cast<float>(texels[i].y), b2 = std::bit_cast<float>(texels[i].z);
    double best = -1e30;
    for (const layout::MapFace& face : maps.faces) {
      if (face.triangle != texels[i].x) continue;
      glm::dvec2 p[3] = {{0, 0}, {1, 0}, {0, 1}};
      for (size_t k = 0; k < 3 && face.piece != layout::no_index; ++k)
        p[k] = maps.pieces[face.piece].corners[k];
      const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
      const glm::dvec2 e1 = p[1] - p[0], e2 = p[2] - p[0], e = glm::dvec2(b1, b2) - p[0];
      const double w1 = cross(e, e2) / cross(e1, e2), w2 = cross(e1, e) / cross(e1, e2);
      const double inside = std::min({w1, w2, 1 - w1 - w2});
      if (inside <= best) continue;
      best = inside;
      at[i] = glm::dvec2(maps.points[face.points[0]]) * (1 - w1 - w2) +
              glm::dvec2(maps.points[face.points[1]]) * w1 + glm::dvec2(maps.points[face.points[2]]) * w2;
    }
    EXPECT_GT(best, -1e-3) << "texel " << i << " is on no face of its triangle";
  }
  return at;
}

TEST(RelaxedLattice, StaysOneToOneWithItsBordersInPlaceInAnyDeformation) {
  for (const uint32_t seed : {1u, 2u, 3u}) {
    scene::Scene scene = bulging_sphere(10);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> anywhere(-1.0f, 1.0f);
    for (glm::vec3& delta : scene.meshes[0].targets[0].positions)
      delta = 3.0f * glm::vec3(anywhere(random), anywhere(random), anywhere(random));
    const ReadyScene ready(std::move(scene), mapped(3000));
    const auto backend = open("cpu");
    const std::vector<glm::uvec4> texels = relaxed(*backend, ready, weighted(ready, 1), 8);
    const std::vector<glm::dvec2> at = places(ready.atlas, texels);
    uint32_t moved = 0;
    for (const layout::ChartRecord& chart : ready.atlas.charts) {
      for (uint32_t y = 0; y < chart.height; ++y) {
        for (uint32_t x = 0; x < chart.width; ++x) {
          const uint32_t i = chart.first_texel + y * chart.width + x;
          moved += texels[i] != ready.atlas.texel_map[i] ? 1 : 0;
          EXPECT_EQ(texels[i].w, ready.atlas.texel_map[i].w);
          const bool border = x == 0 || y == 0 || x + 1 == chart.width || y + 1 == chart.height;
          if (border) {
            EXPECT_EQ(texels[i], ready.atlas.texel_map[i]) << i;
          }
          if (x + 1 == chart.width || y + 1 == chart.height) continue;
          const glm::dvec2 a = at[i], b = at[i + 1], c = at[i + chart.width], d = at[i + chart.width + 1];
          // The places are read back from rounded barycentrics.
          constexpr double rounding = 1e-2;
          const auto twice_area = [](const glm::dvec2& p, const glm::dvec2& q, const glm::dvec2& r) {
            return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
          };
          EXPECT_GT(twice_area(a, b, c), layout::relax_least_area - rounding) << i;
          EXPECT_GT(twice_area(d, c, b), layout::relax_least_area - rounding) << i;
        }
      }
    }
    EXPECT_GT(moved, 100u) << seed;
  }
}

double root_mean_square(const ReadyScene& ready, const scene::Pose& pose, uint32_t sweeps) {
  const auto backend = open("cpu");
  geometry_image::Atlas atlas = ready.atlas;
  atlas.texel_map = relaxed(*backend, ready, pose, sweeps);
  return geometry_image::measure_fidelity(ready.scene, ready.assembly, atlas, pose)->root_mean_square;
}

// As many texels, and the geometry image of the bulb is nearer to it: the more, the larger its charts are.
TEST(RelaxedLattice, IsNearerToAShapeThatIsStronglyDeformed) {
  const ReadyScene large(bulging_sphere(12), mapped(16384)), small(bulging_sphere(48), mapped(16384));
  EXPECT_LT(root_mean_square(large, weighted(large, 1), 4),
            0.75 * root_mean_square(large, weighted(large, 1), 0));
  EXPECT_LT(root_mean_square(small, weighted(small, 1), 4),
            0.95 * root_mean_square(small, weighted(small, 1), 0));
}

TEST(RelaxedLattice, NeedsTheMapsOfTheCharts) {
  const ReadyScene ready(bulging_sphere(8), mapped(1000, false));
  const auto backend = open("cpu");
  try {
    render::Renderer(*backend, ready.scene, ready.assembly, ready.atlas, with_sweeps(1));
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("--keep-maps"), std::string::npos) << error.what();
  }
}

TEST(RelaxedLattice, IsThatOfTheAtlasWhereNoChartIsResampled) {
  const ReadyScene ready(bulging_sphere(8), geometry_image::AtlasKind::exact);
  const auto backend = open("cpu");
  EXPECT_EQ(relaxed(*backend, ready, weighted(ready, 1), 2), ready.atlas.texel_map);
}

}  // namespace
}  // namespace lodestone::test
