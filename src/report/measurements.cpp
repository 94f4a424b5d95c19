// SPDX-License-Identifier: MIT
#include "lodestone/report/measurements.h"

#include <algorithm>

namespace lodestone::report {

Counters& Counters::operator+=(const Counters& other) {
  bytes_read += other.bytes_read;
  bytes_written += other.bytes_written;
  rays += other.rays;
  node_visits += other.node_visits;
  box_tests += other.box_tests;
  triangle_tests += other.triangle_tests;
  lane_steps += other.lane_steps;
  subgroup_steps += other.subgroup_steps;
  return *this;
}

std::optional<double> Counters::active_lanes() const {
  if (subgroup_steps == 0) return std::nullopt;
  return double(lane_steps) / double(subgroup_steps);
}

std::vector<PassSum> sum_by_name(const std::vector<Dispatch>& dispatches) {
  std::vector<PassSum> sums;
  for (const Dispatch& dispatch : dispatches) {
    auto sum = std::find_if(sums.begin(), sums.end(),
                            [&](const PassSum& other) { return other.name == dispatch.name; });
    if (sum == sums.end()) {
      sum = sums.emplace(sums.end());
      sum->name = dispatch.name;
    }
    ++sum->calls;
    if (dispatch.device_ms) sum->device_ms = sum->device_ms.value_or(0) + *dispatch.device_ms;
    sum->wall_ms += dispatch.wall_ms;
    sum->invocations += dispatch.invocations;
    if (dispatch.counters) {
      if (!sum->counters) sum->counters = Counters();
      *sum->counters += *dispatch.counters;
    }
  }
  return sums;
}

std::vector<Dispatch> frame_dispatches(const RunRecord& run) {
  std::vector<Dispatch> all;
  for (const Frame& frame : run.frames)
    all.insert(all.end(), frame.dispatches.begin(), frame.dispatches.end());
  return all;
}

}  // namespace lodestone::report
