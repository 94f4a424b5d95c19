// SPDX-License-Identifier: MIT
#include "lodestone/report/statistics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "runs.h"

namespace lodestone::report {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

using Keys = std::vector<std::string>;

TEST(Statistics, HasTheFieldsOfTheContractInItsOrder) {
  RunRecord run = testing::gpu_run();
  run.frames[0].dispatches = {testing::counted_dispatch("bounds", 5)};
  const Json json = Json::parse(statistics_json(run));
  EXPECT_EQ(keys(json), (Keys{"lodestone", "command", "tracer", "device", "scene", "image", "precompute",
                              "frames", "totals", "memory", "atlas", "settings"}));
  EXPECT_EQ(keys(json["device"]), (Keys{"kind", "name", "driver", "api"}));
  EXPECT_EQ(keys(json["scene"]), (Keys{"file", "triangles", "vertices", "morph_targets", "joints"}));
  EXPECT_EQ(keys(json["image"]), (Keys{"width", "height", "spp"}));
  EXPECT_EQ(keys(json["precompute"][0]), (Keys{"name", "wall_ms"}));
  EXPECT_EQ(keys(json["frames"][0]), (Keys{"frame", "time_s", "wall_ms", "passes"}));
  const Json& pass = json["frames"][0]["passes"][0];
  EXPECT_EQ(keys(pass),
            (Keys{"name", "device_ms", "invocations", "bytes_read", "bytes_written", "counters"}));
  EXPECT_EQ(keys(pass["counters"]),
            (Keys{"rays", "node_visits", "box_tests", "triangle_tests", "active_lanes"}));
  EXPECT_EQ(keys(json["totals"]), (Keys{"rays", "mrays_per_s", "frames_per_s"}));
  EXPECT_EQ(keys(json["memory"]), (Keys{"device_mb", "peak_rss_mb"}));
  EXPECT_EQ(keys(json["atlas"]), (Keys{"charts", "quads", "texels"}));
  EXPECT_EQ(keys(json["settings"]), (Keys{"integrator", "traversal", "seed", "camera", "clip"}));
  run.streaming = {3, 7, 5000000};
  const Json streamed = Json::parse(statistics_json(run));
  EXPECT_EQ(streamed["memory"]["device_peak_mb"], 5);
  EXPECT_EQ(streamed["memory"]["portions"], 3);
  EXPECT_EQ(streamed["memory"]["portion_loads"], 7);
}

TEST(Statistics, SaysHowPicturesWereDenoisedWhereTheyWere) {
  RunRecord run = testing::gpu_run();
  run.image.denoise = "by hand";
  EXPECT_EQ(Json::parse(statistics_json(run))["image"]["denoise"], "by hand");
}

TEST(Statistics, CarriesWhatTheRunMeasured) {
  RunRecord run = testing::gpu_run();
  run.frames[0].dispatches = {testing::counted_dispatch("trace", 2000000),
                              testing::counted_dispatch("trace", 1000000)};
  const Json json = Json::parse(statistics_json(run));
  EXPECT_EQ(json["lodestone"], "1.2.3");
  EXPECT_EQ(json["scene"]["joints"], 7);
  EXPECT_EQ(json["image"]["height"], 360);
  EXPECT_EQ(json["precompute"][0]["wall_ms"], 12.5);
  EXPECT_EQ(json["frames"][1]["frame"], 11);
  EXPECT_EQ(json["frames"][1]["time_s"], 0.25);
  const Json& pass = json["frames"][0]["passes"][0];
  EXPECT_EQ(pass["device_ms"], 4.0);
  EXPECT_EQ(pass["bytes_read"], 16000000);
  EXPECT_EQ(pass["counters"]["active_lanes"], 0.75);
  EXPECT_EQ(json["totals"]["rays"], 3000000);
  EXPECT_DOUBLE_EQ(json["totals"]["mrays_per_s"].get<double>(), 3.0);
  EXPECT_DOUBLE_EQ(json["totals"]["frames_per_s"].get<double>(), 2.0);
  EXPECT_DOUBLE_EQ(json["memory"]["device_mb"].get<double>(), 3.0);
  EXPECT_GT(json["memory"]["peak_rss_mb"].get<double>(), 1.0);
}

TEST(Statistics, WhatWasNotCountedIsNull) {
  RunRecord run = testing::gpu_run();
  run.frames[0].dispatches = {testing::device_dispatch("trace", 0, 4)};
  const Json json = Json::parse(statistics_json(run));
  const Json& pass = json["frames"][0]["passes"][0];
  EXPECT_TRUE(pass["counters"].is_null());
  EXPECT_TRUE(pass["bytes_read"].is_null());
  EXPECT_TRUE(pass["bytes_written"].is_null());
  EXPECT_TRUE(json["totals"]["rays"].is_null());
  EXPECT_TRUE(json["totals"]["mrays_per_s"].is_null());
}

TEST(Statistics, WallTimeStandsInForDeviceTimeOnTheCpuOnly) {
  RunRecord run = testing::gpu_run();
  run.frames[0].dispatches = {testing::dispatch("trace", 0, 4)};
  EXPECT_FALSE(Json::parse(statistics_json(run))["frames"][0]["passes"][0].contains("wall_ms"));
  run.device = {"cpu", "CPU", "", ""};
  const Json json = Json::parse(statistics_json(run));
  const Json& pass = json["frames"][0]["passes"][0];
  EXPECT_TRUE(pass["device_ms"].is_null());
  EXPECT_EQ(pass["wall_ms"], 4.0);
  EXPECT_TRUE(json["device"]["driver"].is_null());
  EXPECT_TRUE(json["device"]["api"].is_null());
}

TEST(Statistics, ARunWithoutFramesHasNoRates) {
  RunRecord run = testing::gpu_run();
  run.frames.clear();
  const Json json = Json::parse(statistics_json(run));
  EXPECT_TRUE(json["frames"].is_array());
  EXPECT_TRUE(json["totals"]["frames_per_s"].is_null());
}

TEST(Statistics, SurvivesAFileNameThatIsNoUtf8) {
  RunRecord run = testing::gpu_run();
  run.scene.file = "caf\xe9.obj";
  EXPECT_TRUE(Json::parse(statistics_json(run)).is_object());
}

}  // namespace
}  // namespace lodestone::report
