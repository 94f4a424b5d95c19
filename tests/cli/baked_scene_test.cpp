// SPDX-License-Identifier: MIT
// A .lode file where a scene is asked for.
#include <nlohmann/json.hpp>

#include "lodestone/base/file.h"
#include "lodestone/geometry_image/atlas.h"
#include "lodestone/image/image.h"
#include "process.h"

namespace lodestone::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string other_triangle = "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n";

class Baked : public CommandLine {
 protected:
  Result bake(const std::string& scene, const std::string& output,
              const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"bake", scene, "-o", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Result result = run(arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    return result;
  }
  Result render(const std::string& scene, const std::string& output,
                const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"render", scene,   "-o",       output,
                                          "--size", "16x16", "--device", "cpu"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  void expect_same_picture(const std::string& baked, const std::string& scene,
                           const std::vector<std::string>& more = {}) const {
    const Result result = render(baked, place("baked.exr"));
    ASSERT_EQ(result.code, 0) << result.err;
    ASSERT_EQ(render(scene, place("scene.exr"), more).code, 0);
    EXPECT_EQ(run({"compare", place("baked.exr"), place("scene.exr")}).code, 0);
  }
  // A .lode that says it was baked from `scene`, whatever that is.
  std::string forged(const std::string& scene) const {
    bake("builtin:tiny", place("true.lode"));
    geometry_image::BakeRecord record;
    const geometry_image::Atlas atlas = geometry_image::load_atlas(place("true.lode"), &record);
    record.scene = scene;
    geometry_image::save_atlas(place("forged.lode"), atlas, record);
    return place("forged.lode");
  }
};

TEST_F(Baked, RendersAsItsScene) {
  EXPECT_EQ(bake("builtin:tiny", place("tiny.lode")).err, "");
  expect_same_picture(place("tiny.lode"), "builtin:tiny");
}

TEST_F(Baked, FindsItsSceneInTheFolderBelowWhereverBothGo) {
  fs::create_directories(place("a/models"));
  write_text(place("a/models/t.obj"), triangle);
  EXPECT_EQ(bake(place("a/models/t.obj"), place("a/t.lode"), {"--atlas", "exact"}).err, "");
  const Json info = Json::parse(run({"info", place("a/t.lode"), "--json"}).out);
  EXPECT_EQ(info["source"], (Json{{"scene", "models/t.obj"}, {"asked_atlas", "exact"}}));
  fs::rename(place("a"), place("b"));
  expect_same_picture(place("b/t.lode"), place("b/models/t.obj"), {"--atlas", "exact"});
}

TEST_F(Baked, KeepsTheHeightOfAHeightMap) {
  image::Image map;
  map.width = map.height = 5;
  map.add("Y").values[12] = 1;
  image::write(place("map.png"), map);
  bake(place("map.png"), place("map.lode"), {"--height", "3"});
  expect_same_picture(place("map.lode"), place("map.png"), {"--height", "3"});
}

TEST_F(Baked, IsWarnedOfWhereTheSceneIsElsewhere) {
  fs::create_directories(place("there"));
  write_text(place("t.obj"), triangle);
  const Result result = bake(place("t.obj"), place("there/t.lode"));
  EXPECT_NE(result.err.find("there/t.lode: keep `t.obj` beside it"), std::string::npos) << result.err;
  EXPECT_EQ(render(place("there/t.lode"), place("x.png")).code, 3);
  fs::rename(place("t.obj"), place("there/t.obj"));
  EXPECT_EQ(render(place("there/t.lode"), place("x.png")).code, 0);
}

TEST_F(Baked, IsRefusedWithoutItsScene) {
  write_text(place("t.obj"), triangle);
  bake(place("t.obj"), place("t.lode"));
  fs::remove(place("t.obj"));
  const Result result = render(place("t.lode"), place("x.png"));
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.err,
            "lodestone: error: " + place("t.lode") +
                ": was baked from `t.obj`, which is no file in its folder; put it there or bake it "
                "again\n");
}

TEST_F(Baked, IsRefusedWhereItsSceneChanged) {
  write_text(place("t.obj"), triangle);
  bake(place("t.obj"), place("t.lode"));
  write_text(place("t.obj"), other_triangle);
  const Result result = render(place("t.lode"), place("x.png"));
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.err.rfind("lodestone: error: " + place("t.lode") + ": `t.obj` has changed since", 0), 0u)
      << result.err;
}

TEST_F(Baked, OpensNothingOutsideItsFolder) {
  fs::create_directories(place("in"));
  write_text(place("t.obj"), triangle);
  fs::create_symlink("../t.obj", place("in/link.obj"));
  const std::string file = forged("");
  EXPECT_NE(render(file, place("x.png")).err.find("does not say what it was baked from"), std::string::npos);
  for (const std::string& scene : {place("t.obj"), std::string("../t.obj"), std::string("link.obj"),
                                   std::string("..\\t.obj"), std::string(".")}) {
    fs::rename(forged(scene), place("in/forged.lode"));
    const Result result = render(place("in/forged.lode"), place("x.png"));
    EXPECT_EQ(result.code, 3) << scene;
    EXPECT_NE(result.err.find("which is no file in its folder"), std::string::npos) << result.err;
  }
}

TEST_F(Baked, IsBadInputWhereItNamesNoScene) {
  write_text(place("notes.txt"), "notes");
  for (const char* scene : {"notes.txt", "builtin:moon", "true.lode"}) {
    const Result result = render(forged(scene), place("x.png"));
    EXPECT_EQ(result.code, 3) << scene;
    EXPECT_EQ(result.err.rfind("lodestone: error: " + place("forged.lode") + ": names a scene", 0), 0u)
        << result.err;
  }
}

TEST_F(Baked, TakesNoOptionThatContradictsIt) {
  bake("builtin:tiny", place("tiny.lode"), {"--atlas", "grid"});
  EXPECT_EQ(render(place("tiny.lode"), place("x.png"), {"--atlas", "exact"}).code, 2);
  EXPECT_EQ(render(place("tiny.lode"), place("x.png"), {"--height", "2"}).code, 2);
  EXPECT_EQ(render(place("tiny.lode"), place("x.png"), {"--atlas", "grid"}).code, 0);
  EXPECT_EQ(run({"bake", place("tiny.lode"), "-o", place("again.lode")}).code, 2);
}

TEST_F(Baked, IsBlurredWhereItHasNoInstances) {
  bake("builtin:tiny", place("tiny.lode"));
  EXPECT_EQ(render(place("tiny.lode"), place("x.png"), {"--shutter", "1"}).code, 0);
  bake("builtin:shoal", place("placed.lode"));
  const Result refused = render(place("placed.lode"), place("x.png"), {"--shutter", "1"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("--instancing off"), std::string::npos) << refused.err;
}

TEST_F(Baked, IsWhatTheStatisticsName) {
  bake("builtin:tiny", place("tiny.lode"));
  ASSERT_EQ(render(place("tiny.lode"), place("x.png"), {"--stats", place("s.json")}).code, 0);
  EXPECT_EQ(Json::parse(read_text(place("s.json")))["scene"]["file"], place("tiny.lode"));
}

TEST_F(Baked, DoesNotLetAPictureReplaceItsScene) {
  image::Image map;
  map.width = map.height = 5;
  map.add("Y").values[12] = 1;
  image::write(place("map.png"), map);
  bake(place("map.png"), place("map.lode"));
  const std::string before = read_text(place("map.png"));
  const Result result = render(place("map.lode"), place("map.png"));
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("map.png` is the scene"), std::string::npos) << result.err;
  EXPECT_EQ(read_text(place("map.png")), before);
}

}  // namespace
}  // namespace lodestone::cli
