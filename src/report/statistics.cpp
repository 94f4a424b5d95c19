// SPDX-License-Identifier: MIT
#include "lodestone/report/statistics.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

namespace lodestone::report {
namespace {

using Json = nlohmann::ordered_json;  // keeps the order of the contract

Json text_or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

template <class T>
Json value_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json to_json(const PassSum& pass, bool on_cpu) {
  Json json;
  json["name"] = pass.name;
  json["device_ms"] = value_or_null(pass.device_ms);
  if (on_cpu) json["wall_ms"] = pass.wall_ms;
  json["invocations"] = pass.invocations;
  if (!pass.counters) {
    json["bytes_read"] = nullptr;
    json["bytes_written"] = nullptr;
    json["counters"] = nullptr;
    return json;
  }
  json["bytes_read"] = pass.counters->bytes_read;
  json["bytes_written"] = pass.counters->bytes_written;
  json["counters"] = {{"rays", pass.counters->rays},
                      {"node_visits", pass.counters->node_visits},
                      {"box_tests", pass.counters->box_tests},
                      {"triangle_tests", pass.counters->triangle_tests},
                      {"active_lanes", value_or_null(pass.counters->active_lanes())}};
  return json;
}

Json to_json(const Frame& frame, bool on_cpu) {
  Json passes = Json::array();
  for (const PassSum& pass : sum_by_name(frame.dispatches)) passes.push_back(to_json(pass, on_cpu));
  return {{"frame", frame.frame}, {"time_s", frame.time_s}, {"wall_ms", frame.wall_ms}, {"passes", passes}};
}

Json totals(const RunRecord& run) {
  double seconds = 0;
  std::optional<uint64_t> rays;
  for (const Frame& frame : run.frames) {
    seconds += frame.wall_ms / 1000;
    for (const Dispatch& dispatch : frame.dispatches) {
      if (dispatch.counters) rays = rays.value_or(0) + dispatch.counters->rays;
    }
  }
  const bool timed = seconds > 0;
  return {{"rays", value_or_null(rays)},
          {"mrays_per_s", timed && rays ? Json(double(*rays) / seconds / 1e6) : Json()},
          {"frames_per_s", timed ? Json(double(run.frames.size()) / seconds) : Json()}};
}

}  // namespace

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) * 1024 / 1e6;  // Linux counts in KiB
}

std::string statistics_json(const RunRecord& run) {
  Json json;
  json["lodestone"] = run.version;
  json["command"] = run.command;
  json["tracer"] = run.tracer;
  json["device"] = {{"kind", run.device.kind},
                    {"name", text_or_null(run.device.name)},
                    {"driver", text_or_null(run.device.driver)},
                    {"api", text_or_null(run.device.api)}};
  json["scene"] = {{"file", run.scene.file},
                   {"triangles", run.scene.triangles},
                   {"vertices", run.scene.vertices},
                   {"morph_targets", run.scene.morph_targets},
                   {"joints", run.scene.joints}};
  json["image"] = {{"width", run.image.width}, {"height", run.image.height}, {"spp", run.image.spp}};
  if (!run.image.denoise.empty()) json["image"]["denoise"] = run.image.denoise;
  json["precompute"] = Json::array();
  for (const Stage& stage : run.precompute)
    json["precompute"].push_back({{"name", stage.name}, {"wall_ms", stage.wall_ms}});
  json["frames"] = Json::array();
  for (const Frame& frame : run.frames) json["frames"].push_back(to_json(frame, run.device.kind == "cpu"));
  json["totals"] = totals(run);
  json["memory"] = {{"device_mb", double(run.device_bytes) / 1e6}, {"peak_rss_mb", peak_rss_mb()}};
  if (run.streaming.portions > 0) {
    json["memory"]["device_peak_mb"] = double(run.streaming.peak_bytes) / 1e6;
    json["memory"]["portions"] = run.streaming.portions;
    json["memory"]["portion_loads"] = run.streaming.loads;
  }
  json["atlas"] = {{"charts", run.atlas.charts}, {"quads", run.atlas.quads}, {"texels", run.atlas.texels}};
  json["settings"] = {{"integrator", run.settings.integrator},
                      {"traversal", run.settings.traversal},
                      {"seed", run.settings.seed},
                      {"camera", text_or_null(run.settings.camera)},
                      {"clip", text_or_null(run.settings.clip)}};
  // A file name need not be UTF-8, JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lodestone::report
