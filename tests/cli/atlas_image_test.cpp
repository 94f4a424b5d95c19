// SPDX-License-Identifier: MIT
// The atlas as pictures: `bake --atlas-image`.
#include "lodestone/image/image.h"
#include "process.h"

namespace lodestone::cli {
namespace {

using Names = std::vector<std::string>;

class AtlasImage : public CommandLine {
 protected:
  Result bake(const std::string& scene, const std::string& pictures,
              const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"bake", scene, "-o", place("x.lode"), "--atlas-image", pictures};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  // A flat grid of 5 x 3 samples: one chart.
  std::string height_map() const {
    image::Image map;
    map.width = 5;
    map.height = 3;
    map.add("Y");
    image::write(place("map-charts.png"), map);
    return place("map-charts.png");
  }
};

TEST_F(AtlasImage, IsFourPicturesOfOneSize) {
  const Result result = bake(height_map(), place("deep/a.png"));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("  pictures         5 x 3 texels, 100.0 % of them in charts\n"),
            std::string::npos)
      << result.out;
  // 1024 / 5, rounded up, pixels a texel.
  for (const char* name : {"positions", "normals", "charts", "stretch"}) {
    const image::Image picture = image::read(place(std::string("deep/a-") + name + ".png"));
    EXPECT_EQ(picture.width, 5u * 205) << name;
    if (std::string(name) == "stretch")
      EXPECT_GT(picture.height, 3u * 205);  // the scale
    else
      EXPECT_EQ(picture.height, 3u * 205) << name;
  }
  const image::Image normals = image::read(place("deep/a-normals.png"));
  EXPECT_EQ(normals.find("G")->values.front(), 1.0f) << "up";
  EXPECT_NE(image::read(place("deep/a-positions.png")).find("R")->values.front(),
            image::read(place("deep/a-positions.png")).find("R")->values[4 * 205]);
}

TEST_F(AtlasImage, HoldsTheNumbersInAnExr) {
  write_text(place("t.obj"), "v 0 0 7\nv 1 0 7\nv 0 1 7\nf 1 2 3\n");
  ASSERT_EQ(bake(place("t.obj"), place("a.exr"), {"--atlas", "exact"}).code, 0);
  EXPECT_EQ(files(),
            (Names{"a-charts.exr", "a-normals.exr", "a-positions.exr", "a-stretch.exr", "t.obj", "x.lode"}));
  const image::Image positions = image::read(place("a-positions.exr"));
  ASSERT_EQ(positions.pixels(), 9u);
  EXPECT_EQ(positions.find("R")->values, (std::vector<float>{0, 0.5f, 1, 0, 1.0f / 3, 0.5f, 0, 0.5f, 0}));
  EXPECT_EQ(positions.find("B")->values, (std::vector<float>{7, 7, 7, 7, 7, 7, 7, 7, 0}));
  EXPECT_EQ(positions.find("A")->values, (std::vector<float>{1, 1, 1, 1, 1, 1, 1, 1, 0}));
  EXPECT_EQ(image::read(place("a-normals.exr")).find("B")->values[4], 1.0f);
  EXPECT_EQ(image::read(place("a-charts.exr")).find("id.chart")->ids,
            (std::vector<uint32_t>{1, 1, 1, 1, 1, 1, 1, 1, 0}));
  EXPECT_GT(image::read(place("a-stretch.exr")).find("Y")->values[0], 0.9f);
}

TEST_F(AtlasImage, ShowsChartsOfAllKinds) {
  for (const char* kind : {"grid", "exact", "charts"})
    EXPECT_EQ(bake("builtin:tiny", place("a.png"), {"--atlas", kind}).code, 0) << kind;
}

TEST_F(AtlasImage, IsTheSameEveryTime) {
  const Names names = {"positions", "normals", "charts", "stretch"};
  ASSERT_EQ(bake("builtin:tiny", place("a.png"), {"--threads", "1"}).code, 0);
  ASSERT_EQ(bake("builtin:tiny", place("b.png")).code, 0);
  for (const std::string& name : names)
    EXPECT_EQ(read_text(place("a-" + name + ".png")), read_text(place("b-" + name + ".png"))) << name;
}

TEST_F(AtlasImage, EndsInPngOrExr) {
  for (const char* name : {"a.jpg", "a", "a.lode"}) {
    const Result result = bake("builtin:tiny", place(name));
    EXPECT_EQ(result.code, 2) << name;
    EXPECT_EQ(result.err, "lodestone: error: --atlas-image: `" + place(name) +
                              "` ends in neither .exr nor .png; choose one of them\n");
  }
  EXPECT_EQ(files(), Names{});
}

TEST_F(AtlasImage, DoesNotReplaceTheScene) {
  const std::string map = height_map(), before = read_text(map);
  const Result result = bake(map, place("map.png"));
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("map-charts.png` is the scene"), std::string::npos) << result.err;
  EXPECT_EQ(read_text(map), before);
}

TEST_F(AtlasImage, IsRefusedBeforeTheWorkWhereItCannotBeWritten) {
  write_text(place("file"), "");
  EXPECT_EQ(bake("builtin:tiny", place("file/a.png")).code, 5);
  EXPECT_EQ(files(), Names{"file"});
}

}  // namespace
}  // namespace lodestone::cli
