// SPDX-License-Identifier: MIT
// Pictures under environment maps, and what is said of bad ones.
#include <algorithm>

#include "lodestone/image/image.h"
#include "process.h"

namespace lodestone::cli {
namespace {

class EnvironmentOption : public CommandLine {
 protected:
  // A map whose left half, which is the -Z side of it, is dark and whose right half is bright.
  std::string map(const std::string& name = "map.exr", float bright = 2) const {
    image::Image image;
    image.width = 64;
    image.height = 32;
    for (const char* channel : {"R", "G", "B"}) {
      std::vector<float>& values = image.add(channel).values;
      for (size_t i = 0; i < values.size(); ++i) values[i] = i % 64 < 32 ? 0.25f : bright;
    }
    image::write(place(name), image);
    return place(name);
  }

  image::Image render(const std::string& name, const std::vector<std::string>& more) const {
    const Result result = run(tiny_render(place(name), more));
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return image::read(place(name));
  }

  static float corner(const image::Image& image) { return image.find("G")->values[0]; }

  void expect_refused(int code, const std::vector<std::string>& more, const std::string& said) const {
    const Result result = run(tiny_render(place("x.exr"), more));
    EXPECT_EQ(result.code, code) << result.err;
    EXPECT_NE(result.err.find("lodestone: error: " + said), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    const std::vector<std::string> there = files();
    EXPECT_EQ(std::count(there.begin(), there.end(), "x.exr"), 0);
  }
};

TEST_F(EnvironmentOption, IsSeenAndLights) {
  const image::Image plain = render("a.exr", {}), lit = render("b.exr", {"--environment", map()});
  EXPECT_NE(plain.find("R")->values, lit.find("R")->values);
  EXPECT_EQ(plain.find("A")->values, lit.find("A")->values);
  // Tiny's camera looks along -Z: the left half of the map's left half is to its left.
  EXPECT_NEAR(corner(lit), 0.25f, 1e-6f);
}

TEST_F(EnvironmentOption, CanBeStrongerAndTurned) {
  const image::Image once = render("a.exr", {"--environment", map()}),
                     strong = render("b.exr", {"--environment", map(), "--environment-strength", "3"}),
                     turned = render("c.exr", {"--environment", map(), "--environment-rotation", "-180"}),
                     round = render("d.exr", {"--environment", map(), "--environment-rotation", "360"});
  EXPECT_NEAR(corner(strong), 3 * corner(once), 1e-5f);
  EXPECT_NEAR(corner(turned), 2, 1e-5f);
  EXPECT_EQ(once.find("R")->values, round.find("R")->values);
}

TEST_F(EnvironmentOption, IsNamedInThePictureThatItLights) {
  const image::Image image = render("a.exr", {"--environment", map(), "--environment-strength", "0.5"});
  EXPECT_EQ(image.metadata.at("lodestone:environment"), map());
  EXPECT_EQ(image.metadata.at("lodestone:environment_strength"), "0.5");
  EXPECT_EQ(image.metadata.at("lodestone:environment_rotation"), "0");
  EXPECT_EQ(render("b.exr", {}).metadata.count("lodestone:environment"), 0u);
}

TEST_F(EnvironmentOption, GivesTheSamePictureOnAnyNumberOfThreads) {
  const auto on = [&](const char* threads) {
    return render("x.exr", {"--environment", map(), "--spp", "4", "--threads", threads});
  };
  EXPECT_EQ(on("1").find("R")->values, on("2").find("R")->values);
}

TEST_F(EnvironmentOption, IsRefusedWhereItIsMissingOrNoPictureOrBeyondAllLight) {
  expect_refused(3, {"--environment", place("none.hdr")}, place("none.hdr") + ": ");
  write_text(place("text.hdr"), "a text");
  expect_refused(3, {"--environment", place("text.hdr")}, place("text.hdr") + ": byte 0: is neither");
  expect_refused(3, {"--environment", map("dark.exr", -2)}, place("dark.exr") + ": column 32, row 0: ");
  expect_refused(3, {"--environment", map("hot.exr", 1e25f), "--environment-strength", "1e9"},
                 "builtin:tiny: environment: ");
}

TEST_F(EnvironmentOption, IsWrongUsageWithoutAFileOrWithNoNumber) {
  expect_refused(2, {"--environment", ""}, "--environment: ");
  expect_refused(2, {"--environment-strength", "2"}, "--environment-strength: there is no environment map");
  expect_refused(2, {"--environment-rotation", "2"}, "--environment-rotation: there is no environment map");
  expect_refused(2, {"--environment", map(), "--environment-strength", "-1"}, "--environment-strength: ");
  expect_refused(2, {"--environment", map(), "--environment-rotation", "east"}, "--environment-rotation: ");
}

TEST_F(EnvironmentOption, IsNotOverwritten) {
  const std::string file = map();
  const Result result = run(tiny_render(file, {"--environment", file}));
  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_EQ(image::read(file).width, 64u);
}

}  // namespace
}  // namespace lodestone::cli
