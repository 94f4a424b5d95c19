// SPDX-License-Identifier: MIT
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "lodestone/scene/height_field.h"
#include "scene_files.h"

namespace lodestone::scene::test {
namespace {

template <class T>
constexpr OIIO::TypeDesc::BASETYPE base_type = OIIO::BaseTypeFromC<T>::value;

class HeightMap : public testing::Test {
 protected:
  // An image of interleaved values in the format that the name's extension calls for.
  template <class T>
  std::filesystem::path write(const std::string& name, int width, int height, const std::vector<T>& values,
                              const std::string& compression = "") const {
    const std::filesystem::path path = folder_.path() / name;
    const auto output = OIIO::ImageOutput::create(path.string());
    const int channels = static_cast<int>(values.size()) / (width * height);
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc(base_type<T>));
    if (channels == 2) spec.alpha_channel = 1;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (!compression.empty()) spec.attribute("compression", compression);
    EXPECT_TRUE(output->open(path.string(), spec));
    EXPECT_TRUE(output->write_image(OIIO::TypeDesc(base_type<T>), values.data()));
    EXPECT_TRUE(output->close());
    return path;
  }

  // Heights of the samples, row by row from the far side as the image has them, for a scale of 1.
  static std::vector<float> heights(const std::filesystem::path& path) {
    LoadOptions options;
    options.height_scale = 1;
    const Scene scene = load_height_map(path, options);
    validate(scene);
    const Mesh& mesh = scene.meshes.at(0);
    std::vector<float> found(mesh.positions.size());
    const float left = mesh.positions[0].x, far = mesh.positions.back().z;
    const auto width = static_cast<size_t>(1 - 2 * left);
    for (const glm::vec3& p : mesh.positions) {
      found.at(static_cast<size_t>(p.z - far) * width + static_cast<size_t>(p.x - left)) = p.y;
    }
    return found;
  }

  TemporaryFolder folder_;
};

TEST_F(HeightMap, SamplesLieOneUnitApartAroundTheOriginAsInTheImage) {
  const Mesh mesh = load_mesh(write<uint16_t>("m.png", 3, 2, {0, 1, 2, 65535, 3, 4}));
  ASSERT_EQ(mesh.positions.size(), 6u);
  // The near row first: that is the image's lower one. The height is a quarter of the larger side, which
  // is 2.
  EXPECT_EQ(mesh.positions[0], glm::vec3(-1, 0.5f, 0.5f));
  EXPECT_EQ(mesh.positions[2], glm::vec3(1, 0.5f * (4 / 65535.0f), 0.5f));
  EXPECT_EQ(mesh.positions[3], glm::vec3(-1, 0, -0.5f));
  EXPECT_EQ(mesh.positions[5], glm::vec3(1, 0.5f * (2 / 65535.0f), -0.5f));
  EXPECT_EQ(mesh.texcoords[0][0], glm::vec2(0, 1));
  EXPECT_EQ(mesh.texcoords[0][4], glm::vec2(0.5f, 0));
  EXPECT_EQ(mesh.name, "m");
}

TEST_F(HeightMap, TheScaleIsTheHeightOfTheBrightestSample) {
  LoadOptions options;
  options.height_scale = 12;
  const Scene scene = load_height_map(write<uint8_t>("m.png", 2, 2, {0, 255, 51, 102}), options);
  const std::vector<glm::vec3>& positions = scene.meshes.at(0).positions;
  EXPECT_FLOAT_EQ(positions[0].y, 2.4f);
  EXPECT_FLOAT_EQ(positions[1].y, 4.8f);
  EXPECT_FLOAT_EQ(positions[3].y, 12);
}

TEST_F(HeightMap, EveryGreyFormatIsRead) {
  EXPECT_EQ(heights(write<uint8_t>("a.png", 2, 2, {0, 51, 102, 255})),
            (std::vector<float>{0, 51 / 255.f, 102 / 255.f, 1}));
  EXPECT_EQ(heights(write<uint16_t>("b.png", 2, 2, {0, 1, 256, 65535})),
            (std::vector<float>{0, 1 / 65535.f, 256 / 65535.f, 1}));
  const std::vector<float> values{-0.5f, 0.1f, 1e-3f, 7.25f};
  EXPECT_EQ(heights(write<float>("c.exr", 2, 2, values)), values);
  EXPECT_EQ(heights(write<float>("d.tif", 2, 2, values)), values);
  EXPECT_EQ(heights(write<uint16_t>("e.tif", 2, 2, {0, 1, 2, 65535})),
            (std::vector<float>{0, 1 / 65535.f, 2 / 65535.f, 1}));
}

TEST_F(HeightMap, EqualColourChannelsAreOneGrey) {
  EXPECT_EQ(heights(write<float>("m.exr", 2, 2, {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4})),
            (std::vector<float>{1, 2, 3, 4}));
}

TEST_F(HeightMap, AlphaIsPassedOverAndNotMultipliedIn) {
  EXPECT_EQ(heights(write<uint8_t>("m.png", 2, 2, {255, 0, 51, 128, 0, 255, 102, 1})),
            (std::vector<float>{1, 51 / 255.f, 0, 102 / 255.f}));
}

TEST_F(HeightMap, NormalsAreCentralDifferencesAndOneSidedAtTheBorder) {
  // h = x^2 + 3 row, with x and rows counted from the upper left.
  std::vector<float> values;
  for (int row = 0; row < 3; ++row) {
    for (int x = 0; x < 4; ++x) values.push_back(static_cast<float>(x * x + 3 * row));
  }
  const Mesh mesh = make_height_field(4, 3, values);
  const float slopes[] = {1, 2, 4, 5};  // 1 - 0, (4 - 0) / 2, (9 - 1) / 2, 9 - 4
  for (size_t v = 0; v < 12; ++v) {
    EXPECT_TRUE(near(mesh.normals[v], glm::normalize(glm::vec3(-slopes[v % 4], 1, -3)))) << v;
  }
}

TEST_F(HeightMap, HeightsNearTheLargestFloatHaveFiniteNormals) {
  const float most = std::numeric_limits<float>::max();
  const Mesh mesh = make_height_field(2, 2, std::vector<float>{-most, most, most, -most});
  for (const glm::vec3& n : mesh.normals) EXPECT_NEAR(glm::length(n), 1, 1e-6f);
}

// Every grid follows the rule of scene.h, and the grids' quads cover the map once.
void expect_grids(uint32_t width, uint32_t height, size_t grids) {
  const Mesh mesh = make_height_field(width, height, std::vector<float>(size_t(width) * height));
  ASSERT_EQ(mesh.grids.size(), grids);
  ASSERT_EQ(mesh.triangles.size(), 2 * size_t(width - 1) * (height - 1));
  std::vector<int> covered(size_t(width) * height);
  uint32_t next_triangle = 0;
  for (const Grid& grid : mesh.grids) {
    ASSERT_EQ(grid.first_triangle, next_triangle);
    ASSERT_GE(std::min(grid.width, grid.height), 2u);
    ASSERT_LE(std::max(grid.width, grid.height), max_grid_side);
    ASSERT_EQ(grid.vertices.size(), size_t(grid.width) * grid.height);
    for (uint32_t y = 0; y + 1 < grid.height; ++y) {
      for (uint32_t x = 0; x + 1 < grid.width; ++x) {
        const uint32_t a = grid.vertices[y * grid.width + x], b = grid.vertices[y * grid.width + x + 1];
        const uint32_t c = grid.vertices[(y + 1) * grid.width + x],
                       d = grid.vertices[(y + 1) * grid.width + x + 1];
        ASSERT_EQ(mesh.triangles[next_triangle], glm::uvec3(a, b, c));
        ASSERT_EQ(mesh.triangles[next_triangle + 1], glm::uvec3(d, c, b));
        const glm::vec3 up =
            glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        ASSERT_EQ(up, glm::vec3(0, 1, 0));
        ASSERT_EQ(mesh.positions[d] - mesh.positions[a], glm::vec3(1, 0, -1));
        ++covered[a];
        next_triangle += 2;
      }
    }
  }
  EXPECT_EQ(next_triangle, mesh.triangles.size());
  for (uint32_t v = 0; v < covered.size(); ++v) {
    ASSERT_EQ(covered[v], v % width < width - 1 && v / width < height - 1 ? 1 : 0);
  }
}

TEST(HeightField, SmallMapsAreOneGrid) {
  expect_grids(2, 2, 1);
  expect_grids(257, 257, 1);
  expect_grids(3, 200, 1);
}

TEST(HeightField, LargeMapsAreGridsThatShareTheirBorders) {
  expect_grids(258, 2, 2);
  expect_grids(600, 300, 6);
  expect_grids(513, 514, 6);
}

TEST_F(HeightMap, ColourIsRefusedWithThePlace) {
  EXPECT_EQ(bad_input_message(write<uint8_t>("m.png", 2, 2, {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 5, 4})),
            "column 1, row 1: red, green and blue differ; a height map is grey, convert it");
}

TEST_F(HeightMap, HeightsThatAreNotFiniteAreRefusedWithThePlace) {
  for (const float hole : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const std::string message = bad_input_message(write<float>("m.exr", 2, 2, {1, 2, hole, 3}));
    EXPECT_TRUE(message.starts_with("column 0, row 1: ")) << message;
  }
}

TEST_F(HeightMap, ASingleRowIsRefused) {
  EXPECT_TRUE(
      bad_input_message(write<uint8_t>("m.png", 5, 1, {1, 2, 3, 4, 5})).starts_with("has 5 x 1 samples"));
}

TEST_F(HeightMap, OtherImagesAreRefused) {
  EXPECT_TRUE(bad_input_message(folder_.write("m.png", "GIF89a")).starts_with("byte 0: is neither"));
  EXPECT_TRUE(bad_input_message(folder_.write("m.exr", "")).starts_with("is empty"));
  EXPECT_TRUE(
      bad_input_message(write<float>("m.tif", 2, 2, std::vector<float>(20))).starts_with("has 5 channels"));
}

TEST_F(HeightMap, AScaleThatIsNoHeightIsWrongUsage) {
  const std::filesystem::path path = write<uint8_t>("m.png", 2, 2, {1, 2, 3, 4});
  for (const float scale :
       {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    LoadOptions options;
    options.height_scale = scale;
    try {
      load_height_map(path, options);
      ADD_FAILURE() << scale;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage);
    }
  }
}

TEST_F(HeightMap, HeightsThatTheScaleMakesInfiniteAreRefused) {
  LoadOptions options;
  options.height_scale = 1e30f;
  EXPECT_THROW(load_height_map(write<float>("m.exr", 2, 2, {0, 0, 0, 1e30f}), options), Error);
}

}  // namespace
}  // namespace lodestone::scene::test
