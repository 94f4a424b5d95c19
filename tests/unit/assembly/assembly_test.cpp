// SPDX-License-Identifier: MIT
#include "lodestone/scene/assembly.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "lodestone/base/error.h"
#include "sample_scenes.h"

namespace lodestone::scene {
namespace {

using test::random_character;
using test::scene_of;
using test::strip;

TEST(Assembly, PutsPlacementsBehindOneAnotherInNodeOrder) {
  Scene scene = scene_of({strip(4), strip(5)});
  scene.nodes.insert(scene.nodes.begin() + 1, Node{});  // places nothing
  scene.nodes.emplace_back();
  scene.nodes.back().mesh = 0;  // a second time
  const Assembly assembly = assemble(scene);
  ASSERT_EQ(assembly.placements.size(), 3u);
  const uint32_t nodes[] = {0, 2, 3}, meshes[] = {0, 1, 0}, vertices[] = {0, 4, 9}, triangles[] = {0, 2, 5};
  for (uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(assembly.placements[i].node, nodes[i]);
    EXPECT_EQ(assembly.placements[i].mesh, meshes[i]);
    EXPECT_EQ(assembly.placements[i].first_vertex, vertices[i]);
    EXPECT_EQ(assembly.placements[i].first_triangle, triangles[i]);
    EXPECT_EQ(assembly.placements[i].first_matrix, i);
  }
  EXPECT_EQ(assembly.positions.size(), 13u);
  EXPECT_EQ(assembly.matrix_count, 3u);
  ASSERT_EQ(assembly.triangles.size(), 7u);
  EXPECT_EQ(assembly.triangles[2], glm::uvec4(4, 5, 6, 1));
  EXPECT_EQ(assembly.triangles[6], glm::uvec4(10, 11, 12, 2));
  for (uint32_t v = 0; v < 13; ++v) {
    const uint32_t in_mesh = v < 4 ? v : v < 9 ? v - 4 : v - 9;
    EXPECT_EQ(assembly.positions[v], scene.meshes[0].positions.size() > in_mesh
                                         ? scene.meshes[0].positions[in_mesh]
                                         : scene.meshes[1].positions[in_mesh]);
  }
}

TEST(Assembly, KeepsTheNumbersThatPartsHaveInTheirFile) {
  Mesh mesh = strip(7);
  mesh.parts = {{0, 2, 1}, {2, 3, none}};
  Scene scene = scene_of({strip(3), mesh, mesh});
  scene.materials.resize(2);
  const Assembly assembly = assemble(scene);
  ASSERT_EQ(assembly.parts.size(), 5u);
  for (uint32_t placement = 1; placement < 3; ++placement) {
    const uint32_t first = assembly.placements[placement].first_triangle;
    const AssemblyPart &front = assembly.parts[2 * placement - 1], &back = assembly.parts[2 * placement];
    EXPECT_EQ(front.material, 1u);
    EXPECT_EQ(back.material, none);
    EXPECT_EQ(front.mesh, placement);
    EXPECT_EQ(front.first_triangle, first);
    EXPECT_EQ(back.first_triangle, first + 2);
    EXPECT_EQ(front.first_mesh_triangle, 0u);
    EXPECT_EQ(back.first_mesh_triangle, 2u);
    EXPECT_EQ(assembly.triangles[first + 1].w, 2 * placement - 1);
    EXPECT_EQ(assembly.triangles[first + 2].w, 2 * placement);
  }
}

TEST(Assembly, FillsInAttributesThatAMeshLacks) {
  Mesh full = strip(3);
  full.tangents = {{1, 0, 0, -1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  full.texcoords[1] = {{0, 0}, {1, 0}, {0.5f, 0.25f}};
  full.colors = {{0, 0.25f, 1, 0}, {1, 1, 1, 1}, {2, -1, 0.04f, 1}};
  const Assembly assembly = assemble(scene_of({strip(3), full}));
  EXPECT_TRUE(assembly.has_tangents);
  ASSERT_EQ(assembly.tangents.size(), 6u);
  ASSERT_EQ(assembly.texcoords[0].size(), 6u);
  ASSERT_EQ(assembly.texcoords[1].size(), 6u);
  ASSERT_EQ(assembly.colors.size(), 6u);
  EXPECT_EQ(glm::vec3(assembly.tangents[1]), glm::vec3(0));
  EXPECT_EQ(assembly.tangents[3], glm::vec4(1, 0, 0, -1));
  EXPECT_EQ(assembly.texcoords[1][2], glm::vec2(0));
  EXPECT_EQ(assembly.texcoords[1][5], glm::vec2(0.5f, 0.25f));
  EXPECT_EQ(assembly.colors[0], 0xffffffffu);
  EXPECT_EQ(assembly.colors[3], 0x00ff8000u);
  EXPECT_EQ(assembly.colors[5], 0xff3300ffu) << "out of range is clamped";
  EXPECT_FALSE(assemble(scene_of({strip(3)})).has_tangents);
}

TEST(Assembly, SortsMorphDeltasByVertexThenWeight) {
  Scene scene = random_character(1, 50, 7, 0);
  Scene other = random_character(2, 30, 4, 0);
  scene.meshes.push_back(other.meshes[0]);
  scene.nodes.push_back(other.nodes[0]);
  scene.nodes.back().mesh = 1;
  const Assembly assembly = assemble(scene);
  EXPECT_EQ(assembly.weight_count, 11u);
  EXPECT_EQ(assembly.placements[1].first_weight, 7u);
  ASSERT_EQ(assembly.first_morph.size(), 81u);

  std::map<std::pair<uint32_t, uint32_t>, std::pair<glm::vec3, glm::vec3>> expected;  // by vertex and weight
  for (const Placement& placement : assembly.placements) {
    const Mesh& mesh = scene.meshes[placement.mesh];
    for (uint32_t t = 0; t < mesh.targets.size(); ++t) {
      const MorphTarget& target = mesh.targets[t];
      for (size_t i = 0; i < target.vertices.size(); ++i) {
        expected[{placement.first_vertex + target.vertices[i], placement.first_weight + t}] = {
            target.positions[i], target.normals[i]};
      }
    }
  }
  ASSERT_EQ(assembly.morphs.size(), expected.size());
  auto next = expected.begin();
  for (uint32_t v = 0; v < assembly.positions.size(); ++v) {
    for (uint32_t i = assembly.first_morph[v]; i < assembly.first_morph[v + 1]; ++i, ++next) {
      ASSERT_EQ(next->first, std::pair(v, assembly.morphs[i].weight));
      EXPECT_EQ(next->second.first, assembly.morphs[i].position);
      EXPECT_EQ(next->second.second, assembly.morphs[i].normal);
    }
  }
}

TEST(Assembly, LetsSkinnedVerticesFollowJointsAndOthersTheirNode) {
  Scene scene = random_character(3, 20, 0, 5);
  scene.meshes.push_back(strip(4));
  scene.nodes.emplace_back();
  scene.nodes.back().mesh = 1;
  scene.nodes.push_back(scene.nodes[0]);  // the character a second time
  const Assembly assembly = assemble(scene);
  EXPECT_EQ(assembly.matrix_count, 5u + 1u + 5u);
  const Mesh& mesh = scene.meshes[0];
  for (const Placement& placement : assembly.placements) {
    const auto vertices = static_cast<uint32_t>(scene.meshes[placement.mesh].positions.size());
    for (uint32_t v = 0; v < vertices; ++v) {
      const uint32_t first = assembly.first_influence[placement.first_vertex + v];
      const uint32_t count = assembly.first_influence[placement.first_vertex + v + 1] - first;
      if (placement.mesh == 1) {
        ASSERT_EQ(count, 1u);
        EXPECT_EQ(assembly.influences[first].matrix, 5u);
        EXPECT_EQ(assembly.influences[first].weight, 1.0f);
        continue;
      }
      ASSERT_EQ(count, mesh.first_influence[v + 1] - mesh.first_influence[v]);
      for (uint32_t i = 0; i < count; ++i) {
        const Influence& influence = mesh.influences[mesh.first_influence[v] + i];
        EXPECT_EQ(assembly.influences[first + i].matrix, placement.first_matrix + influence.joint);
        EXPECT_EQ(assembly.influences[first + i].weight, influence.weight);
      }
    }
  }
}

TEST(Assembly, MakesZeroOfMinusZeroAndOfNumbersThatDevicesMayFlush) {
  Mesh mesh = strip(3);
  mesh.positions[1] = {-0.0f, 1e-40f, -1e-30f};
  mesh.normals[1] = {-0.0f, 1, 1e-39f};
  mesh.targets.push_back({"t", {1}, {{1e-42f, -0.0f, 5}}, {}, {}});
  mesh.weights = {0};
  const Assembly assembly = assemble(scene_of({mesh}));
  for (const float zero :
       {assembly.positions[1].x, assembly.positions[1].y, assembly.positions[1].z, assembly.normals[1].x,
        assembly.normals[1].z, assembly.morphs[0].position.x, assembly.morphs[0].position.y}) {
    EXPECT_EQ(zero, 0.0f);
    EXPECT_FALSE(std::signbit(zero));
  }
  EXPECT_EQ(assembly.morphs[0].position.z, 5.0f);
}

void expect_refused(const Scene& scene, const std::string& because) {
  try {
    assemble(scene);
    FAIL() << "taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    EXPECT_NE(std::string(error.what()).find(because), std::string::npos) << error.what();
    EXPECT_TRUE(std::string(error.what()).starts_with("test: ")) << error.what();
  }
}

TEST(Assembly, RefusesASceneThatDrawsNothing) {
  Scene unplaced = scene_of({strip(3)});
  unplaced.nodes.clear();
  expect_refused(unplaced, "nothing to draw");
  expect_refused(scene_of({strip(2)}), "nothing to draw");
}

TEST(Assembly, RefusesMoreTrianglesThanCanBeNumberedBeforeItAllocatesThem) {
  Mesh mesh = strip(3);
  mesh.triangles.resize(1u << 20, glm::uvec3(0, 1, 2));
  mesh.parts = {{0, 1u << 20, none}};
  Scene scene = scene_of({mesh});
  scene.nodes.resize(257, scene.nodes[0]);
  expect_refused(scene, "269484032 triangles, more than the 268435456");
}

TEST(Assembly, SaysThatTheMemoryWillNotDoBeforeItIsFull) {
  Mesh mesh = strip(3);
  mesh.positions.resize(60000);
  mesh.normals.resize(60000);
  Scene scene = scene_of({mesh});
  scene.nodes.resize(60000, scene.nodes[0]);  // 300 GB of vertices
  try {
    assemble(scene);
    FAIL() << "taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::machine);
    EXPECT_NE(std::string(error.what()).find("needs"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace lodestone::scene
