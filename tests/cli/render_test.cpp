// SPDX-License-Identifier: MIT
// What is in the pictures.
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "lodestone/image/image.h"
#include "process.h"

namespace lodestone::cli {
namespace {

// Every sample of every channel, and the channels' names.
void expect_equal_pixels(const image::Image& a, const image::Image& b) {
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (size_t i = 0; i < a.channels.size(); ++i) {
    EXPECT_EQ(a.channels[i].name, b.channels[i].name);
    EXPECT_TRUE(a.channels[i].ids == b.channels[i].ids) << a.channels[i].name;
    EXPECT_TRUE(a.channels[i].values == b.channels[i].values) << a.channels[i].name;
  }
}

bool equal_beauty(const image::Image& a, const image::Image& b) {
  return a.find("R")->values == b.find("R")->values;
}

class Render : public CommandLine {
 protected:
  // Renders to an .exr of this name.
  image::Image render(const std::string& name, const std::vector<std::string>& more = {}) const {
    const Result result = run(tiny_render(place(name), more));
    EXPECT_EQ(result.code, 0) << result.err;
    return image::read(place(name));
  }
};

const std::vector<std::string> every_aov = {"--aov", "depth,normal,albedo,uv,id,lod,steps", "--spp", "3"};

TEST_F(Render, GivesTheChannelsOfTheContract) {
  const image::Image image = render("x.exr", every_aov);
  EXPECT_EQ(image.width, 24u);
  EXPECT_EQ(image.height, 16u);
  for (const char* name : {"R", "G", "B", "A", "depth.Z", "normal.X", "normal.Y", "normal.Z", "albedo.R",
                           "albedo.G", "albedo.B", "uv.U", "uv.V", "lod.L", "steps.N"}) {
    ASSERT_NE(image.find(name), nullptr) << name;
    EXPECT_EQ(image.find(name)->values.size(), image.pixels()) << name;
  }
  for (const char* name : {"id.mesh", "id.triangle"}) {
    ASSERT_NE(image.find(name), nullptr) << name;
    EXPECT_EQ(image.find(name)->ids.size(), image.pixels()) << name;
  }
  EXPECT_EQ(image.channels.size(), 17u);
}

TEST_F(Render, SaysThatAPictureWasDenoisedAndKeepsItAsItWas) {
  const std::vector<std::string> path = {"--integrator", "path", "--spp", "4"};
  std::vector<std::string> denoised = path;
  denoised.insert(denoised.end(), {"--denoise", "--aov", "noisy", "--stats", place("s.json")});
  const image::Image before = render("a.exr", path), after = render("b.exr", denoised);
  EXPECT_TRUE(after.find("noisy.G")->values == before.find("G")->values);
  EXPECT_TRUE(after.find("A")->values == before.find("A")->values);
  EXPECT_FALSE(equal_beauty(before, after));
  const std::string how = after.metadata.at("lodestone:denoise");
  EXPECT_NE(how.find("a-trous"), std::string::npos);
  EXPECT_NE(how.find("blurs"), std::string::npos);
  EXPECT_EQ(before.metadata.count("lodestone:denoise"), 0u);
  const auto statistics = nlohmann::json::parse(read_text(place("s.json")));
  EXPECT_EQ(statistics["image"]["denoise"], how);
}

TEST_F(Render, SeesTheSceneAndWhatIsBesideIt) {
  const image::Image image = render("x.exr", every_aov);
  uint64_t hits = 0, misses = 0;
  for (size_t i = 0; i < image.pixels(); ++i) {
    const bool miss = image.find("id.mesh")->ids[i] == 0xffffffffu;
    EXPECT_EQ(miss, std::isinf(image.find("depth.Z")->values[i])) << i;
    ++(miss ? misses : hits);
  }
  EXPECT_GT(hits, 20u);
  EXPECT_GT(misses, 20u);
}

TEST_F(Render, TwoRunsGiveEqualPixels) {
  expect_equal_pixels(render("a.exr", every_aov), render("b.exr", every_aov));
}

TEST_F(Render, TheNumberOfThreadsChangesNothing) {
  std::vector<std::string> one = every_aov, two = every_aov;
  one.insert(one.end(), {"--threads", "1"});
  two.insert(two.end(), {"--threads", "2"});
  expect_equal_pixels(render("a.exr", one), render("b.exr", two));
}

TEST_F(Render, EveryTraversalGivesEqualPictures) {
  const image::Image threaded = render("a.exr", {"--traversal", "threaded", "--aov", "depth,id"});
  expect_equal_pixels(threaded, render("b.exr", {"--traversal", "octant", "--aov", "depth,id"}));
  expect_equal_pixels(threaded, render("c.exr", {"--traversal", "wide", "--aov", "depth,id"}));
}

TEST_F(Render, TheSeedMovesTheSamples) {
  EXPECT_FALSE(equal_beauty(render("a.exr", {"--spp", "2", "--seed", "1"}),
                            render("b.exr", {"--spp", "2", "--seed", "2"})));
}

TEST_F(Render, TheClipMovesTheSceneAndLoops) {
  const image::Image start = render("a.exr"), middle = render("b.exr", {"--frames", "12"}),
                     looped = render("c.exr", {"--frames", "36"});
  EXPECT_FALSE(equal_beauty(start, middle));
  EXPECT_TRUE(equal_beauty(middle, looped));
  EXPECT_EQ(looped.metadata.at("lodestone:time"), "0.5");
  EXPECT_TRUE(equal_beauty(middle, render("d.exr", {"--time", "0.5"})));
  EXPECT_TRUE(equal_beauty(middle, render("e.exr", {"--frames", "5", "--fps", "10"})));
}

TEST_F(Render, WeightsOverrideTheClip) {
  EXPECT_TRUE(equal_beauty(render("a.exr", {"--time", "0.5"}), render("b.exr", {"--weights", "fold=0.5"})));
}

TEST_F(Render, TheCameraCanStandAnywhere) {
  const image::Image front = render("a.exr", {"--camera-from", "0,0,3", "--camera-at", "0,0,0"});
  EXPECT_FALSE(equal_beauty(front, render("b.exr", {"--camera-from", "0,0,-3", "--camera-at", "0,0,0"})));
  EXPECT_FALSE(equal_beauty(front, render("c.exr", {"--orbit", "0,0", "--fov", "20"})));
}

TEST_F(Render, TheCameraCanBeChosen) {
  EXPECT_TRUE(equal_beauty(render("a.exr"), render("b.exr", {"--camera", "Front"})));
  EXPECT_FALSE(equal_beauty(render("c.exr"), render("d.exr", {"--camera", "auto"})));
}

TEST_F(Render, TheAutomaticCameraSeesAllThatWeightsMove) {
  const image::Image image = render("x.exr", {"--camera", "auto", "--weights", "fold=9", "--aov", "id"});
  const std::vector<uint32_t>& mesh = image.find("id.mesh")->ids;
  uint64_t hits = 0;
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      const bool border = x == 0 || y == 0 || x + 1 == image.width || y + 1 == image.height;
      const bool hit = mesh[size_t(y) * image.width + x] != 0xffffffffu;
      EXPECT_FALSE(border && hit) << x << ", " << y;
      hits += hit;
    }
  }
  EXPECT_GT(hits, 10u);
}

TEST_F(Render, SaysInTheFileHowItWasMade) {
  const auto metadata = render("x.exr", {"--frames", "6", "--seed", "9", "--spp", "2"}).metadata;
  const std::map<std::string, std::string> expected = {{"scene", "builtin:tiny"},
                                                       {"tracer", "geometry-image"},
                                                       {"traversal", "wide"},
                                                       {"seed", "9"},
                                                       {"spp", "2"},
                                                       {"frame", "6"},
                                                       {"time", "0.25"},
                                                       {"camera", "Front"},
                                                       {"clip", "Fold"}};
  for (const auto& [name, value] : expected) EXPECT_EQ(metadata.at("lodestone:" + name), value) << name;
  for (const char* name : {"version", "commit", "device", "driver"})
    EXPECT_NE(metadata.at(std::string("lodestone:") + name), "");
  const auto times = nlohmann::json::parse(metadata.at("lodestone:pass_ms"));
  EXPECT_TRUE(times.contains("blend"));
  EXPECT_GE(times["blend"].get<double>(), 0);
}

// The four rows of a matrix, or less where the text is none.
std::vector<double> numbers_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<double>(stream), {}};
}

// Where row vectors go that a matrix of an EXR multiplies, after division by w.
std::array<double, 3> projected(const std::array<double, 3>& p, const std::array<float, 16>& m) {
  std::array<double, 4> q{};
  for (size_t c = 0; c < 4; ++c) q[c] = p[0] * m[c] + p[1] * m[4 + c] + p[2] * m[8 + c] + m[12 + c];
  return {q[0] / q[3], q[1] / q[3], q[2] / q[3]};
}

TEST_F(Render, SaysInTheFileWhereItsPixelsAre) {
  const auto bounds = nlohmann::json::parse(run({"info", "builtin:tiny", "--json"}).out)["bounds"];
  for (const std::string camera : {"Front", "auto"}) {
    const image::Image image = render("x.exr", {"--aov", "depth", "--camera", camera});
    const std::vector<double> to_world = numbers_of(image.metadata.at("lodestone:camera_to_world"));
    double half_width = 0, half_height = 0;
    ASSERT_EQ(std::sscanf(image.metadata.at("lodestone:projection").c_str(),
                          "perspective half_width=%lf half_height=%lf", &half_width, &half_height),
              2);
    ASSERT_EQ(to_world.size(), 16u);
    ASSERT_TRUE(image.camera);
    int hits = 0;
    for (uint32_t y = 0; y < image.height; ++y) {
      for (uint32_t x = 0; x < image.width; ++x) {
        const double depth = image.find("depth.Z")->values[size_t(y) * image.width + x];
        if (std::isinf(depth)) continue;
        ++hits;
        const double right = ((2 * x + 1.0) / image.width - 1) * half_width;
        const double up = (1 - (2 * y + 1.0) / image.height) * half_height;
        const double along = depth / std::sqrt(right * right + up * up + 1);
        std::array<double, 3> point{};
        for (size_t row = 0; row < 3; ++row) {
          point[row] =
              along * (right * to_world[4 * row] + up * to_world[4 * row + 1] - to_world[4 * row + 2]) +
              to_world[4 * row + 3];
          EXPECT_GT(point[row], bounds["lo"][row].get<double>() - 1e-4);
          EXPECT_LT(point[row], bounds["hi"][row].get<double>() + 1e-4);
        }
        EXPECT_NEAR(projected(point, image.camera->world_to_ndc)[0], (x + 0.5) / image.width, 1e-5);
        EXPECT_NEAR(projected(point, image.camera->world_to_ndc)[1], (y + 0.5) / image.height, 1e-5);
        EXPECT_NEAR(projected(point, image.camera->world_to_camera)[2], along, 1e-4);
      }
    }
    EXPECT_GT(hits, 10) << camera;
  }
}

TEST_F(Render, SaysInTheFileWhichWeightsAndWhichViewItShows) {
  auto metadata = render("x.exr", {"--weights", "fold=0.25"}).metadata;
  EXPECT_EQ(metadata.at("lodestone:weights"), "fold=0.25");
  EXPECT_GT(std::stod(metadata.at("lodestone:wall_ms")), 0);
  EXPECT_EQ(metadata.count("lodestone:exposure"), 0u);  // an EXR has none
  metadata = render("x.png", {"--exposure", "-1.5", "--view", "linear"}).metadata;
  EXPECT_EQ(metadata.at("lodestone:exposure"), "-1.5");
  EXPECT_EQ(metadata.at("lodestone:view"), "linear");
  EXPECT_EQ(metadata.count("lodestone:weights"), 0u);
}

TEST_F(Render, OnlyTheTimesDifferBetweenTwoRuns) {
  auto a = render("a.exr").metadata, b = render("b.exr").metadata;
  a.erase("lodestone:pass_ms");
  b.erase("lodestone:pass_ms");
  a.erase("lodestone:wall_ms");
  b.erase("lodestone:wall_ms");
  EXPECT_EQ(a, b);
}

TEST_F(Render, APngHoldsTheDisplayPictureAndItsProvenance) {
  const image::Image dark = render("a.png", {"--exposure", "-3"}),
                     bright = render("b.png", {"--exposure", "1"});
  EXPECT_EQ(dark.channels.size(), 3u);
  double sums[2] = {0, 0};
  for (size_t i = 0; i < dark.pixels(); ++i) {
    sums[0] += dark.find("G")->values[i];
    sums[1] += bright.find("G")->values[i];
  }
  EXPECT_LT(sums[0], sums[1]);
  EXPECT_EQ(dark.metadata.at("lodestone:scene"), "builtin:tiny");
  EXPECT_FALSE(equal_beauty(bright, render("c.png", {"--exposure", "1", "--view", "linear"})));
}

TEST_F(Render, AnExrIsLinearWhateverTheExposure) {
  expect_equal_pixels(render("a.exr"), render("b.exr", {"--exposure", "3", "--view", "linear"}));
}

}  // namespace
}  // namespace lodestone::cli
