// SPDX-License-Identifier: MIT
// Meshes that are traced once and placed many times look as if each place had its own.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>

#include "lodestone/test_support/devices.h"
#include "lodestone/test_support/grid_sphere.h"
#include "lodestone/test_support/instanced_scenes.h"
#include "lodestone/test_support/leak_check.h"
#include "lodestone/test_support/rays.h"
#include "lodestone/test_support/ready_scene.h"

namespace lodestone::test {
namespace {

using scene::Instancing;

class InstancesOn : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<render::Backend> backend_ = open(GetParam());

  std::vector<glm::uvec4> hits(const ReadyScene& ready, const Rays& rays, float time) {
    render::Settings settings;
    settings.width = settings.height = 8;
    render::Renderer renderer(*backend_, ready.scene, ready.assembly, ready.atlas, settings);
    renderer.update(ready.pose(time));
    renderer.load_rays(rays);
    renderer.trace_loaded();
    return renderer.hits();
  }

  image::Image picture(const ReadyScene& ready, float time) {
    render::Settings settings;
    settings.width = 96;
    settings.height = 64;
    settings.aovs = {"depth", "normal", "albedo", "uv", "id"};
    render::Renderer renderer(*backend_, ready.scene, ready.assembly, ready.atlas, settings);
    const scene::Pose pose = ready.pose(time);
    scene::Bounds bounds;
    bounds.include({-2, -1.3f, -1.5f});
    bounds.include({2, 2, 1.8f});
    const render::View view = render::find_view(ready.scene, pose, "auto", bounds, 96, 64);
    return renderer.render(pose, view)->linear;
  }
};

bool is_hit(const glm::uvec4& hit) {
  return hit.w != layout::no_index;
}
float t_of(const glm::uvec4& hit) {
  return std::bit_cast<float>(hit.x);
}

// Rays that graze an edge may fall on either side of it.
void expect_alike(const std::vector<glm::uvec4>& a, const std::vector<glm::uvec4>& b) {
  ASSERT_EQ(a.size(), b.size());
  uint64_t hit = 0, other = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    hit += is_hit(a[i]) ? 1 : 0;
    const bool alike = is_hit(a[i]) == is_hit(b[i]) &&
                       (!is_hit(a[i]) || std::abs(t_of(a[i]) - t_of(b[i])) < 1e-4f * t_of(a[i]));
    other += alike ? 0 : 1;
  }
  EXPECT_GT(hit, a.size() / 10);
  EXPECT_LE(other, a.size() / 2000);
}

TEST_P(InstancesOn, AreHitWhereTheirNodesPutThem) {
  const Rays rays = random_rays({-2.5f, -1.5f, -2}, {2.5f, 2.5f, 2}, 20000, 4);
  const ReadyScene once(grove(), {}, Instancing::on), each(grove());
  ASSERT_EQ(once.assembly.objects.size(), 3u);
  ASSERT_EQ(once.assembly.instances.size(), 9u);
  ASSERT_LT(once.assembly.triangles.size(), each.assembly.triangles.size() / 2);
  for (const float time : {0.0f, 0.5f, 1.0f}) expect_alike(hits(once, rays, time), hits(each, rays, time));
}

// More than the first pass of the sort takes, not a power of two, and of one key in part.
TEST_P(InstancesOn, AreAllFoundHoweverManyThereAre) {
  for (const uint32_t count : {2u, 63u, 64u, 65u, 777u}) {
    scene::Scene scene = swarm(count, 3);
    if (count == 777) {
      for (uint32_t i = 300; i < 500; ++i) scene.nodes[i].translation = scene.nodes[300].translation;
    }
    const float half = count < 10 ? 0.5f : 3.0f;
    if (count < 10) scene = swarm(count, half);
    const Rays rays = random_rays(glm::vec3(-half), glm::vec3(half), 10000, count);
    expect_alike(hits(ReadyScene(scene, {}, Instancing::on), rays, 0), hits(ReadyScene(scene), rays, 0));
  }
}

TEST_P(InstancesOn, LookAsIfEachPlaceHadItsOwn) {
  // Resampled charts would differ between the two.
  constexpr auto exact = geometry_image::AtlasKind::exact;
  const ReadyScene once(grove(), exact, Instancing::on), each(grove(), exact);
  const image::Image a = picture(once, 0.4f), b = picture(each, 0.4f);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (size_t c = 0; c < a.channels.size(); ++c) {
    const image::Channel &of_a = a.channels[c], &of_b = b.channels[c];
    ASSERT_EQ(of_a.name, of_b.name);
    // Rays of one pixel's light are drawn by what its surface is to the last bit.
    if (of_a.name == "R" || of_a.name == "G" || of_a.name == "B") continue;
    // An object's normals are interpolated before they are turned, others afterwards: not quite the same
    // where a node shears or squeezes.
    const float close = of_a.name.starts_with("normal") ? 0.03f : 2e-3f;
    uint64_t different = 0;
    for (size_t i = 0; i < of_a.values.size(); ++i) {
      const float x = of_a.values[i], y = of_b.values[i];
      different += x == y || std::abs(x - y) <= close * std::max(1.0f, std::abs(y)) ? 0 : 1;
    }
    for (size_t i = 0; i < of_a.ids.size(); ++i) different += of_a.ids[i] == of_b.ids[i] ? 0 : 1;
    EXPECT_LE(different, 96u * 64u / 200u) << of_a.name;
  }
}

TEST_P(InstancesOn, LetNoRayOutOfAClosedMesh) {
  const ReadyScene ready(grove(), {}, Instancing::on), alone(grid_sphere(24));
  const auto texels = alone.texels(alone.pose(0));
  const QuadTriangles quads = quad_triangles(alone.atlas);
  const auto inside = points_inside(texels, quads, 6, 3);
  ASSERT_EQ(inside.size(), 6u);
  const scene::Pose pose = ready.pose(0.7f);
  Rays rays;
  for (const scene::Instance& instance : ready.assembly.instances) {
    if (instance.node == scene::none || ready.scene.nodes[instance.node].mesh != 0) continue;
    const glm::mat4& matrix = pose.node_world[instance.node];
    const auto placed = [&](const glm::vec3& p) { return glm::vec3(matrix * glm::vec4(p, 1)); };
    for (const glm::vec3& from : inside) {
      const glm::vec3 origin = placed(from);
      for (size_t i = 0; i < quads.texels.size(); i += 2) {
        const glm::uvec3& t = quads.texels[i];
        add_ray(rays, origin, placed(texels[t.x]) - origin);
        add_ray(rays, origin, placed((texels[t.x] + texels[t.y]) * 0.5f) - origin);
      }
    }
  }
  ASSERT_GT(rays.size(), 2u * 5u * 6u * 1000u);
  uint64_t leaks = 0;
  for (const glm::uvec4& hit : hits(ready, rays, 0.7f)) leaks += is_hit(hit) ? 0 : 1;
  EXPECT_EQ(leaks, 0u);
}

TEST_P(InstancesOn, AreNotSeenWhereTheirScaleIsNothing) {
  scene::Scene scene = swarm(20, 2);
  scene::Animation& clip = scene.animations.emplace_back();
  for (uint32_t node = 0; node < 20; ++node) {
    scene::Channel vanish;
    vanish.node = node;
    vanish.path = scene::Channel::Path::scale;
    vanish.times = {0, 1};
    vanish.values = {0.2f, 0.2f, 0.2f, 0, 0, 0};
    clip.channels.push_back(vanish);
  }
  const ReadyScene ready(scene, {}, Instancing::on);
  const Rays rays = random_rays({-2, -2, -2}, {2, 2, 2}, 2000, 1);
  uint64_t before = 0, after = 0;
  for (const glm::uvec4& hit : hits(ready, rays, 0)) before += is_hit(hit) ? 1 : 0;
  for (const glm::uvec4& hit : hits(ready, rays, 1)) after += is_hit(hit) ? 1 : 0;
  EXPECT_GT(before, 100u);
  EXPECT_EQ(after, 0u);
}

// From the second frame on only the upper level is built, and it is as if it were the first.
TEST_P(InstancesOn, MoveWithoutABlendOrAHierarchyOfTheirOwn) {
  scene::Scene scene = swarm(100, 2);
  scene::Channel turn;
  turn.node = 7;
  turn.path = scene::Channel::Path::translation;
  turn.times = {0, 1};
  turn.values = {0, 0, 0, 0.5f, 0.5f, 1};
  scene.animations.emplace_back().channels.push_back(turn);
  const ReadyScene ready(scene, {}, Instancing::on);
  const Rays rays = random_rays({-2, -2, -2}, {2, 2, 2}, 5000, 1);
  render::Settings settings;
  settings.width = settings.height = 8;
  render::Renderer renderer(*backend_, ready.scene, ready.assembly, ready.atlas, settings);
  renderer.update(ready.pose(0));
  renderer.load_rays(rays);
  backend_->finish();
  renderer.update(ready.pose(1));
  std::set<std::string> passes;
  for (const render::PassRecord& pass : backend_->finish()) passes.insert(pass.name);
  EXPECT_EQ(passes, std::set<std::string>{"upper"});
  renderer.trace_loaded();
  EXPECT_EQ(renderer.hits(), hits(ready, rays, 1));
  EXPECT_NE(renderer.hits(), hits(ready, rays, 0));
}

INSTANTIATE_TEST_SUITE_P(, InstancesOn, testing::ValuesIn(judged_device_names()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace lodestone::test
