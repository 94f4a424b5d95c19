// SPDX-License-Identifier: MIT
// What info, bake and devices tell.
#include <nlohmann/json.hpp>

#include "process.h"

namespace lodestone::cli {
namespace {

using Json = nlohmann::json;

Json json_of(const std::vector<std::string>& arguments) {
  const Result result = run(arguments);
  EXPECT_EQ(result.code, 0) << result.err;
  return Json::parse(result.out);
}

class Info : public CommandLine {};

TEST_F(Info, OfASceneNamesWhatItHolds) {
  const Json json = json_of({"info", "builtin:tiny", "--json"});
  EXPECT_EQ(json["triangles"], 6);
  EXPECT_EQ(json["vertices"], 10);
  EXPECT_EQ(json["meshes"][0]["targets"], Json::array({"fold"}));
  EXPECT_EQ(json["clips"][0]["name"], "Fold");
  EXPECT_EQ(json["clips"][0]["seconds"], 1.0);
  EXPECT_EQ(json["cameras"][0]["name"], "Front");
  EXPECT_EQ(json["lights"][0]["kind"], "point");
  EXPECT_EQ(json["materials"].size(), 2u);
  EXPECT_EQ(json["atlas"]["kind"], "grid");
  EXPECT_EQ(json["atlas"]["quads"], 3);
  EXPECT_EQ(json["atlas"]["closed"], false);
}

TEST_F(Info, TheAtlasCanBeChosen) {
  const Json json = json_of({"info", "builtin:tiny", "--atlas", "exact", "--json"});
  EXPECT_EQ(json["atlas"]["kind"], "exact");
  EXPECT_EQ(json["atlas"]["charts"], 6);
}

TEST_F(Info, OfASceneIsReadable) {
  const Result result = run({"info", "builtin:tiny"});
  EXPECT_EQ(result.code, 0);
  for (const char* part : {"triangles: 6\n", "0 Fold: seconds 1.0, channels 1\n", "targets (fold)",
                           "closed: no\n", "notes:\n    10 edges have one triangle: the surface is open.\n"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part << "\n" << result.out;
}

TEST_F(Info, OfAnImageGivesRangesAndMetadata) {
  ASSERT_EQ(run(tiny_render(place("x.exr"), {"--aov", "depth,id"})).code, 0);
  const Json json = json_of({"info", place("x.exr"), "--json"});
  EXPECT_EQ(json["width"], 24);
  EXPECT_EQ(json["height"], 16);
  EXPECT_EQ(json["metadata"]["lodestone:scene"], "builtin:tiny");
  std::map<std::string, Json> channels;
  for (const Json& channel : json["channels"]) channels[channel["name"]] = channel;
  EXPECT_EQ(channels.at("id.triangle")["type"], "uint");
  EXPECT_GT(channels.at("depth.Z")["min"].get<double>(), 1);
  EXPECT_GT(channels.at("depth.Z")["non_finite"].get<int>(), 0);  // what is missed is infinitely far
  EXPECT_LT(channels.at("R")["min"].get<double>(), channels.at("R")["max"].get<double>());
}

TEST_F(Info, OfABakedFileIsThatOfItsScene) {
  ASSERT_EQ(run({"bake", "builtin:tiny", "-o", place("tiny.lode")}).code, 0);
  const Json baked = json_of({"info", place("tiny.lode"), "--json"});
  EXPECT_EQ(baked["atlas"]["quads"], json_of({"info", "builtin:tiny", "--json"})["atlas"]["quads"]);
  EXPECT_EQ(baked["content_hash"].get<std::string>().size(), 32u);
  EXPECT_EQ(baked["source"], (Json{{"scene", "builtin:tiny"}, {"asked_atlas", "auto"}}));
}

TEST_F(Info, OfABakedFileMeasuresItsDistanceToTheScene) {
  const std::vector<std::string> charts = {"--atlas", "charts", "--texel-budget", "500"};
  std::vector<std::string> bake = {"bake", "builtin:spheres", "-o", place("s.lode")},
                           info = {"info", "builtin:spheres"};
  bake.insert(bake.end(), charts.begin(), charts.end());
  info.insert(info.end(), charts.begin(), charts.end());
  info.push_back("--json");
  ASSERT_EQ(run(bake).code, 0);
  const Json baked = json_of({"info", place("s.lode"), "--json"});
  EXPECT_GT(baked["distance"]["hausdorff"].get<double>(), 0);
  EXPECT_EQ(baked["distance"], json_of(info)["distance"]);
  EXPECT_EQ(baked["distance_not_measured"], nullptr);
}

TEST_F(Info, OfABakedFileSaysWhyItsDistanceIsNotMeasured) {
  write_text(place("t.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_EQ(run({"bake", place("t.obj"), "-o", place("t.lode")}).code, 0);
  std::filesystem::remove(place("t.obj"));
  const Json baked = json_of({"info", place("t.lode"), "--json"});
  EXPECT_EQ(baked["distance"], nullptr);
  EXPECT_NE(baked["distance_not_measured"].get<std::string>().find("t.obj"), std::string::npos);
}

TEST_F(Info, RoundsForPeopleAndNotForPrograms) {
  const std::string text = run({"info", "builtin:spheres", "--atlas", "charts"}).out;
  const size_t at = text.find("texels used percent: ");
  ASSERT_NE(at, std::string::npos);
  EXPECT_LE(text.find('\n', at) - at, std::string("texels used percent: 12.34567").size());
  const Json json = json_of({"info", "builtin:spheres", "--atlas", "charts", "--json"});
  EXPECT_GT(json["atlas"]["texels_used_percent"].dump().size(), std::string("12.34567").size());
}

TEST_F(Info, BakingTwiceGivesEqualFiles) {
  ASSERT_EQ(run({"bake", "builtin:tiny", "-o", place("a.lode")}).code, 0);
  ASSERT_EQ(run({"bake", "builtin:tiny", "-o", place("b.lode"), "--threads", "1"}).code, 0);
  EXPECT_EQ(read_text(place("a.lode")), read_text(place("b.lode")));
}

TEST(Devices, EndWithTheCpu) {
  const Json json = json_of({"devices", "--json"});
  ASSERT_FALSE(json["devices"].empty());
  const Json& last = json["devices"].back();
  EXPECT_EQ(last["kind"], "cpu");
  EXPECT_EQ(last["usable"], true);
  EXPECT_NE(last["properties"]["SIMD"].get<std::string>(), "");
  EXPECT_NE(run({"devices"}).out.find("\ncpu: "), std::string::npos);
}

TEST(Devices, WithoutADriverOnlyTheCpuIsLeft) {
  const Result result = run({"devices"}, {.environment = {{"VK_DRIVER_FILES", "/none.json"}}});
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.out.find("/none.json"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("\ncpu: "), std::string::npos) << result.out;
}

}  // namespace
}  // namespace lodestone::cli
