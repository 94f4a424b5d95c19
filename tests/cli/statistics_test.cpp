// SPDX-License-Identifier: MIT
// The files of --stats and --profile, as scripts read them.
#include <nlohmann/json.hpp>
#include <set>

#include "process.h"

namespace lodestone::cli {
namespace {

using Json = nlohmann::json;

class Statistics : public CommandLine {
 protected:
  Json statistics(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"--frames", "3-4", "--stats", place("s.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = run(tiny_render(place("x##.png"), arguments));
    EXPECT_EQ(result.code, 0) << result.err;
    return Json::parse(read_text(place("s.json")));
  }
};

const Json& pass_named(const Json& frame, const std::string& name) {
  for (const Json& pass : frame["passes"]) {
    if (pass["name"] == name) return pass;
  }
  ADD_FAILURE() << "no pass " << name;
  return frame;
}

// A value that may be unknown, but then is null and not 0.
bool number_or_null(const Json& value) {
  return value.is_null() || value.is_number();
}

TEST_F(Statistics, DescribeTheRun) {
  const Json json = statistics();
  EXPECT_TRUE(json["lodestone"].is_string());
  EXPECT_EQ(json["command"], "render");
  EXPECT_EQ(json["tracer"], "geometry-image");
  EXPECT_EQ(json["device"]["kind"], "cpu");
  EXPECT_TRUE(json["device"]["name"].is_string());
  EXPECT_TRUE(json["device"].contains("driver") && json["device"].contains("api"));
  EXPECT_EQ(json["scene"]["file"], "builtin:tiny");
  EXPECT_EQ(json["scene"]["triangles"], 6);
  EXPECT_EQ(json["scene"]["vertices"], 10);
  EXPECT_EQ(json["scene"]["morph_targets"], 1);
  EXPECT_EQ(json["scene"]["joints"], 0);
  EXPECT_EQ(json["image"], (Json{{"width", 24}, {"height", 16}, {"spp", 1}}));
  EXPECT_EQ(json["atlas"]["charts"], 2);
  EXPECT_EQ(json["settings"]["integrator"], "eye");
  EXPECT_EQ(json["settings"]["traversal"], "wide");
  EXPECT_EQ(json["settings"]["seed"], 0);
  EXPECT_TRUE(json["settings"]["camera"].is_string());
  EXPECT_TRUE(json["settings"].contains("clip"));
}

TEST_F(Statistics, TimeThePrecomputationAndEveryFrame) {
  const Json json = statistics();
  std::set<std::string> stages;
  for (const Json& stage : json["precompute"]) {
    stages.insert(stage["name"].get<std::string>());
    EXPECT_GE(stage["wall_ms"].get<double>(), 0);
  }
  EXPECT_TRUE(stages.count("charts") == 1 && stages.count("links") == 1);
  ASSERT_EQ(json["frames"].size(), 2u);
  EXPECT_EQ(json["frames"][1]["frame"], 4);
  EXPECT_DOUBLE_EQ(json["frames"][1]["time_s"].get<double>(), 4.0 / 24);
  EXPECT_GT(json["frames"][1]["wall_ms"].get<double>(), 0);
  EXPECT_GT(json["totals"]["frames_per_s"].get<double>(), 0);
  EXPECT_GT(json["memory"]["device_mb"].get<double>(), 0);
  EXPECT_GT(json["memory"]["peak_rss_mb"].get<double>(), 1);
}

TEST_F(Statistics, OfTheCpuHaveWallTimesForDeviceTimes) {
  const Json json = statistics();
  const Json& blend = pass_named(json["frames"][0], "blend");
  EXPECT_TRUE(blend["device_ms"].is_null());
  EXPECT_GE(blend["wall_ms"].get<double>(), 0);
  EXPECT_EQ(blend["invocations"], 10);
}

TEST_F(Statistics, AreNullWhereNothingWasCounted) {
  const Json json = statistics();
  for (const Json& pass : json["frames"][0]["passes"]) {
    for (const char* field : {"bytes_read", "bytes_written", "counters"})
      EXPECT_TRUE(pass[field].is_null()) << field;
  }
  EXPECT_TRUE(json["totals"]["rays"].is_null());
  EXPECT_TRUE(json["totals"]["mrays_per_s"].is_null());
}

TEST_F(Statistics, CountWhenAskedTo) {
  const Json json = statistics({"--counters", "--traversal", "threaded"});
  uint64_t rays = 0;
  for (const Json& frame : json["frames"]) {
    for (const Json& pass : frame["passes"]) {
      EXPECT_TRUE(pass["bytes_read"].is_number_unsigned());
      EXPECT_TRUE(pass["bytes_written"].is_number_unsigned());
      for (const char* field : {"rays", "node_visits", "box_tests", "triangle_tests"})
        EXPECT_TRUE(pass["counters"][field].is_number_unsigned()) << field;
      EXPECT_TRUE(number_or_null(pass["counters"]["active_lanes"]));
      rays += pass["counters"]["rays"].get<uint64_t>();
    }
  }
  EXPECT_GE(rays, 2u * 24 * 16);  // at least one a pixel and frame
  EXPECT_EQ(json["totals"]["rays"], rays);
  EXPECT_GT(json["totals"]["mrays_per_s"].get<double>(), 0);
  EXPECT_GT(pass_named(json["frames"][0], "blend")["bytes_written"].get<uint64_t>(), 0u);
}

TEST_F(Statistics, CountingChangesNoPixel) {
  ASSERT_EQ(run(tiny_render(place("a.exr"), {"--aov", "depth,id"})).code, 0);
  ASSERT_EQ(run(tiny_render(place("b.exr"), {"--aov", "depth,id", "--counters"})).code, 0);
  EXPECT_EQ(run({"compare", place("a.exr"), place("b.exr")}).code, 0);
}

TEST_F(Statistics, TheProfileIsAChromeTraceOfEveryDispatch) {
  ASSERT_EQ(run(tiny_render(place("x##.png"), {"--frames", "0-1", "--profile", place("p.json")})).code, 0);
  const Json trace = Json::parse(read_text(place("p.json")));
  int frames = 0, blends = 0;
  for (const Json& event : trace["traceEvents"]) {
    if (event["ph"] != "X") continue;
    EXPECT_TRUE(event["ts"].is_number() && event["dur"].is_number());
    frames += event["cat"] == "frame";
    blends += event["name"] == "blend";
  }
  EXPECT_EQ(frames, 2);
  EXPECT_EQ(blends, 2);
}

}  // namespace
}  // namespace lodestone::cli
