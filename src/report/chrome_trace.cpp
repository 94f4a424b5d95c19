// SPDX-License-Identifier: MIT
#include "lodestone/report/chrome_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace lodestone::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int process_id = 1;
constexpr int host_track = 1, device_track = 2;

Json name_event(const char* what, int track, const std::string& name) {
  return {{"ph", "M"}, {"name", what}, {"pid", process_id}, {"tid", track}, {"args", {{"name", name}}}};
}

struct Span {
  double start_ms = 0, length_ms = 0;
};

Json complete_event(int track, const std::string& name, const char* category, Span span, Json args) {
  return {{"ph", "X"},
          {"name", name},
          {"cat", category},
          {"pid", process_id},
          {"tid", track},
          {"ts", span.start_ms * 1000},
          {"dur", span.length_ms * 1000},
          {"args", std::move(args)}};
}

Json dispatch_arguments(const Dispatch& dispatch) {
  Json args = {{"invocations", dispatch.invocations}, {"clock", dispatch.device_ms ? "device" : "host"}};
  if (dispatch.counters) {
    const Counters& counters = *dispatch.counters;
    args["bytes_read"] = counters.bytes_read;
    args["bytes_written"] = counters.bytes_written;
    args["rays"] = counters.rays;
    args["node_visits"] = counters.node_visits;
    args["box_tests"] = counters.box_tests;
    args["triangle_tests"] = counters.triangle_tests;
    if (const std::optional<double> lanes = counters.active_lanes()) args["active_lanes"] = *lanes;
  }
  return args;
}

// Appends the events of dispatches that ran one after another; `free_ms` is when the track is next free.
void add_dispatches(const std::vector<Dispatch>& dispatches, double& free_ms, Json& events) {
  for (const Dispatch& dispatch : dispatches) {
    const Span span{std::max(dispatch.start_ms, free_ms), dispatch.device_ms.value_or(dispatch.wall_ms)};
    free_ms = span.start_ms + span.length_ms;
    events.push_back(complete_event(device_track, dispatch.name, "pass", span, dispatch_arguments(dispatch)));
  }
}

}  // namespace

std::string chrome_trace(const RunRecord& run) {
  Json events = Json::array();
  events.push_back(name_event("process_name", host_track, "lodestone " + run.command));
  events.push_back(name_event("thread_name", host_track, "host"));
  events.push_back(
      name_event("thread_name", device_track, fmt::format("{} ({})", run.device.name, run.device.kind)));
  for (const Stage& stage : run.precompute)
    events.push_back(complete_event(host_track, stage.name, "precompute", {stage.start_ms, stage.wall_ms},
                                    Json::object()));
  double free_ms = 0;
  add_dispatches(run.setup, free_ms, events);
  for (const Frame& frame : run.frames) {
    events.push_back(complete_event(host_track, fmt::format("frame {}", frame.frame), "frame",
                                    {frame.start_ms, frame.wall_ms}, {{"time_s", frame.time_s}}));
    add_dispatches(frame.dispatches, free_ms, events);
  }
  const Json trace = {{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}};
  return trace.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lodestone::report
