// SPDX-License-Identifier: MIT
#include "lodestone/geometry_image/atlas_file.h"

#include <cstring>
#include <limits>

#include "expect_error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/hash.h"
#include "lodestone/geometry_image/atlas_check.h"
#include "sample_atlas.h"

namespace lodestone::geometry_image {
namespace {

using test::atlas_of;
using test::expect_equal;
using test::expect_error;
using test::height_field;
using test::random_mesh;
using test::sample_atlas;
using test::sample_scene;

using Bytes = std::vector<std::byte>;

constexpr size_t checksum_bytes = 32;

// Puts the right checksum under changed content: what a hostile file would have.
void sign(Bytes& file) {
  ContentHash hash;
  hash.add(std::span(file).first(file.size() - checksum_bytes));
  std::memcpy(&file[file.size() - checksum_bytes], hash.hex().data(), checksum_bytes);
}

// The atlas, or nothing where it is refused as it should be; any other exception fails the test.
std::optional<Atlas> unpack(const Bytes& file) {
  try {
    return unpack_atlas("x.lode", file, nullptr);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    EXPECT_TRUE(std::string(error.what()).starts_with("x.lode: ")) << error.what();
    return std::nullopt;
  }
}

class AtlasFile : public test::FolderTest {};

TEST_F(AtlasFile, GivesBackWhatWasSaved) {
  const std::filesystem::path file = folder() / "new" / "atlas.lode";
  for (const Atlas& atlas :
       {sample_atlas(), atlas_of(sample_scene()), atlas_of(height_field(2, 2)),
        atlas_of(random_mesh(4, 5000, 30000), AtlasKind::exact), atlas_of(height_field(700, 300))}) {
    save_atlas(file, atlas, {"the hash", "below/scene.obj", 0.25f, AtlasKind::exact});
    BakeRecord record;
    expect_equal(load_atlas(file, &record), atlas);
    EXPECT_EQ(record.content_hash, "the hash");
    EXPECT_EQ(record.scene, "below/scene.obj");
    EXPECT_EQ(record.height_scale, 0.25f);
    EXPECT_EQ(record.asked, AtlasKind::exact);
  }
  EXPECT_FALSE(sample_atlas().report.notes.empty()) << "or they were not tested";
}

TEST_F(AtlasFile, IsSmall) {
  const Atlas grid = atlas_of(height_field(1000, 1000));
  EXPECT_LT(pack_atlas(grid, {""}).size(), 200'000u);  // of 24 million bytes
}

TEST_F(AtlasFile, IsRefusedWhereItIsMissingOrSomethingElse) {
  expect_error([&] { load_atlas(folder() / "none.lode"); }, ExitCode::bad_input,
               (folder() / "none.lode").string(), "no such file");
  write_file(folder() / "a.lode",
             std::string("This is a text about lodestones, long enough to be an atlas, perhaps."));
  expect_error([&] { load_atlas(folder() / "a.lode"); }, ExitCode::bad_input, (folder() / "a.lode").string(),
               "is not a baked file");
  write_file(folder() / "empty.lode", std::string());
  expect_error([&] { load_atlas(folder() / "empty.lode"); }, ExitCode::bad_input,
               (folder() / "empty.lode").string(), "is not a baked file");
}

TEST_F(AtlasFile, IsRefusedByTheVersionThatItNames) {
  Bytes file = pack_atlas(sample_atlas(), {"hash"});
  file[8] = std::byte(8);
  sign(file);
  expect_error([&] { unpack_atlas("x.lode", file, nullptr); }, ExitCode::bad_input, "x.lode",
               "is a baked file of version 8");
  for (int older = 1; older < 7; ++older) {
    file[8] = std::byte(older);
    sign(file);
    expect_error([&] { unpack_atlas("x.lode", file, nullptr); }, ExitCode::bad_input, "x.lode",
                 "bake it again");
  }
  file[8] = std::byte(7);
  file[12] = std::byte(2);
  sign(file);
  expect_error([&] { unpack_atlas("x.lode", file, nullptr); }, ExitCode::bad_input, "x.lode",
               "holds no geometry images");
}

TEST_F(AtlasFile, IsRefusedWithAnyBitChanged) {
  const Bytes good = pack_atlas(sample_atlas(), {"hash"});
  ASSERT_TRUE(unpack(good));
  for (size_t i = 0; i < good.size(); ++i) {
    for (const int bit : {0, 3, 7}) {
      Bytes bad = good;
      bad[i] ^= std::byte(1 << bit);
      EXPECT_FALSE(unpack(bad)) << "byte " << i << ", bit " << bit;
    }
  }
}

TEST_F(AtlasFile, IsRefusedAtAnyOtherLength) {
  const Bytes good = pack_atlas(sample_atlas(), {"hash"});
  for (size_t length = 0; length < good.size(); ++length) {
    Bytes bad(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_FALSE(unpack(bad)) << length;
    if (length < 2 * checksum_bytes) continue;
    sign(bad);
    EXPECT_FALSE(unpack(bad)) << length << ", signed";
  }
  Bytes longer = good;
  longer.insert(longer.end() - checksum_bytes, 3, std::byte(0));
  sign(longer);
  EXPECT_FALSE(unpack(longer));
}

// A checksum keeps out damage, not malice.
TEST_F(AtlasFile, IsHarmlessWhereAForgerSignedTheChange) {
  Atlas atlas_without_notes = sample_atlas();
  atlas_without_notes.report.notes.clear();
  const Bytes good = pack_atlas(atlas_without_notes, {""});
  size_t refused = 0, taken = 0;
  for (size_t i = 0; i + checksum_bytes < good.size(); ++i) {
    for (const int change : {0x01, 0x80, 0xff, 0x10}) {
      Bytes bad = good;
      bad[i] ^= std::byte(change);
      sign(bad);
      const std::optional<Atlas> atlas = unpack(bad);
      ++(atlas ? taken : refused);
      EXPECT_EQ(atlas ? find_fault(*atlas) : "", "") << "byte " << i;
    }
  }
  EXPECT_GT(refused, 2 * taken) << "nothing but counts of faults can be changed unseen";
}

// Changes the atlas itself, so that the file is well made and what it says is wrong.
TEST_F(AtlasFile, IsRefusedWhereItsIndicesLeadAstray) {
  const Atlas good = sample_atlas();
  const auto refuse = [&](const auto& change, const std::string& because) {
    Atlas bad = good;
    change(bad);
    expect_error([&] { unpack_atlas("x.lode", pack_atlas(bad, {""}), nullptr); }, ExitCode::bad_input,
                 "x.lode", because);
  };
  ASSERT_EQ(find_fault(good), "");
  ASSERT_EQ(good.charts.size(), 3u);
  refuse([](Atlas& a) { a.charts.clear(); }, "no chart");
  refuse([](Atlas& a) { a.kind = AtlasKind(9); }, "charts of another kind");
  refuse([](Atlas& a) { a.kind = AtlasKind::grid; }, "charts of another kind");
  refuse([](Atlas& a) { ++a.objects[0].depth; }, "wrong depth");
  refuse([](Atlas& a) { a.charts[1].kind = 7; }, "unknown kind");
  refuse([](Atlas& a) { a.charts[0].width = 0; }, "without a quad");
  refuse([](Atlas& a) { a.charts[0].width = a.charts[0].height = 0xffffffffu; }, "do not follow");
  refuse([](Atlas& a) { a.charts[1].width = 4; }, "not of 3 x 3");
  refuse([](Atlas& a) { a.charts[1].first_texel += 1; }, "do not follow");
  refuse([](Atlas& a) { a.charts.pop_back(); }, "texels of no chart");
  refuse([](Atlas& a) { a.charts[2].first_triangle = 15; }, "triangles that do not exist");
  refuse([](Atlas& a) { a.report.triangles = 13; }, "triangles that do not exist");
  refuse([](Atlas& a) { a.charts[1].first_slot += 1; }, "block is not its own");
  refuse([](Atlas& a) { a.charts[1].slot_count = 2; }, "block is not its own");
  refuse([](Atlas& a) { a.charts[1].slot_count = 5; }, "block is not its own");
  refuse([](Atlas& a) { a.charts[1].slot_count = 0; }, "block is not its own");
  refuse([](Atlas& a) { a.charts[1].slot_count = 16; }, "leaves of no chart");
  refuse([](Atlas& a) { a.charts[1].first_slot = 1u << 30; }, "outside the hierarchy");
  refuse([](Atlas& a) { a.charts[1].first_slot = a.charts[2].first_slot; }, "a leaf that is not");
  refuse([](Atlas& a) { a.texel_map[3].x = 12; }, "samples nothing");
  refuse([](Atlas& a) { a.texel_map[3].y = 0x7fc00000u; }, "samples nothing");
  refuse([](Atlas& a) { a.texel_map[3].z = 0xbf800000u; }, "samples nothing");
  refuse([](Atlas& a) { a.texel_map[3].w = 2; }, "samples nothing");
  refuse([](Atlas& a) { a.texel_map[3] = glm::uvec4(0); }, "a leaf that is not");
  refuse([](Atlas& a) { a.leaf_map[0].x = 1u << 20; }, "a leaf that is not");
  refuse([](Atlas& a) { ++a.leaf_map[0].y; }, "a leaf that is not");
  refuse([](Atlas& a) { a.leaf_map[0] = {layout::empty_slot, 0}; }, "a leaf that is not");
  refuse([](Atlas& a) { ++a.report.quads; }, "another number of quads");
  refuse([](Atlas& a) { a.report.texels = 3; }, "report of another atlas");
  refuse([](Atlas& a) { a.report.notes.assign(65, "x"); }, "too many notes");
  refuse([](Atlas& a) { a.report.notes = {std::string(5000, 'x')}; }, "too long");
  refuse([](Atlas& a) { a.report.notes = {"\x1b[2J"}; }, "no text");
}

TEST_F(AtlasFile, IsRefusedWhereItsMappedChartsLeadAstray) {
  Atlas good = sample_atlas();
  ASSERT_EQ(good.charts[0].kind, layout::chart_grid);
  good.charts[0].kind = layout::chart_mapped;
  good.texel_map[3].x = good.texel_map.back().x;  // of another mesh
  good.kind = AtlasKind::automatic;
  EXPECT_EQ(find_fault(good), "");
  expect_equal(unpack_atlas("x.lode", pack_atlas(good, {""}), nullptr), good);
  const auto fault = [&](const auto& change) {
    Atlas bad = good;
    change(bad);
    return find_fault(bad);
  };
  EXPECT_EQ(fault([](Atlas& a) { a.charts[0].kind = 3; }), "a chart of an unknown kind");
  EXPECT_EQ(fault([](Atlas& a) { a.charts[0].first_triangle = 1; }),
            "a mapped chart with a triangle of its own");
  const std::string no_sample = "a texel that samples nothing of its chart";
  const auto triangles = static_cast<uint32_t>(good.report.triangles);
  EXPECT_EQ(fault([&](Atlas& a) { a.texel_map[3].x = triangles - 1; }), "");
  EXPECT_EQ(fault([&](Atlas& a) { a.texel_map[3].x = triangles; }), no_sample);
  EXPECT_EQ(fault([](Atlas& a) { a.texel_map[3].z = 0x40000000u; }), no_sample);
  EXPECT_EQ(fault([](Atlas& a) { a.texel_map[3].w = 2; }), no_sample);
  EXPECT_EQ(fault([](Atlas& a) { a.texel_map[3] = glm::uvec4(0); }), no_sample);
  EXPECT_EQ(fault([](Atlas& a) { a.kind = AtlasKind::grid; }), "charts of another kind than it says");
  EXPECT_EQ(fault([](Atlas& a) { a.kind = AtlasKind::exact; }), "charts of another kind than it says");
}

TEST_F(AtlasFile, IsRefusedWhereItsRecordIsNone) {
  const Atlas atlas = sample_atlas();
  const auto refuse = [&](const BakeRecord& record, const std::string& because) {
    expect_error([&] { unpack_atlas("x.lode", pack_atlas(atlas, record), nullptr); }, ExitCode::bad_input,
                 "x.lode", because);
  };
  refuse({"", std::string(5000, 'x')}, "too long");
  refuse({"", "a.png", -1}, "height scale");
  refuse({"", "a.png", std::numeric_limits<float>::infinity()}, "height scale");
  refuse({"", "a.png", std::numeric_limits<float>::quiet_NaN()}, "height scale");
  refuse({"", "a.png", 0, AtlasKind(4)}, "unknown kind");
}

// Whatever sizes a file claims, memory follows the data that are there.
TEST_F(AtlasFile, AllocatesNoMoreThanItHolds) {
  Bytes file = pack_atlas(sample_atlas(), {""});
  constexpr size_t counts_at =
      8 + 4 + 4 + (4 + 4 + 4 + 4 + 4 + 8 + 4 + 4 + 4) + 4;  // magic, version, content, empty record, kind
  for (size_t which = 0; which < 8; ++which) {
    for (const uint64_t count :
         {uint64_t(1) << 28, (uint64_t(1) << 31) - 1, uint64_t(1) << 60, ~uint64_t(0)}) {
      Bytes bad = file;
      std::memcpy(&bad[counts_at + 8 * which], &count, 8);
      sign(bad);
      EXPECT_FALSE(unpack(bad));
    }
  }
}

}  // namespace
}  // namespace lodestone::geometry_image
