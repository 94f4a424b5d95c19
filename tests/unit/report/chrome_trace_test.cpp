// SPDX-License-Identifier: MIT
#include "lodestone/report/chrome_trace.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "runs.h"

namespace lodestone::report {
namespace {

using Json = nlohmann::json;

std::vector<Json> complete_events(const RunRecord& run, const std::string& category) {
  std::vector<Json> found;
  const Json trace = Json::parse(chrome_trace(run));
  for (const Json& event : trace["traceEvents"]) {
    if (event["ph"] == "X" && event["cat"] == category) found.push_back(event);
  }
  return found;
}

TEST(ChromeTrace, HasOneEventADispatchInMicroseconds) {
  RunRecord run = testing::gpu_run();
  run.frames[0].dispatches = {testing::device_dispatch("blend", 101, 2),
                              testing::device_dispatch("trace", 110, 30)};
  const auto passes = complete_events(run, "pass");
  ASSERT_EQ(passes.size(), 3u);  // links too
  EXPECT_EQ(passes[1]["name"], "blend");
  EXPECT_DOUBLE_EQ(passes[1]["ts"].get<double>(), 101000);
  EXPECT_DOUBLE_EQ(passes[1]["dur"].get<double>(), 2000);
  EXPECT_EQ(passes[1]["args"]["invocations"], 64);
  EXPECT_EQ(passes[1]["args"]["clock"], "device");
  EXPECT_EQ(passes[0]["args"]["clock"], "host");
}

TEST(ChromeTrace, CarriesEveryCounterThatWasCounted) {
  RunRecord run = testing::gpu_run();
  run.frames[0].dispatches = {testing::counted_dispatch("trace", 1000),
                              testing::device_dispatch("shade", 110, 30)};
  const auto passes = complete_events(run, "pass");
  const Json expected = {{"invocations", 64},  {"clock", "device"},        {"bytes_read", 8000000},
                         {"rays", 1000},       {"bytes_written", 1000000}, {"node_visits", 10000},
                         {"box_tests", 20000}, {"triangle_tests", 3000},   {"active_lanes", 0.75}};
  EXPECT_EQ(passes[1]["args"], expected);
  EXPECT_FALSE(passes[2]["args"].contains("rays"));
}

TEST(ChromeTrace, DispatchesNeverOverlapOnTheDeviceTrack) {
  RunRecord run = testing::gpu_run();
  run.frames[0].dispatches = {testing::device_dispatch("blend", 100, 50),
                              testing::device_dispatch("trace", 101, 30)};
  const auto passes = complete_events(run, "pass");
  EXPECT_DOUBLE_EQ(passes[2]["ts"].get<double>(), 150000);
}

TEST(ChromeTrace, KeepsHostAndDeviceOnNamedTracksOfTheirOwn) {
  RunRecord run = testing::gpu_run();
  const auto frames = complete_events(run, "frame"), passes = complete_events(run, "pass");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0]["name"], "frame 10");
  EXPECT_DOUBLE_EQ(frames[1]["ts"].get<double>(), 600000);
  EXPECT_EQ(complete_events(run, "precompute").size(), 1u);
  EXPECT_NE(frames[0]["tid"], passes[0]["tid"]);
  std::vector<std::string> tracks;
  const Json trace = Json::parse(chrome_trace(run));
  for (const Json& event : trace["traceEvents"]) {
    if (event["name"] == "thread_name") tracks.push_back(event["args"]["name"]);
  }
  EXPECT_EQ(tracks, (std::vector<std::string>{"host", "llvmpipe (gpu)"}));
}

}  // namespace
}  // namespace lodestone::report
