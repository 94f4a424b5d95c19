// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/chart_maps.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "lodestone/base/error.h"
#include "lodestone/geometry_image/atlas_check.h"
#include "lodestone/geometry_image/atlas_file.h"
#include "meshes.h"
#include "sample_atlas.h"

namespace lodestone::geometry_image {
namespace {

Atlas curved_sheet(bool keep_maps) {
  scene::Mesh mesh = test::height_field(24, 20);
  mesh.grids.clear();
  for (glm::vec3& p : mesh.positions) p.z = 3 * std::sin(0.2f * p.x) * std::cos(0.15f * p.y);
  const scene::Scene scene = test::scene_of({mesh});
  AtlasSettings settings = AtlasKind::charts;
  settings.charts.texel_budget = 1000;
  settings.charts.keep_maps = keep_maps;
  return build_atlas(scene, scene::assemble(scene), settings);
}

TEST(ChartMaps, ChangeNothingElseOfTheAtlas) {
  Atlas with = curved_sheet(true);
  const Atlas without = curved_sheet(false);
  EXPECT_TRUE(without.maps.empty());
  EXPECT_EQ(without.maps.bytes(), 0u);
  ASSERT_FALSE(with.maps.empty());
  EXPECT_GT(with.maps.bytes(), 0u);
  with.maps = {};
  test::expect_equal(with, without);
}

// What the map says where a texel is is what the texel samples.
TEST(ChartMaps, AreThoseThatTheTexelsWereSampledBy) {
  const Atlas atlas = curved_sheet(true);
  const ChartMaps& maps = atlas.maps;
  uint64_t checked = 0, beside_the_lattice = 0;
  for (const uint32_t texel : inner_texels(atlas.charts).texels) {
    const layout::ChartRecord& chart = atlas.charts[atlas.texel_map[texel].w - 1];
    const uint32_t own = texel - chart.first_texel;
    const glm::vec2 at = maps.sites[texel].at;
    const glm::vec2 lattice(own % chart.width, own / chart.width);
    beside_the_lattice += glm::distance(at, lattice) > 1e-4f ? 1 : 0;
    const layout::MapFace& face = maps.faces[maps.sites[texel].face];
    const glm::vec2 a = maps.points[face.points[0]], b = maps.points[face.points[1]],
                    c = maps.points[face.points[2]];
    const glm::vec3 sides(layout::relax_side(at, b, c), layout::relax_side(at, c, a),
                          layout::relax_side(at, a, b));
    const glm::vec3 in_face = sides / (sides.x + sides.y + sides.z);
    glm::vec2 on_triangle(in_face.y, in_face.z);
    if (face.piece != layout::no_index) {
      const layout::MapPiece& piece = maps.pieces[face.piece];
      on_triangle =
          piece.corners[0] * in_face.x + piece.corners[1] * in_face.y + piece.corners[2] * in_face.z;
    }
    EXPECT_EQ(face.triangle, atlas.texel_map[texel].x);
    EXPECT_NEAR(on_triangle.x, std::bit_cast<float>(atlas.texel_map[texel].y), 2e-4f);
    EXPECT_NEAR(on_triangle.y, std::bit_cast<float>(atlas.texel_map[texel].z), 2e-4f);
    ++checked;
  }
  EXPECT_GT(checked, 300u);
  EXPECT_LT(100 * beside_the_lattice, checked) << "few, where quads were folded";
}

TEST(ChartMaps, NeverGiveTwoNeighboursOneColour) {
  const Atlas atlas = curved_sheet(true);
  const InnerTexels inner = inner_texels(atlas.charts);
  std::vector<uint32_t> color(atlas.texel_map.size(), InnerTexels::colors);
  for (uint32_t c = 0; c < InnerTexels::colors; ++c)
    for (uint32_t i = inner.first[c]; i < inner.first[c + 1]; ++i) color[inner.texels[i]] = c;
  for (const uint32_t texel : inner.texels) {
    const uint32_t width = atlas.charts[atlas.texel_map[texel].w - 1].width;
    for (uint32_t k = 0; k < layout::relax_neighbors; ++k)
      EXPECT_NE(color[layout::relax_neighbor(texel, width, k)], color[texel]) << texel << " " << k;
  }
  EXPECT_EQ(inner.first.back(), inner.texels.size());
}

TEST(ChartMaps, AreGivenBackByAFile) {
  const Atlas atlas = curved_sheet(true);
  const Atlas read = unpack_atlas("x.lode", pack_atlas(atlas, {""}), nullptr);
  test::expect_equal(read, atlas);
  for (size_t f = 0; f < atlas.maps.faces.size(); ++f) {
    EXPECT_EQ(read.maps.faces[f].points, atlas.maps.faces[f].points);
    EXPECT_EQ(read.maps.faces[f].beside, atlas.maps.faces[f].beside);
    EXPECT_EQ(read.maps.faces[f].triangle, atlas.maps.faces[f].triangle);
    EXPECT_EQ(read.maps.faces[f].piece, atlas.maps.faces[f].piece);
  }
}

TEST(ChartMaps, AreRefusedWhereTheirIndicesLeadAstray) {
  const Atlas good = curved_sheet(true);
  ASSERT_EQ(find_fault(good), "");
  ASSERT_FALSE(good.maps.pieces.empty()) << "or they are not tested";
  const uint32_t inner = inner_texels(good.charts).texels.front();
  const uint32_t face = good.maps.sites[inner].face;
  const auto refuse = [&](const auto& change, const std::string& because) {
    Atlas bad = good;
    change(bad.maps);
    EXPECT_EQ(find_fault(bad), because);
    EXPECT_THROW(unpack_atlas("x.lode", pack_atlas(bad, {""}), nullptr), Error);
  };
  const std::string face_fault = "a map with a face that is not as its neighbours say";
  refuse([&](ChartMaps& m) { m.faces[face].points[1] = static_cast<uint32_t>(m.points.size()); }, face_fault);
  refuse([&](ChartMaps& m) { m.faces[face].beside[0] = static_cast<uint32_t>(m.faces.size()); }, face_fault);
  refuse([&](ChartMaps& m) { m.faces[face].beside[0] = face; }, face_fault);
  refuse([&](ChartMaps& m) { m.faces[face].piece = static_cast<uint32_t>(m.pieces.size()); }, face_fault);
  refuse([&](ChartMaps& m) { m.faces.back().triangle = static_cast<uint32_t>(good.report.triangles); },
         face_fault);
  refuse([&](ChartMaps& m) { m.faces.clear(); }, "a texel in no face of its map");
  refuse([&](ChartMaps& m) { m.sites[inner].face = layout::no_index; }, "a texel in no face of its map");
  refuse([&](ChartMaps& m) { m.sites[inner].face = static_cast<uint32_t>(m.faces.size()); },
         "a texel in no face of its map");
  refuse([&](ChartMaps& m) { m.sites[0].face = face; }, "a texel in no face of its map");
  refuse([&](ChartMaps& m) { m.sites.pop_back(); }, "maps of another number of texels");
  refuse([&](ChartMaps& m) { m.sites.clear(); }, "maps of no texel");
  const std::string point_fault = "a map with a point outside its rectangle";
  for (const float bad : {-1.0f, 1e9f, std::nanf("")})
    refuse([&](ChartMaps& m) { m.points[0].x = bad; }, point_fault);
  for (const float bad : {-1.0f, 1e9f, std::nanf("")})
    refuse([&](ChartMaps& m) { m.sites[inner].at.y = bad; }, "a texel outside its rectangle");
  for (const float bad : {-0.5f, 1.5f, std::nanf("")})
    refuse([&](ChartMaps& m) { m.pieces[0].corners[2].y = bad; }, "a map with a piece outside its triangle");
}

TEST(ChartMaps, ArePartOfWhatAnAtlasIsNamedAfter) {
  const scene::Scene scene = test::sample_scene();
  const scene::Assembly assembly = scene::assemble(scene);
  AtlasSettings settings = AtlasKind::charts;
  const std::string without = atlas_hash(scene, assembly, settings);
  settings.charts.keep_maps = true;
  EXPECT_NE(atlas_hash(scene, assembly, settings), without);
}

}  // namespace
}  // namespace lodestone::geometry_image
