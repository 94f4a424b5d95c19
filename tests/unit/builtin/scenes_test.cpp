// SPDX-License-Identifier: MIT
// What holds for every built-in scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lodestone/base/error.h"
#include "lodestone/scene/load.h"
#include "lodestone/scene/scene.h"
#include "mesh_probe.h"

namespace lodestone {
namespace {

using scene::Grid;
using scene::Mesh;
using scene::Scene;

class Builtin : public testing::TestWithParam<std::string> {
 protected:
  const Scene scene = scene::make_builtin(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Scenes, Builtin, testing::ValuesIn(scene::builtin_names()),
                         [](const auto& test) { return test.param; });

TEST_P(Builtin, IsValidAndNamed) {
  EXPECT_NO_THROW(scene::validate(scene));
  EXPECT_EQ(scene.name, "builtin:" + GetParam());
  EXPECT_FALSE(scene.cameras.empty());
  EXPECT_FALSE(scene.lights.empty());
  EXPECT_TRUE(scene.sky.has_value());
}

TEST_P(Builtin, IsTheSameEveryTime) {
  const Scene again = scene::make_builtin(GetParam());
  ASSERT_EQ(again.meshes.size(), scene.meshes.size());
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    EXPECT_EQ(again.meshes[m].positions, scene.meshes[m].positions);
    EXPECT_EQ(again.meshes[m].normals, scene.meshes[m].normals);
    ASSERT_EQ(again.meshes[m].targets.size(), scene.meshes[m].targets.size());
    for (size_t t = 0; t < scene.meshes[m].targets.size(); ++t)
      EXPECT_EQ(again.meshes[m].targets[t].positions, scene.meshes[m].targets[t].positions);
  }
}

TEST_P(Builtin, IsMadeOfGridsByTheRule) {
  for (const Mesh& mesh : scene.meshes) {
    uint32_t next = 0;
    for (const Grid& grid : mesh.grids) {
      ASSERT_GE(grid.width, 2u);
      ASSERT_GE(grid.height, 2u);
      ASSERT_EQ(grid.vertices.size(), size_t(grid.width) * grid.height);
      ASSERT_EQ(grid.first_triangle, next);
      for (uint32_t y = 0; y + 1 < grid.height; ++y)
        for (uint32_t x = 0; x + 1 < grid.width; ++x, next += 2) {
          const auto at = [&](uint32_t i, uint32_t j) { return grid.vertices[size_t(j) * grid.width + i]; };
          const uint32_t a = at(x, y), b = at(x + 1, y), c = at(x, y + 1), d = at(x + 1, y + 1);
          ASSERT_EQ(mesh.triangles[next], glm::uvec3(a, b, c));
          ASSERT_EQ(mesh.triangles[next + 1], glm::uvec3(d, c, b));
        }
    }
    EXPECT_EQ(next, mesh.triangles.size()) << mesh.name;
  }
}

TEST_P(Builtin, UsesEveryVertex) {
  for (const Mesh& mesh : scene.meshes) {
    std::vector<bool> used(mesh.positions.size(), false);
    for (const glm::uvec3& t : mesh.triangles) used[t.x] = used[t.y] = used[t.z] = true;
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << mesh.name;
  }
}

bool is_snapped(float value) {
  return std::floor(double(value) * 1048576) == double(value) * 1048576;
}
bool is_snapped(glm::vec3 v) {
  return is_snapped(v.x) && is_snapped(v.y) && is_snapped(v.z);
}

TEST_P(Builtin, HasRoundedNumbers) {
  for (const Mesh& mesh : scene.meshes) {
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      ASSERT_TRUE(is_snapped(mesh.positions[v])) << mesh.name << " position " << v;
      ASSERT_TRUE(is_snapped(mesh.normals[v])) << mesh.name << " normal " << v;
    }
    for (const glm::vec2& uv : mesh.texcoords[0]) ASSERT_TRUE(is_snapped({uv, 0})) << mesh.name;
    for (const scene::MorphTarget& target : mesh.targets)
      for (size_t k = 0; k < target.vertices.size(); ++k) {
        ASSERT_TRUE(is_snapped(target.positions[k])) << mesh.name << " " << target.name;
        ASSERT_TRUE(is_snapped(target.normals[k])) << mesh.name << " " << target.name;
      }
  }
}

TEST_P(Builtin, HasUnitNormalsInEveryShape) {
  const auto expect_unit = [](const std::vector<glm::vec3>& normals, const std::string& what) {
    for (size_t v = 0; v < normals.size(); ++v)
      ASSERT_NEAR(glm::length(normals[v]), 1, 4e-6) << what << " vertex " << v;
  };
  for (const Mesh& mesh : scene.meshes) {
    expect_unit(mesh.normals, mesh.name);
    for (const scene::MorphTarget& target : mesh.targets)
      expect_unit(test::posed_normals(mesh, target), mesh.name + " " + target.name);
  }
}

TEST_P(Builtin, HasBlendshapesThatMoveSomething) {
  std::set<std::string> names;
  for (const Mesh& mesh : scene.meshes) {
    EXPECT_EQ(mesh.weights, std::vector<float>(mesh.targets.size(), 0)) << mesh.name;
    for (const scene::MorphTarget& target : mesh.targets) {
      names.insert(target.name);
      float farthest = 0;
      for (const glm::vec3& move : target.positions) farthest = std::max(farthest, glm::length(move));
      EXPECT_GT(farthest, 0.005f) << mesh.name << " " << target.name;
    }
  }
  const std::set<std::string> rigid = {"room", "shoal", "teapots"};
  EXPECT_EQ(names.empty(), rigid.contains(GetParam()));
}

TEST(Builtins, AreListedByName) {
  const std::vector<std::string> expected = {"head",    "room",    "shoal", "spheres",
                                             "teapots", "terrain", "tiny"};
  EXPECT_EQ(scene::builtin_names(), expected);
}

TEST(Builtins, MakeTheTerrainAsLargeAsOneLikes) {
  for (const uint32_t quads : {16u, 300u, 1030u}) {
    const scene::Scene terrain = scene::make_builtin("terrain:" + std::to_string(quads));
    ASSERT_EQ(terrain.meshes.size(), 1u);
    const Mesh& mesh = terrain.meshes[0];
    EXPECT_EQ(mesh.triangles.size(), 2 * size_t(quads) * quads);
    EXPECT_EQ(mesh.positions.size(), size_t(quads + 1) * (quads + 1));
    EXPECT_EQ(mesh.grids.size(), quads > 1024 ? 4u : 1u);
    // The same mountains, which more quads only show more of.
    float highest = 0;
    for (const glm::vec3& p : mesh.positions) {
      EXPECT_LE(std::max(std::abs(p.x), std::abs(p.z)), 5.3f);
      highest = std::max(highest, p.y);
    }
    EXPECT_NEAR(highest, 1.2f, 0.3f);
  }
  EXPECT_EQ(scene::make_builtin("terrain:16").name, "builtin:terrain:16");
}

TEST(Builtins, RefuseAnUnknownNameAndListTheKnownOnes) {
  try {
    scene::make_builtin("teapot");
    FAIL() << "made a teapot";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("teapot"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("head, room, shoal, spheres, teapots, terrain, tiny"),
              std::string::npos);
  }
}

// Of all that is placed.
size_t triangle_count(const Scene& scene) {
  size_t count = 0;
  for (const scene::Node& node : scene.nodes)
    if (node.mesh != scene::none) count += scene.meshes[node.mesh].triangles.size();
  return count;
}

TEST(Builtins, HaveTheSizesTheyPromise) {
  EXPECT_EQ(triangle_count(scene::make_builtin("tiny")), 6u);
  EXPECT_NEAR(double(triangle_count(scene::make_builtin("spheres"))), 10000, 1500);
  EXPECT_NEAR(double(triangle_count(scene::make_builtin("terrain"))), 40000, 3000);
  EXPECT_NEAR(double(triangle_count(scene::make_builtin("teapots"))), 98000, 1000);
  size_t vertices = 0;
  for (const Mesh& mesh : scene::make_builtin("head").meshes) vertices += mesh.positions.size();
  EXPECT_NEAR(double(vertices), 65000, 6000);
}

TEST(Builtins, ClosedMeshesAreClosedAndFaceOutwardsInEveryShape) {
  for (const char* name : {"head", "spheres"})
    for (const Mesh& mesh : scene::make_builtin(name).meshes) {
      if (mesh.name == "floor") continue;
      EXPECT_EQ(test::open_edges(mesh), 0u) << name << " " << mesh.name;
      EXPECT_GT(test::volume(mesh, mesh.positions), 0) << name << " " << mesh.name;
      for (const scene::MorphTarget& target : mesh.targets)
        EXPECT_GT(test::volume(mesh, test::posed_positions(mesh, target)), 0) << mesh.name << target.name;
    }
}

TEST(Builtins, AnOpenMeshCountsAsOpen) {
  Mesh mesh = scene::make_builtin("spheres").meshes.at(1);
  ASSERT_EQ(test::open_edges(mesh), 0u);
  mesh.triangles.pop_back();
  EXPECT_EQ(test::open_edges(mesh), 3u);
}

TEST(Builtins, ChartsOfTheTerrainShareTheirBorders) {
  const Mesh mesh = scene::make_builtin("terrain").meshes.at(0);
  ASSERT_EQ(mesh.grids.size(), 6u);
  const auto column = [](const Grid& grid, uint32_t x) {
    std::vector<uint32_t> out;
    for (uint32_t y = 0; y < grid.height; ++y) out.push_back(grid.vertices[size_t(y) * grid.width + x]);
    return out;
  };
  const auto row = [](const Grid& grid, uint32_t y) {
    const auto first = grid.vertices.begin() + ptrdiff_t(y) * grid.width;
    return std::vector<uint32_t>(first, first + grid.width);
  };
  for (size_t k = 0; k < 6; ++k) {
    const Grid& grid = mesh.grids[k];
    if (k % 3 < 2) {
      EXPECT_EQ(column(grid, grid.width - 1), column(mesh.grids[k + 1], 0));
    }
    if (k < 3) {
      EXPECT_EQ(row(grid, grid.height - 1), row(mesh.grids[k + 3], 0));
    }
  }
  // Nothing else is open but the outer border.
  EXPECT_EQ(test::open_edges(mesh), 2u * (208 + 92));
}

TEST(Builtins, TexturedSphereDoublesItsBorderVertices) {
  const Scene spheres = scene::make_builtin("spheres");
  const auto mesh = std::find_if(spheres.meshes.begin(), spheres.meshes.end(),
                                 [](const Mesh& m) { return m.name == "checkered"; });
  ASSERT_NE(mesh, spheres.meshes.end());
  const std::vector<uint32_t> joined = test::joined_vertices(*mesh);
  const std::set<uint32_t> distinct(joined.begin(), joined.end());
  EXPECT_EQ(mesh->positions.size(), 6u * 13 * 13);
  EXPECT_EQ(distinct.size(), 6u * 12 * 12 + 2);
}

TEST(Builtins, SpheresHaveLightsOfEveryKind) {
  std::set<scene::Light::Kind> kinds;
  for (const scene::Light& light : scene::make_builtin("spheres").lights) kinds.insert(light.kind);
  EXPECT_EQ(kinds.size(), 3u);
}

}  // namespace
}  // namespace lodestone
