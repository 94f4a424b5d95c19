// SPDX-License-Identifier: MIT
// The real meshes and height maps that the project is tested with, against the counts of their README. They
// are not part of the repository: LODESTONE_DATA names their folder.
#include <array>
#include <cstdlib>
#include <set>
#include <string>
#include <tuple>

#include "scene_files.h"

namespace lodestone::scene::test {
namespace {

std::filesystem::path data_folder() {
  const char* folder = std::getenv("LODESTONE_DATA");
  return folder != nullptr ? folder : std::filesystem::path(LODESTONE_SOURCE_DIR) / ".." / "shared" / "data";
}

struct DataFile {
  const char* name;
  size_t triangles;
  size_t positions;  // different ones
  bool has_texcoords, has_colors;
};

void PrintTo(const DataFile& file, std::ostream* stream) {
  *stream << file.name;
}

size_t count_positions(const Mesh& mesh) {
  std::set<std::tuple<float, float, float>> found;
  for (const glm::vec3& p : mesh.positions) found.emplace(p.x, p.y, p.z);
  return found.size();
}

class DataFiles : public testing::TestWithParam<DataFile> {};

TEST_P(DataFiles, HaveTheCountsOfTheirReadme) {
  const std::filesystem::path path = data_folder() / GetParam().name;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there; set LODESTONE_DATA";
  const Mesh mesh = load_mesh(path);
  EXPECT_EQ(mesh.triangles.size(), GetParam().triangles);
  EXPECT_EQ(count_positions(mesh), GetParam().positions);
  EXPECT_EQ(!mesh.texcoords[0].empty(), GetParam().has_texcoords);
  EXPECT_EQ(!mesh.colors.empty(), GetParam().has_colors);
  EXPECT_EQ(mesh.name, path.stem().string());
}

INSTANTIATE_TEST_SUITE_P(Meshes, DataFiles,
                         testing::Values(DataFile{"spot_control_mesh.obj", 372, 188, true, false},
                                         DataFile{"spot.obj", 5856, 2930, true, false},
                                         DataFile{"quadknot.obj", 2880, 1440, true, true},
                                         // 1,113 of its 35,947 vertices are in no face.
                                         DataFile{"stanford_bunny.obj", 69451, 35947 - 1113, false, false},
                                         DataFile{"armadillo.obj", 86482, 43243, false, false},
                                         DataFile{"stanford_dragon.ply", 871414, 435545, false, false},
                                         DataFile{"cycloidal_gear.ply", 43368, 21384, false, true},
                                         DataFile{"counter_assembly.stl", 83750, 41837, false, false}));

struct DataMap {
  const char* name;
  uint32_t side;
  size_t grids;
  float lowest, highest;  // of the values, 0 to 1
};

void PrintTo(const DataMap& map, std::ostream* stream) {
  *stream << map.name;
}

class DataMaps : public testing::TestWithParam<DataMap> {};

TEST_P(DataMaps, HaveTheSizeAndRangeOfTheirReadme) {
  const std::filesystem::path path = data_folder() / GetParam().name;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there; set LODESTONE_DATA";
  LoadOptions options;
  options.height_scale = 1;
  const Scene scene = load_height_map(path, options);
  validate(scene);
  const Mesh& mesh = scene.meshes.at(0);
  const size_t side = GetParam().side;
  EXPECT_EQ(mesh.positions.size(), side * side);
  EXPECT_EQ(mesh.triangles.size(), 2 * (side - 1) * (side - 1));
  EXPECT_EQ(mesh.grids.size(), GetParam().grids);
  float lowest = mesh.positions[0].y, highest = lowest;
  for (const glm::vec3& p : mesh.positions) {
    lowest = std::min(lowest, p.y);
    highest = std::max(highest, p.y);
  }
  EXPECT_EQ(lowest, GetParam().lowest);
  EXPECT_EQ(highest, GetParam().highest);
}

INSTANTIATE_TEST_SUITE_P(
    Maps, DataMaps,
    testing::Values(DataMap{"fuji_dem_512_r16.png", 512, 4, 137 / 65535.0f, 37510 / 65535.0f},
                    DataMap{"canyon_height_8bit.png", 4096, 256, 44 / 255.0f, 69 / 255.0f}));

TEST(DataImages, OfLightAndColourAreNoHeightMaps) {
  for (const char* name : {"env_courtyard.exr", "spot_texture.png"}) {
    const std::filesystem::path path = data_folder() / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there; set LODESTONE_DATA";
    EXPECT_NE(bad_input_message(path).find("red, green and blue differ"), std::string::npos);
  }
}

}  // namespace
}  // namespace lodestone::scene::test
