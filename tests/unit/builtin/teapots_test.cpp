// SPDX-License-Identifier: MIT
// Newell's patches, the teapot made of them, and the island it stands on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lodestone/scene/builtin/island.h"
#include "lodestone/scene/builtin/surface.h"
#include "lodestone/scene/builtin/teapot.h"
#include "lodestone/scene/builtin/teapot_patches.h"
#include "lodestone/scene/load.h"
#include "lodestone/scene/mesh_tools.h"
#include "lodestone/scene/pose.h"
#include "mesh_probe.h"

namespace lodestone::scene::builtin {
namespace {

const BezierPatch& patch_at(const PatchSheet& sheet, size_t row, size_t column) {
  return sheet.patches[row * sheet.columns + column % sheet.columns];
}

size_t rows_of(const PatchSheet& sheet) {
  return sheet.patches.size() / sheet.columns;
}

glm::vec3 unit_normal(const PatchSample& sample) {
  return glm::normalize(glm::cross(sample.along_u, sample.along_v));
}

TEST(TeapotPatches, HaveTheSumsOfThePublishedTable) {
  std::set<std::array<float, 3>> distinct;
  size_t patches = 0;
  glm::dvec3 sums(0);
  for (const PatchSheet& sheet : teapot_patches())
    for (const BezierPatch& patch : sheet.patches) {
      ++patches;
      for (const glm::vec3& p : patch) {
        distinct.insert({p.x, p.y, p.z});
        sums += glm::dvec3(glm::abs(p));
      }
    }
  EXPECT_EQ(patches, 32u);
  EXPECT_EQ(distinct.size(), 290u);
  EXPECT_NEAR(sums.x, 629.26, 1e-4);
  EXPECT_NEAR(sums.y, 883.275, 1e-4);
  EXPECT_NEAR(sums.z, 312.44, 1e-4);
}

TEST(TeapotPatches, ShareTheirBordersToTheBit) {
  for (const PatchSheet& sheet : teapot_patches())
    for (size_t row = 0; row < rows_of(sheet); ++row)
      for (size_t column = 0; column < sheet.columns; ++column)
        for (int k = 0; k <= 10; ++k) {
          const float t = float(k) / 10;
          const BezierPatch& patch = patch_at(sheet, row, column);
          EXPECT_EQ(sample_patch(patch, 1, t).position,
                    sample_patch(patch_at(sheet, row, column + 1), 0, t).position)
              << sheet.name << " " << row << " " << column;
          if (row + 1 < rows_of(sheet)) {
            EXPECT_EQ(sample_patch(patch, t, 1).position,
                      sample_patch(patch_at(sheet, row + 1, column), t, 0).position)
                << sheet.name << " " << row << " " << column;
          }
        }
}

TEST(TeapotPatches, JoinSmoothly) {
  for (const PatchSheet& sheet : teapot_patches())
    for (size_t row = 0; row < rows_of(sheet); ++row)
      for (size_t column = 0; column < sheet.columns; ++column)
        for (int k = 1; k <= 9; ++k) {  // not at a pole, where a patch has no normal
          const float t = float(k) / 10;
          const BezierPatch& patch = patch_at(sheet, row, column);
          EXPECT_GT(glm::dot(unit_normal(sample_patch(patch, 1, t)),
                             unit_normal(sample_patch(patch_at(sheet, row, column + 1), 0, t))),
                    0.999999f)
              << sheet.name << " " << row << " " << column;
          if (row + 1 < rows_of(sheet)) {
            EXPECT_GT(glm::dot(unit_normal(sample_patch(patch, t, 1)),
                               unit_normal(sample_patch(patch_at(sheet, row + 1, column), t, 0))),
                      0.999999f)
                << sheet.name << " " << row << " " << column;
          }
        }
}

TEST(TeapotPatches, SlopesAreThoseOfTheSurface) {
  constexpr float h = 1.0f / 256;
  for (const PatchSheet& sheet : teapot_patches())
    for (const BezierPatch& patch : sheet.patches)
      for (const glm::vec2 at : {glm::vec2(0.25f, 0.75f), glm::vec2(0.5f, 0.125f)}) {
        const PatchSample sample = sample_patch(patch, at.x, at.y);
        const glm::vec3 u =
            (sample_patch(patch, at.x + h, at.y).position - sample_patch(patch, at.x - h, at.y).position) /
            (2 * h);
        const glm::vec3 v =
            (sample_patch(patch, at.x, at.y + h).position - sample_patch(patch, at.x, at.y - h).position) /
            (2 * h);
        EXPECT_LT(glm::length(sample.along_u - u), 1e-3f);
        EXPECT_LT(glm::length(sample.along_v - v), 1e-3f);
      }
}

class Teapot : public testing::Test {
 protected:
  const Mesh mesh = teapot("pot", 0);

  // The normal of the vertex that is farthest in a direction.
  glm::vec3 normal_towards(glm::vec3 direction) const {
    size_t farthest = 0;
    for (size_t v = 0; v < mesh.positions.size(); ++v)
      if (glm::dot(mesh.positions[v] - mesh.positions[farthest], direction) > 0) farthest = v;
    return mesh.normals[farthest];
  }
};

TEST_F(Teapot, IsAsLargeAsThePublishedOne) {
  glm::vec3 lo(9), hi(-9);
  for (const glm::vec3& p : mesh.positions) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  EXPECT_EQ(lo, glm::vec3(-3, 0, -2));
  EXPECT_EQ(hi.y, snap(3.15f));
  EXPECT_EQ(hi.z, 2);
  // The only extreme that is not a corner of a patch: the spout's lip bulges over its last sample.
  EXPECT_NEAR(hi.x, 3.434f, 0.002f);
}

TEST_F(Teapot, IsOpenWhereTheOriginalIs) {
  EXPECT_EQ(mesh.grids.size(), 34u);  // a patch each, and two caps
  constexpr size_t rim = 64, lid = 64, handle = 2 * 32, spout = 2 * 32;
  EXPECT_EQ(test::open_edges(mesh), rim + lid + handle + spout);
}

TEST_F(Teapot, HasNoTriangleWithoutArea) {
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 across =
        glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
    EXPECT_GT(glm::length(across), 1e-6f);
  }
}

TEST_F(Teapot, NormalsAreThoseOfItsOutside) {
  float least = 1;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 facet = facet_normal(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
    for (int k = 0; k < 3; ++k) least = std::min(least, glm::dot(facet, mesh.normals[t[k]]));
  }
  EXPECT_GT(least, 0.5f);  // 60 degrees: the spout's lip is sharp
  for (const glm::vec3 direction : {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0),
                                    glm::vec3(0, -1, 0), glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)})
    EXPECT_GT(glm::dot(normal_towards(direction), direction), 0.5f) << direction.x << direction.y;
  EXPECT_EQ(normal_towards({0, 1, 0}), glm::vec3(0, 1, 0));
}

// Which nodes show a teapot.
std::vector<uint32_t> pots_of(const Scene& scene) {
  std::vector<uint32_t> nodes;
  for (uint32_t n = 0; n < scene.nodes.size(); ++n)
    if (scene.nodes[n].mesh != none && scene.meshes[scene.nodes[n].mesh].grids.size() == 34)
      nodes.push_back(n);
  return nodes;
}

TEST(TeapotIsland, HasThreeTeapotsOfThreeMaterialsAndACameraForEachView) {
  const Scene scene = make_builtin("teapots");
  std::set<std::pair<float, float>> finishes;
  for (const uint32_t node : pots_of(scene)) {
    const Material& material = scene.materials[scene.meshes[scene.nodes[node].mesh].parts.at(0).material];
    finishes.emplace(material.metallic, material.roughness);
  }
  EXPECT_EQ(finishes, (std::set<std::pair<float, float>>{{0, 0.1f}, {1, 0.02f}, {1, 0.25f}}));
  std::set<std::string> cameras;
  for (const Camera& camera : scene.cameras) cameras.insert(camera.name);
  EXPECT_EQ(cameras, (std::set<std::string>{"handle", "island", "teapots"}));
}

// Teapots turn about their axes: what matters is how far they reach.
TEST(TeapotIsland, TeapotsTouchNeitherEachOtherNorTheGround) {
  const Scene scene = make_builtin("teapots");
  const std::vector<uint32_t> pots = pots_of(scene);
  ASSERT_EQ(pots.size(), 3u);
  float reach = 0;
  for (const glm::vec3& p : scene.meshes[scene.nodes[pots[0]].mesh].positions)
    reach = std::max(reach, glm::length(glm::vec2(p.x, p.z)));
  for (const uint32_t a : pots) {
    const glm::vec3 at = scene.nodes[a].translation;
    EXPECT_GT(at.y, 0);
    EXPECT_LT(at.y, 0.01f);
    // A quad of the ground is less than 1 wide there.
    EXPECT_LT(glm::length(glm::vec2(at.x, at.z)) + reach + 1.5f, plateau_radius);
    for (const uint32_t b : pots) {
      const glm::vec3 apart = scene.nodes[b].translation - at;
      if (a < b) {
        EXPECT_GT(glm::length(glm::vec2(apart.x, apart.z)), 2 * reach);
      }
    }
  }
  for (const Mesh& mesh : scene.meshes)
    if (mesh.name == "ground")
      for (const glm::vec3& p : mesh.positions)
        if (glm::length(glm::vec2(p.x, p.z)) < plateau_radius) {
          EXPECT_EQ(p.y, 0);
        }
}

TEST(TeapotIsland, GroundEndsBelowTheSeaAndPalmsGrowAboveIt) {
  const Scene scene = make_builtin("teapots");
  const auto mesh_named = [&](const std::string& name) {
    return *std::find_if(scene.meshes.begin(), scene.meshes.end(),
                         [&](const Mesh& m) { return m.name == name; });
  };
  float wave_lo = 0, wave_hi = -9;
  for (const glm::vec3& p : mesh_named("sea").positions) {
    wave_lo = std::min(wave_lo, p.y);
    wave_hi = std::max(wave_hi, p.y);
    if (glm::length(glm::vec2(p.x, p.z)) < 56.01f) {
      EXPECT_LT(p.y + 0.5f, island_height({p.x, p.z}));
    }
  }
  const Mesh ground = mesh_named("ground");
  float edge = 0;
  for (const glm::vec3& p : ground.positions) edge = std::max(edge, p.x);
  for (const glm::vec3& p : ground.positions)
    if (std::max(std::abs(p.x), std::abs(p.z)) == edge) {
      EXPECT_LT(p.y, wave_lo);
    }
  size_t palms = 0;
  for (const Node& node : scene.nodes) {
    if (!node.name.starts_with("palm")) continue;
    ++palms;
    EXPECT_GT(node.translation.y, wave_hi) << node.name;
    EXPECT_GT(glm::length(node.translation), 2 * plateau_radius) << node.name;
  }
  EXPECT_EQ(palms, 12u);
}

TEST(TeapotIsland, TurnsItsTeapotsAndNothingElse) {
  const Scene scene = make_builtin("teapots");
  EXPECT_EQ(scene.animations.at(0).name, "Turn");
  EXPECT_EQ(scene.animations[0].duration(), 2);
  const Pose first = evaluate(scene, 0, 0), later = evaluate(scene, 0, 0.7f);
  const std::vector<uint32_t> pots = pots_of(scene);
  for (uint32_t n = 0; n < scene.nodes.size(); ++n) {
    const bool pot = std::count(pots.begin(), pots.end(), n) > 0;
    EXPECT_EQ(first.node_world[n] != later.node_world[n], pot) << scene.nodes[n].name;
    EXPECT_EQ(first.node_world[n][3], later.node_world[n][3]);  // where it stands
  }
  for (const uint32_t n : pots)
    for (int k = 0; k < 4; ++k)
      EXPECT_LT(glm::length(first.node_world[n][k] - evaluate(scene, none, 0).node_world[n][k]), 1e-6f);
}

}  // namespace
}  // namespace lodestone::scene::builtin
