// SPDX-License-Identifier: MIT
// What portions of an atlas have, together and each.
#include "lodestone/geometry_image/portions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "lodestone/geometry_image/atlas_check.h"
#include "lodestone/geometry_image/charts.h"
#include "lodestone/scene/load.h"
#include "meshes.h"

namespace lodestone::geometry_image {
namespace {

struct Whole {
  scene::Scene scene;
  scene::Assembly assembly = scene::assemble(scene);
  Atlas atlas;
  std::vector<glm::vec3> positions = scene::rest_positions(scene, assembly);

  Whole(scene::Scene made, AtlasKind kind)
      : scene(std::move(made)), atlas(build_atlas(scene, assembly, kind)) {}
};

std::vector<Whole> wholes() {
  std::vector<Whole> all;
  // Charts that are cut and charts that are not, of all kinds, with morphs, skins and textures among them.
  all.emplace_back(scene::make_builtin("terrain"), AtlasKind::automatic);
  all.emplace_back(scene::make_builtin("tiny"), AtlasKind::exact);
  all.emplace_back(scene::make_builtin("spheres"), AtlasKind::charts);
  all.emplace_back(
      test::scene_of({test::random_mesh(3, 50, 200), test::pages(300), test::height_field(90, 7)}),
      AtlasKind::automatic);
  return all;
}

TEST(Portions, HaveEveryQuadOnceAndNoneIsTooLarge) {
  for (const Whole& whole : wholes()) {
    for (const uint64_t quads : {uint64_t(64), uint64_t(500), uint64_t(1000000)}) {
      const auto portions = plan_portions(whole.atlas, quads);
      std::vector<uint32_t> found(whole.atlas.texel_map.size(), 0);
      uint64_t all = 0;
      for (const std::vector<ChartPiece>& portion : portions) {
        uint64_t here = 0;
        std::set<uint32_t> charts;
        for (const ChartPiece& piece : portion) {
          const layout::ChartRecord& chart = whole.atlas.charts[piece.chart];
          ASSERT_TRUE(charts.insert(piece.chart).second);
          ASSERT_GE(piece.width, 2u);
          ASSERT_GE(piece.height, 2u);
          ASSERT_LE(piece.x + piece.width, chart.width);
          ASSERT_LE(piece.y + piece.height, chart.height);
          for (uint32_t y = piece.y; y + 1 < piece.y + piece.height; ++y)
            for (uint32_t x = piece.x; x + 1 < piece.x + piece.width; ++x)
              ++found[chart.first_texel + y * chart.width + x];
          here += piece.quads();
        }
        EXPECT_LE(here, quads);
        EXPECT_TRUE(std::is_sorted(portion.begin(), portion.end(),
                                   [](const auto& a, const auto& b) { return a.chart < b.chart; }));
        all += here;
      }
      uint64_t wanted = 0;
      for (const layout::ChartRecord& chart : whole.atlas.charts) wanted += quad_count(chart);
      EXPECT_EQ(all, wanted);
      EXPECT_EQ(*std::max_element(found.begin(), found.end()), 1u);
      // Not many more than it takes.
      EXPECT_LE(portions.size(), 3 * (wanted / quads + 1));
    }
  }
}

TEST(Portions, AreScenesOfTheirOwnThatSampleTheSame) {
  for (const Whole& whole : wholes()) {
    PortionMaker maker(whole.assembly, whole.atlas, "test");
    const auto portions = plan_portions(whole.atlas, std::min<uint64_t>(300, whole.atlas.report.quads / 2));
    ASSERT_TRUE(portions.size() > 1 || whole.atlas.report.quads < least_portion);
    for (const std::vector<ChartPiece>& pieces : portions) {
      const Portion portion = maker.make(pieces, whole.positions);
      // A sample on the border of a rectangle may be of a triangle beyond.
      const bool whole_charts = std::all_of(pieces.begin(), pieces.end(), [&](const ChartPiece& piece) {
        const layout::ChartRecord& chart = whole.atlas.charts[piece.chart];
        return piece.width == chart.width && piece.height == chart.height;
      });
      if (const std::string fault = find_fault(portion.atlas); whole_charts || !fault.empty()) {
        ASSERT_EQ(fault, whole_charts ? "" : "a texel that samples nothing of its chart");
      }
      const scene::Assembly& local = portion.assembly;
      ASSERT_EQ(local.triangles.size(), portion.triangles.size());
      ASSERT_EQ(local.first_morph.size(), local.positions.size() + 1);
      ASSERT_EQ(local.first_influence.size(), local.positions.size() + 1);
      // Texels in the same order, and each of the same sample.
      size_t run = 0;
      for (uint32_t t = 0; t < portion.atlas.texel_map.size(); ++t) {
        while (run + 1 < portion.runs.size() && portion.runs[run + 1].local <= t) {
          ASSERT_LT(portion.runs[run].whole, portion.runs[run + 1].whole);
          ++run;
        }
        const glm::uvec4 own = portion.atlas.texel_map[t],
                         other =
                             whole.atlas.texel_map[portion.runs[run].whole + (t - portion.runs[run].local)];
        ASSERT_EQ(own.w == 0, other.w == 0);
        if (own.w == 0) continue;
        ASSERT_EQ(portion.triangles[own.x], other.x);
        ASSERT_EQ(glm::uvec2(own.y, own.z), glm::uvec2(other.y, other.z));
        // And charts of the same kind.
        ASSERT_EQ(portion.atlas.charts[own.w - 1].kind, whole.atlas.charts[other.w - 1].kind);
      }
      for (size_t t = 0; t < local.triangles.size(); ++t) {
        const glm::uvec4 own = local.triangles[t], other = whole.assembly.triangles[portion.triangles[t]];
        ASSERT_EQ(own.w, other.w);
        for (glm::length_t c = 0; c < 3; ++c) {
          const uint32_t v = own[c], w = other[c];
          ASSERT_EQ(local.positions[v], whole.assembly.positions[w]);
          ASSERT_EQ(local.normals[v], whole.assembly.normals[w]);
          ASSERT_EQ(local.texcoords[0][v], whole.assembly.texcoords[0][w]);
          ASSERT_EQ(local.texcoords[1][v], whole.assembly.texcoords[1][w]);
          ASSERT_EQ(local.colors[v], whole.assembly.colors[w]);
          ASSERT_EQ(local.first_morph[v + 1] - local.first_morph[v],
                    whole.assembly.first_morph[w + 1] - whole.assembly.first_morph[w]);
          for (uint32_t i = 0; i < local.first_morph[v + 1] - local.first_morph[v]; ++i) {
            const scene::MorphEntry &a = local.morphs[local.first_morph[v] + i],
                                    &b = whole.assembly.morphs[whole.assembly.first_morph[w] + i];
            ASSERT_EQ(a.weight, b.weight);
            ASSERT_EQ(a.position, b.position);
          }
          ASSERT_EQ(local.influences[local.first_influence[v]].matrix,
                    whole.assembly.influences[whole.assembly.first_influence[w]].matrix);
        }
      }
    }
  }
}

// A quad of a grid says by its place which triangle it is.
TEST(Portions, KeepTheTrianglesOfGridsInOrder) {
  const Whole whole(scene::make_builtin("terrain"), AtlasKind::automatic);
  PortionMaker maker(whole.assembly, whole.atlas, "test");
  for (const std::vector<ChartPiece>& pieces : plan_portions(whole.atlas, 700)) {
    const Portion portion = maker.make(pieces, whole.positions);
    for (size_t i = 0; i < pieces.size(); ++i) {
      const ChartPiece& piece = pieces[i];
      const layout::ChartRecord &own = portion.atlas.charts[i], &other = whole.atlas.charts[piece.chart];
      for (uint32_t y = 0; y + 1 < piece.height; ++y)
        for (uint32_t x = 0; x + 1 < piece.width; ++x)
          for (uint32_t half = 0; half < 2; ++half) {
            const uint32_t there =
                other.first_triangle + 2 * ((piece.y + y) * (other.width - 1) + piece.x + x) + half;
            ASSERT_EQ(portion.triangles[own.first_triangle + 2 * (y * (own.width - 1) + x) + half], there);
          }
    }
  }
}

TEST(Portions, LieWithinTheirBounds) {
  for (const Whole& whole : wholes()) {
    PortionMaker maker(whole.assembly, whole.atlas, "test");
    for (const std::vector<ChartPiece>& pieces : plan_portions(whole.atlas, 300)) {
      const scene::Bounds bounds = portion_bounds(whole.assembly, whole.atlas, pieces, whole.positions);
      const Portion portion = maker.make(pieces, whole.positions);
      ASSERT_FALSE(bounds.empty);
      scene::Bounds exact;
      for (const glm::uvec4& texel : portion.atlas.texel_map) {
        if (texel.w == 0) continue;
        for (glm::length_t c = 0; c < 3; ++c)
          exact.include(whole.positions[whole.assembly.triangles[portion.triangles[texel.x]][c]]);
      }
      EXPECT_EQ(bounds.lo, exact.lo);
      EXPECT_EQ(bounds.hi, exact.hi);
    }
  }
}

}  // namespace
}  // namespace lodestone::geometry_image
