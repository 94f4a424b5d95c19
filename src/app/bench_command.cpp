// SPDX-License-Identifier: MIT
#include "lodestone/app/bench_command.h"

#include <fmt/format.h>
#include <CLI/App.hpp>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "lodestone/app/bench_rays.h"
#include "lodestone/app/clock.h"
#include "lodestone/app/common_options.h"
#include "lodestone/app/measure.h"
#include "lodestone/app/open_device.h"
#include "lodestone/app/prepared_scene.h"
#include "lodestone/app/thread_limit.h"
#include "lodestone/app/version.h"
#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/layout/atlas.h"

namespace lodestone::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t max_repeats = 10000;

struct BenchOptions {
  SceneOptions scene;
  PoseOptions pose;
  uint32_t relaxation_sweeps = 0;
  float pixels_of_error = 0;
  PictureOptions picture;
  DeviceOptions device;
  double time = 0;
  uint32_t repeats = 5;
  std::vector<std::string> traversals = {"auto"};
  bool json = false;
};

struct Spread {
  double median = 0, min = 0, max = 0;
};

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
  return {median, values.front(), values.back()};
}

struct PassCost {
  std::string name;
  Spread ms;
};

struct RayCost {
  std::string kind;
  uint64_t rays = 0, hits = 0;
  Spread ms;

  Spread mrays_per_s() const {
    const auto rate = [&](double milliseconds) { return double(rays) / milliseconds / 1e3; };
    return {rate(ms.median), rate(ms.max), rate(ms.min)};
  }
};

struct TraversalCost {
  std::string tracer, traversal;
  std::vector<PassCost> update;
  Spread update_ms;  // all passes of an update
  std::vector<RayCost> rays;
};

double milliseconds(const report::PassSum& pass) {
  return pass.device_ms.value_or(pass.wall_ms);
}

// What the passes cost that `work` enqueues: device time where the device measures it, else the host's.
template <class Work>
std::vector<report::PassSum> measure(render::Backend& backend, Work work) {
  work();
  return report::sum_by_name(to_dispatches(backend.finish(), 0));
}

double total(const std::vector<report::PassSum>& passes) {
  double sum = 0;
  for (const report::PassSum& pass : passes) sum += milliseconds(pass);
  return sum;
}

void bench_update(const BenchOptions& options, const scene::Pose& pose, const render::View& view,
                  render::Backend& backend, render::Renderer& renderer, TraversalCost& cost) {
  std::vector<std::string> names;
  std::vector<std::vector<double>> times;
  std::vector<double> totals;
  measure(backend, [&] { renderer.update(pose, &view); });  // warms up
  for (uint32_t repeat = 0; repeat < options.repeats; ++repeat) {
    const auto passes = measure(backend, [&] { renderer.update(pose, &view); });
    times.resize(passes.size());
    names.resize(passes.size());
    for (size_t i = 0; i < passes.size(); ++i) {
      names[i] = passes[i].name;
      times[i].push_back(milliseconds(passes[i]));
    }
    totals.push_back(total(passes));
  }
  for (size_t i = 0; i < names.size(); ++i) cost.update.push_back({names[i], spread_of(times[i])});
  cost.update_ms = spread_of(totals);
}

RayCost bench_rays(const BenchOptions& options, const std::string& kind, const Rays& rays,
                   render::Backend& backend, render::Renderer& renderer) {
  RayCost cost;
  cost.kind = kind;
  cost.rays = rays.size() / 2;
  renderer.load_rays(rays);
  measure(backend, [&] { renderer.trace_loaded(); });  // warms up
  for (const glm::uvec4& hit : renderer.hits()) cost.hits += hit.w != layout::no_index;
  std::vector<double> times;
  for (uint32_t repeat = 0; repeat < options.repeats; ++repeat)
    times.push_back(total(measure(backend, [&] { renderer.trace_loaded(); })));
  cost.ms = spread_of(times);
  return cost;
}

TraversalCost bench_traversal(const BenchOptions& options, const PreparedScene& prepared,
                              const render::View& view, render::Backend& backend,
                              const std::string& traversal, const Rays& primary, const Rays& incoherent) {
  render::Settings settings;
  settings.width = options.picture.size.width;
  settings.height = options.picture.size.height;
  settings.relaxation_sweeps = options.relaxation_sweeps;
  settings.pixels_of_error = options.pixels_of_error;
  settings.device_memory = options.device.memory;
  settings.traversal = parse_traversal("--traversal", traversal);
  render::Renderer renderer(backend, prepared.scene, prepared.assembly, prepared.atlas, settings);
  TraversalCost cost;
  cost.tracer = tracer_names().front();
  cost.traversal = to_string(renderer.traversal());
  bench_update(options, prepared.pose_at(prepared.wrap(options.time)), view, backend, renderer, cost);
  cost.rays.push_back(bench_rays(options, "primary", primary, backend, renderer));
  cost.rays.push_back(bench_rays(options, "incoherent", incoherent, backend, renderer));
  return cost;
}

Json to_json(const Spread& spread) {
  return {{"median", spread.median}, {"min", spread.min}, {"max", spread.max}};
}

std::string json_text(const BenchOptions& options, const PreparedScene& prepared,
                      const render::DeviceInfo& device, const std::vector<TraversalCost>& costs) {
  Json results = Json::array();
  for (const TraversalCost& cost : costs) {
    Json update = Json::array(), rays = Json::array();
    for (const PassCost& pass : cost.update)
      update.push_back({{"name", pass.name}, {"ms", to_json(pass.ms)}});
    for (const RayCost& kind : cost.rays)
      rays.push_back({{"kind", kind.kind},
                      {"rays", kind.rays},
                      {"hits", kind.hits},
                      {"ms", to_json(kind.ms)},
                      {"mrays_per_s", to_json(kind.mrays_per_s())}});
    results.push_back({{"tracer", cost.tracer},
                       {"traversal", cost.traversal},
                       {"update", update},
                       {"update_ms", to_json(cost.update_ms)},
                       {"rays", rays}});
  }
  const Json json = {
      {"lodestone", version()},
      {"command", "bench"},
      {"device", {{"kind", device.kind}, {"name", device.name}, {"driver", device.driver}}},
      {"scene", {{"file", options.scene.scene}, {"triangles", prepared.assembly.triangles.size()}}},
      {"repeats", options.repeats},
      {"results", results}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string table(const BenchOptions& options, const PreparedScene& prepared,
                  const render::DeviceInfo& device, const std::vector<TraversalCost>& costs) {
  constexpr const char* row = "{:<16} {:<10} {:<18} {:>10} {:>10} {:>10}  {}\n";
  std::string text = fmt::format("{}: {} triangles on {}, median, min and max of {}\n", options.scene.scene,
                                 prepared.assembly.triangles.size(), device.name, options.repeats);
  text += fmt::format(fmt::runtime(row), "tracer", "traversal", "what", "median", "min", "max", "unit");
  const auto add = [&](const TraversalCost& cost, const std::string& what, const Spread& spread,
                       const std::string& unit) {
    text += fmt::format(fmt::runtime(row), cost.tracer, cost.traversal, what,
                        fmt::format("{:.3f}", spread.median), fmt::format("{:.3f}", spread.min),
                        fmt::format("{:.3f}", spread.max), unit);
  };
  for (const TraversalCost& cost : costs) {
    for (const PassCost& pass : cost.update) add(cost, pass.name, pass.ms, "ms");
    add(cost, "update", cost.update_ms, "ms");
    for (const RayCost& kind : cost.rays)
      add(cost, kind.kind, kind.mrays_per_s(),
          fmt::format("Mrays/s ({} rays, {:.1f} % hit)", kind.rays,
                      100 * double(kind.hits) / double(kind.rays)));
  }
  return text;
}

int run_bench(const BenchOptions& options) {
  const ThreadLimit threads(options.device.backend.threads);
  OpenDevice device = open_device(options.device);
  const PreparedScene prepared = prepare_scene(options.scene, options.pose);
  const scene::Pose pose = prepared.pose_at(prepared.wrap(options.time));
  scene::Bounds bounds;
  if (options.picture.camera.needs_bounds(prepared.scene)) bounds = prepared.bounds();
  const render::View view = view_of(prepared, pose, options.picture, bounds);
  const Rays primary = primary_rays(view, options.picture.size);
  const Rays incoherent = incoherent_rays(prepared, pose, uint32_t(primary.size() / 2), options.picture.seed);
  std::vector<TraversalCost> costs;
  for (const std::string& traversal : options.traversals)
    costs.push_back(
        bench_traversal(options, prepared, view, *device.backend, traversal, primary, incoherent));
  const render::DeviceInfo& info = device.backend->info();
  fmt::print(
      "{}", options.json ? json_text(options, prepared, info, costs) : table(options, prepared, info, costs));
  return int(ExitCode::done);
}

}  // namespace

void add_bench_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* command = app.add_subcommand("bench", "Measure rays per second and the cost of every pass");
  auto shared = std::make_shared<BenchOptions>();
  BenchOptions& options = *shared;
  add_scene_argument(*command, options.scene);
  add_atlas_options(*command, options.scene);
  add_relaxation_option(*command, options.scene, options.relaxation_sweeps);
  add_detail_option(*command, options.scene, options.pixels_of_error);
  add_value(*command, "--tracer", "LIST",
            fmt::format("Tracers: {} (default: all)", join_names(tracer_names())),
            [](const std::string& text) {
              for (const std::string& name : parse_list("--tracer", text))
                parse_choice("--tracer", name, tracer_names());
            });
  add_value(*command, "--traversal", "LIST", "Traversals: auto (default), threaded, octant, wide, tile",
            [&](const std::string& text) {
              options.traversals = parse_list("--traversal", text);
              for (const std::string& name : options.traversals) parse_traversal("--traversal", name);
            });
  add_size_option(*command, options.picture.size);
  add_camera_options(*command, options.picture.camera);
  add_seed_option(*command, options.picture.seed);
  add_value(*command, "--time", "S", "Time of the pose in seconds (default: 0)",
            [&](const std::string& text) { options.time = parse_number("--time", text, 0, 1e9); });
  add_value(*command, "--repeats", "N", "Measurements after one that warms up (default: 5)",
            [&](const std::string& text) {
              options.repeats = uint32_t(parse_count("--repeats", text, 1, max_repeats));
            });
  add_pose_options(*command, options.pose);
  add_device_options(*command, options.device);
  command->add_flag("--json", options.json, "Print JSON");
  add_log_options(*command);
  command->footer("Example: lodestone bench spot.obj --device cpu --traversal threaded,wide");
  command->callback([shared, &run] { run = [shared] { return run_bench(*shared); }; });
}

}  // namespace lodestone::app
