// SPDX-License-Identifier: MIT
// What a run measured, as plain data: the app fills it in, the writers of this folder print it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace lodestone::report {

// Sums of what the kernels counted.
struct Counters {
  uint64_t bytes_read = 0, bytes_written = 0;
  uint64_t rays = 0, node_visits = 0, box_tests = 0, triangle_tests = 0;
  uint64_t lane_steps = 0, subgroup_steps = 0;  // their quotient is the share of active lanes

  Counters& operator+=(const Counters& other);
  // lane_steps / subgroup_steps; nothing where no subgroup took a step.
  std::optional<double> active_lanes() const;
};

// One dispatch of a pass.
struct Dispatch {
  std::string name;
  double start_ms = 0;  // host clock, since the program started
  double wall_ms = 0;
  std::optional<double> device_ms;  // timestamps; nothing on the CPU and on the first dispatch of a kernel
  uint64_t invocations = 0;
  std::optional<Counters> counters;  // nothing where they were not counted
};

// All dispatches of one pass, added up.
struct PassSum {
  std::string name;
  uint64_t calls = 0;
  std::optional<double> device_ms;  // of the dispatches that have one; nothing where none has
  double wall_ms = 0;
  uint64_t invocations = 0;
  std::optional<Counters> counters;
};

// One row a pass name, in order of first appearance.
std::vector<PassSum> sum_by_name(const std::vector<Dispatch>& dispatches);

// A step of the host, e.g. `charts`.
struct Stage {
  std::string name;
  double start_ms = 0;  // host clock, since the program started
  double wall_ms = 0;
};

struct Frame {
  uint32_t frame = 0;
  double time_s = 0;  // of the animation
  double start_ms = 0, wall_ms = 0;
  std::vector<Dispatch> dispatches;
};

struct RunRecord {
  std::string version, command, tracer;
  struct {
    std::string kind, name, driver, api;  // empty: the device has none
  } device;
  struct {
    std::string file;
    uint64_t triangles = 0, vertices = 0, morph_targets = 0, joints = 0;
  } scene;
  struct {
    uint32_t width = 0, height = 0, spp = 0;
    std::string denoise;  // what was done to the pictures after their samples; empty: nothing
  } image;
  struct {
    uint64_t charts = 0, quads = 0, texels = 0;
  } atlas;
  struct {
    std::string integrator, traversal, camera, clip;  // the last is empty where nothing is played
    uint32_t seed = 0;
  } settings;
  std::vector<Stage> precompute;
  std::vector<Dispatch> setup;  // passes that ran once, before the first frame
  std::vector<Frame> frames;
  uint64_t device_bytes = 0;
  struct {
    uint32_t portions = 0;  // of a scene that is larger than the device's memory; 0: it is not
    uint64_t loads = 0, peak_bytes = 0;
  } streaming;
};

// All dispatches of all frames.
std::vector<Dispatch> frame_dispatches(const RunRecord& run);

}  // namespace lodestone::report
