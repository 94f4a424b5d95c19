// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "lodestone/base/parallel.h"
#include "lodestone/geometry_image/atlas_file.h"
#include "lodestone/geometry_image/build.h"
#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

using test::height_field;
using test::random_mesh;
using test::scene_of;

// Large enough for every loop to be split: 60,000 triangles with faults, a large grid and small ones.
scene::Scene large_scene() {
  scene::Scene scene = scene_of({random_mesh(1, 30000, 60000), height_field(400, 300), height_field(20, 20)});
  scene.meshes[0].targets.push_back({"a", {5, 6, 7}, {{1, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {}, {}});
  scene.meshes[0].weights = {0.5f};
  scene.nodes.push_back(scene.nodes[2]);
  return scene;
}

TEST(Threads, DoNotShowInAnAtlasOrInItsFile) {
  const scene::Scene scene = large_scene();
  for (const ChartOrder order : {ChartOrder::median, ChartOrder::hilbert}) {
    std::vector<std::byte> expected;
    for (const uint32_t threads : {1u, 2u, 0u}) {
      set_thread_count(threads);
      const Atlas atlas = build_atlas(scene, scene::assemble(scene), AtlasKind::automatic, order);
      // The file holds all of the atlas.
      const std::vector<std::byte> packed = pack_atlas(atlas, {"hash"});
      if (expected.empty()) expected = packed;
      EXPECT_TRUE(packed == expected) << threads << " threads";
    }
    set_thread_count(0);
  }
}

}  // namespace
}  // namespace lodestone::geometry_image
