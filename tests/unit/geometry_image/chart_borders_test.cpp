// SPDX-License-Identifier: MIT
// The surface that rays meet has no crack: the passes `blend` and `rasterise` are run on the CPU, and the
// small triangles of all quads must fit together edge by edge, bit by bit, wherever the input does.
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>

#include "brute_force.h"
#include "lodestone/layout/arithmetic.h"
#include "lodestone/scene/load.h"
#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

using test::EdgeCounts;

// As the pass `rasterise` does it.
std::vector<glm::vec3> rasterised(const Atlas& atlas, const scene::Assembly& assembly,
                                  const std::vector<glm::vec3>& positions) {
  std::vector<glm::vec3> image;
  for (const glm::uvec4& texel : atlas.texel_map) {
    if (texel.w == 0) {
      image.emplace_back(NAN);
      continue;
    }
    const glm::uvec4& t = assembly.triangles[texel.x];
    const float b1 = std::bit_cast<float>(texel.y), b2 = std::bit_cast<float>(texel.z);
    const float b0 = 1.0f - b1 - b2;
    image.push_back(layout::flush_tiny3(positions[t.x] * b0 + positions[t.y] * b1 + positions[t.z] * b2));
  }
  return image;
}

// One a placement: surfaces that only touch are not one.
std::vector<EdgeCounts> edges_of_quads(const Atlas& atlas, const scene::Assembly& assembly,
                                       const std::vector<glm::vec3>& image) {
  std::vector<EdgeCounts> edges(assembly.placements.size());
  for (const glm::uvec2& leaf : atlas.leaf_map) {
    if (leaf.x == layout::empty_slot) continue;
    size_t placement = edges.size() - 1;
    while (assembly.placements[placement].first_triangle > atlas.texel_map[leaf.x].x) --placement;
    const glm::vec3* a = &image[leaf.x];
    edges[placement].add(a[0], a[1], a[leaf.y]);
    edges[placement].add(a[leaf.y + 1], a[leaf.y], a[1]);
  }
  return edges;
}

// A border of the input is two borders of small triangles in an exact chart, one in a grid chart. Mapped
// charts put samples of their own on it.
void expect_tight(const scene::Scene& scene, const Atlas& atlas, const scene::Pose& pose) {
  const scene::Assembly assembly = scene::assemble(scene);
  const std::vector<glm::vec3> positions = scene::blended_positions(
      assembly, scene::frame_weights(scene, assembly, pose), scene::frame_matrices(scene, assembly, pose));
  uint64_t boundary = 0, odd = 0;
  for (const EdgeCounts& edges : edges_of_quads(atlas, assembly, rasterised(atlas, assembly, positions))) {
    boundary += edges.boundary();
    odd += edges.odd();
  }
  ASSERT_NE(atlas.kind, AtlasKind::automatic);
  if (atlas.kind == AtlasKind::charts) {
    EXPECT_EQ(boundary == 0, atlas.report.boundary_edges == 0) << boundary;
  } else {
    EXPECT_EQ(boundary, (atlas.kind == AtlasKind::exact ? 2 : 1) * atlas.report.boundary_edges);
  }
  EXPECT_TRUE(odd == 0 || !atlas.report.closed()) << odd;
}

// The rest pose, and others: turned by a rotation that rounds, and with random morph weights.
void expect_tight_in_many_poses(scene::Scene scene, AtlasKind kind) {
  const Atlas atlas = test::atlas_of(scene, kind);
  expect_tight(scene, atlas, scene::evaluate(scene, scene::none, 0));
  std::mt19937 random(11);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  for (scene::Node& node : scene.nodes) {
    if (node.matrix) continue;
    node.rotation = glm::normalize(glm::quat(number(random), number(random), number(random), number(random)));
    node.scale *= glm::vec3(1.1f, 0.7f, -1.3f);
  }
  scene::Pose pose = scene::evaluate(scene, scene::none, 0);
  for (std::vector<float>& weights : pose.weights) {
    for (float& weight : weights) weight = number(random);
  }
  expect_tight(scene, atlas, pose);
}

class BuiltinBorders : public testing::TestWithParam<const char*> {};

TEST_P(BuiltinBorders, FitToTheBit) {
  const scene::Scene scene = scene::make_builtin(GetParam());
  for (const AtlasKind kind : {AtlasKind::automatic, AtlasKind::exact, AtlasKind::charts})
    expect_tight_in_many_poses(scene, kind);
}

INSTANTIATE_TEST_SUITE_P(ChartBorders, BuiltinBorders, testing::Values("head", "spheres", "teapots", "tiny"));

// Real meshes are not part of the repository: LODESTONE_DATA names their folder.
class FileBorders : public testing::TestWithParam<const char*> {};

TEST_P(FileBorders, FitToTheBit) {
  const char* folder = std::getenv("LODESTONE_DATA");
  const std::filesystem::path data =
      folder != nullptr ? folder : std::filesystem::path(LODESTONE_SOURCE_DIR) / ".." / "shared" / "data";
  const std::filesystem::path file = data / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there; set LODESTONE_DATA";
  const scene::Scene scene = scene::load(file.string());
  for (const AtlasKind kind : {AtlasKind::exact, AtlasKind::charts}) expect_tight_in_many_poses(scene, kind);
}

INSTANTIATE_TEST_SUITE_P(ChartBorders, FileBorders,
                         testing::Values("spot.obj", "armadillo.obj", "counter_assembly.stl", "CesiumMan.glb",
                                         "Fox.glb", "ict_face_dense16.glb", "AnimatedMorphCube.glb"));

TEST(ChartBorders, FitOnRandomTriangles) {
  for (uint32_t seed = 0; seed < 5; ++seed) {
    scene::Mesh mesh = test::random_mesh(seed, 400, 900);
    // Every triangle and its back: closed, whatever they are.
    const std::vector<glm::uvec3> front = mesh.triangles;
    for (const glm::uvec3& t : front) mesh.triangles.emplace_back(t.x, t.z, t.y);
    mesh.parts[0].triangle_count *= 2;
    for (const AtlasKind kind : {AtlasKind::exact, AtlasKind::charts})
      expect_tight_in_many_poses(test::scene_of({mesh}), kind);
  }
}

// The check itself must see a crack of one bit.
TEST(ChartBorders, AreSeenToDifferByABit) {
  const scene::Scene scene = scene::make_builtin("spheres");
  const scene::Assembly assembly = scene::assemble(scene);
  const Atlas atlas = build_atlas(scene, assembly, AtlasKind::exact);
  std::vector<glm::vec3> image = rasterised(atlas, assembly, assembly.positions);
  const auto boundary = [&] {
    uint64_t all = 0;
    for (const EdgeCounts& edges : edges_of_quads(atlas, assembly, image)) all += edges.boundary();
    return all;
  };
  const uint64_t before = boundary();
  glm::vec3& midpoint = image[atlas.charts[atlas.charts.size() / 2].first_texel + 1];
  midpoint.x = std::nextafter(midpoint.x, 1e9f);
  EXPECT_GT(boundary(), before);
}

}  // namespace
}  // namespace lodestone::geometry_image
