// SPDX-License-Identifier: MIT
// Runs with known figures for the tests of the reports.
#pragma once

#include <string>

#include "lodestone/report/measurements.h"

namespace lodestone::report::testing {

inline Dispatch dispatch(const std::string& name, double start_ms, double wall_ms) {
  Dispatch result;
  result.name = name;
  result.start_ms = start_ms;
  result.wall_ms = wall_ms;
  result.invocations = 64;
  return result;
}

inline Dispatch device_dispatch(const std::string& name, double start_ms, double device_ms) {
  Dispatch result = dispatch(name, start_ms, device_ms + 1);
  result.device_ms = device_ms;
  return result;
}

inline Dispatch counted_dispatch(const std::string& name, uint64_t rays) {
  Dispatch result = device_dispatch(name, 0, 2);
  result.counters = Counters{.bytes_read = 8000000,
                             .bytes_written = 1000000,
                             .rays = rays,
                             .node_visits = 10 * rays,
                             .box_tests = 20 * rays,
                             .triangle_tests = 3 * rays,
                             .lane_steps = 30,
                             .subgroup_steps = 40};
  return result;
}

// Two frames of 500 ms on a GPU.
inline RunRecord gpu_run() {
  RunRecord run;
  run.version = "1.2.3";
  run.command = "render";
  run.tracer = "geometry-image";
  run.device = {"gpu", "llvmpipe", "Mesa 22.3.6", "1.3.230"};
  run.scene = {"spot.obj", 5856, 2930, 2, 7};
  run.image = {640, 360, 4, ""};
  run.precompute = {{"charts", 1, 12.5}};
  run.setup = {dispatch("links", 20, 1)};
  for (uint32_t i = 0; i < 2; ++i) {
    Frame frame;
    frame.frame = 10 + i;
    frame.time_s = 0.25 * i;
    frame.start_ms = 100 + 500 * i;
    frame.wall_ms = 500;
    run.frames.push_back(frame);
  }
  run.device_bytes = 3000000;
  return run;
}

}  // namespace lodestone::report::testing
