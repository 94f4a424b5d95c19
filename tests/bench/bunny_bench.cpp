// SPDX-License-Identifier: MIT
// Figure 10 of the paper: eye rays at the Stanford bunny, one picture, through a plain threaded BVH, a
// uniform grid, Embree, and geometry images. All find what Embree in robust mode finds on the same triangles,
// or this fails. bunny_bench [--scene stanford_bunny.obj]
// [--size 512] [--rounds N] [--devices cpu,llvmpipe] [--resolutions 128,256] [--density 5] [--parts FOLDER]
// [--svg FILE]
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/scene/load.h"
#include "lodestone/test_support/bench_main.h"
#include "lodestone/test_support/contender.h"
#include "lodestone/test_support/embree_scene.h"
#include "lodestone/test_support/markdown_table.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/ratio_plot.h"
#include "lodestone/test_support/rounds.h"
#include "threaded_bvh.h"
#include "threaded_kernel.h"
#include "uniform_grid.h"

namespace lodestone::test {
namespace {

struct Choice {
  std::string scene = "stanford_bunny.obj";
  std::vector<uint32_t> resolutions{128, 256};
  std::vector<std::string> devices{"cpu", "llvmpipe"};
  uint32_t size = 512;
  int rounds = 11;
  float density = usual_density;
  std::string parts, svg;
};

struct PaperRow {
  const char *tracer, *hardware;
  uint32_t triangles;
  double ms;
};
constexpr double paper_bvh_ms = 257;
constexpr PaperRow paper_rows[] = {
    {"threaded BVH (Thrane and Simonsen)", "GeForce 6800 Ultra", 70000, paper_bvh_ms},
    {"uniform grid", "X800 XT PE", 70000, 357},
    {"kd-tree, backtrack (Foley and Sugerman)", "X800 XT PE", 70000, 690},
    {"kd-tree, restart", "X800 XT PE", 70000, 701},
    {"geometry image 128 x 128", "GeForce 6800 Ultra", 32768, 180},
    {"geometry image 256 x 256", "GeForce 6800 Ultra", 131000, 675}};

// What a tracer found for a ray: t, infinite for a miss.
using Distances = std::vector<float>;

Distances distances_of(const std::vector<TriangleHit>& hits) {
  Distances t;
  for (const TriangleHit& hit : hits) t.push_back(hit.triangle == no_triangle ? INFINITY : hit.t);
  return t;
}
Distances distances_of(const std::vector<glm::uvec4>& hits) {
  Distances t;
  for (const glm::uvec4& hit : hits)
    t.push_back(hit.w == layout::no_index ? INFINITY : std::bit_cast<float>(hit.x));
  return t;
}
Distances distances_of(const std::vector<EmbreeHit>& hits) {
  Distances t;
  for (const EmbreeHit& hit : hits) t.push_back(hit.triangle == ~0u ? INFINITY : hit.t);
  return t;
}

// Of 100,000 rays one may differ, by more than a hundred-thousandth of the scene's size or in whether it
// hits.
void check_distances(const std::string& tracer, const Distances& found, const Distances& truth,
                     float scene_size) {
  uint64_t different = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    const bool both_miss = std::isinf(found[i]) && std::isinf(truth[i]);
    if (!both_miss && !(std::abs(found[i] - truth[i]) <= 1e-5f * scene_size)) ++different;
  }
  if (found.size() != truth.size() || double(different) > 1e-5 * double(truth.size()))
    fail(ExitCode::different, tracer, "{} of {} rays find something else than Embree does", different,
         truth.size());
}

struct Entry {
  std::string tracer, where;
  uint64_t triangles;
  std::function<void()> trace;
  size_t base;                               // the threaded BVH that it is compared with
  double steps = NAN, triangle_tests = NAN;  // a ray
  std::vector<double> times{}, ratios{};     // seconds; times as fast as the base
};

class Bench {
 public:
  explicit Bench(const Choice& choice)
      : choice_(choice),
        scene_(scene::load(data_file(choice.scene).value_or(choice.scene))),
        assembly_(scene::assemble(scene_)),
        pose_(scene::evaluate(scene_, scene::none, 0)) {
    const scene::Bounds bounds = scene::pose_bounds(scene_, pose_);
    scene_size_ = glm::length(bounds.hi - bounds.lo);
    rays_ =
        primary_rays(render::find_view(scene_, pose_, "auto", bounds, choice.size, choice.size), choice.size);
    const std::vector<glm::vec3> points = scene::rest_positions(scene_, assembly_);
    std::vector<glm::uvec3> triangles(assembly_.triangles.begin(), assembly_.triangles.end());
    robust_ = std::make_unique<EmbreeScene>(points, triangles, true);
    fast_ = std::make_unique<EmbreeScene>(points, triangles, false);
    bvh_ = std::make_unique<ThreadedBvh>(triangles_of(points, triangles));
    grid_ = std::make_unique<UniformGrid>(bvh_->triangles(), choice.density);
    truth_ = truth_of(*robust_);
    hits_ = uint64_t(std::count_if(truth_.begin(), truth_.end(), [](float t) { return !std::isinf(t); }));
    add_plain_tracers();
    for (const std::string& device : choice.devices) add_device(device);
  }

  void run() {
    for (int round = -1; round < choice_.rounds; ++round) {  // the first does not count
      std::vector<double> took;
      for (const Entry& entry : entries_) took.push_back(seconds(entry.trace));
      if (round < 0) continue;
      for (size_t i = 0; i < entries_.size(); ++i) {
        entries_[i].times.push_back(took[i]);
        entries_[i].ratios.push_back(took[entries_[i].base] / took[i]);
      }
    }
  }

  std::string table() const {
    std::vector<TableRow> rows;
    const auto number = [](double value) {
      return std::isnan(value) ? std::string() : fmt::format("{:.1f}", value);
    };
    for (const Entry& entry : entries_) {
      rows.push_back({entry.tracer, entry.where, std::to_string(entry.triangles),
                      fmt::format("{:.1f}", 1e3 * median(entry.times)), spread(entry.ratios),
                      number(entry.steps), number(entry.triangle_tests)});
    }
    return markdown_table({"tracer", "where", "triangles", "ms", "times as fast as the threaded BVH there",
                           "nodes or cells a ray", "triangles tested a ray"},
                          rows);
  }

  std::string plot() const {
    std::vector<RatioGroup> groups{{"the paper's, on GPUs", {}}};
    for (const PaperRow& row : paper_rows) groups.back().bars.push_back({row.tracer, paper_bvh_ms / row.ms});
    for (size_t i = 0; i < entries_.size(); ++i) {
      const Entry& entry = entries_[i];
      if (entry.base == i)
        groups.push_back({i == 0 ? "here, each with code of its own, on the CPU"
                                 : "here, Lodestone's kernels on " + entry.where,
                          {}});
      groups.back().bars.push_back({entry.tracer, median(entry.ratios)});
    }
    return ratio_plot(groups, "times as fast as the threaded BVH of the same group");
  }

  std::string rays_text() const {
    return fmt::format(
        "`{}`, {} x {} rays, {:.1f} % of which hit; the grid has {} x {} x {} cells and {:.1f} references a "
        "triangle",
        choice_.scene, choice_.size, choice_.size, 100 * double(hits_) / double(truth_.size()),
        grid_->cells().x, grid_->cells().y, grid_->cells().z,
        double(grid_->reference_count()) / double(grid_->triangles().size()));
  }

 private:
  Distances truth_of(const EmbreeScene& scene) const {
    std::vector<EmbreeHit> hits;
    scene.intersect(rays_, hits);
    return distances_of(hits);
  }

  EmbreeCall fastest_call() {
    EmbreeCall best = EmbreeCall::one;
    double least = std::numeric_limits<double>::max();
    for (int turn = 0; turn < 5; ++turn) {
      for (const EmbreeCall call : {EmbreeCall::one, EmbreeCall::eight, EmbreeCall::stream}) {
        const double took = seconds([&] { fast_->intersect(rays_, embree_hits_, call); });
        if (turn > 0 && took < least) {
          least = took;
          best = call;
        }
      }
    }
    return best;
  }

  void add_plain_tracers() {
    const uint64_t triangles = assembly_.triangles.size();
    const double rays = double(truth_.size());
    bvh_->intersect(rays_, plain_hits_);
    check_distances("threaded BVH", distances_of(plain_hits_), truth_, scene_size_);
    grid_->intersect(rays_, plain_hits_);
    check_distances("uniform grid", distances_of(plain_hits_), truth_, scene_size_);
    const TraceCounts of_bvh = bvh_->count(rays_), of_grid = grid_->count(rays_);
    entries_.push_back({"threaded BVH, plain C++", "cpu", triangles,
                        [this] { bvh_->intersect(rays_, plain_hits_); }, 0, double(of_bvh.steps) / rays,
                        double(of_bvh.triangle_tests) / rays});
    entries_.push_back({"uniform grid, plain C++", "cpu", triangles,
                        [this] { grid_->intersect(rays_, plain_hits_); }, 0, double(of_grid.steps) / rays,
                        double(of_grid.triangle_tests) / rays});
    const EmbreeCall call = fastest_call();
    entries_.push_back({fmt::format("Embree, rtcIntersect{}", to_string(call)), "cpu", triangles,
                        [this, call] { fast_->intersect(rays_, embree_hits_, call); }, 0});
  }

  void add_device(const std::string& device) {
    const size_t base = entries_.size();
    const double rays = double(truth_.size());
    render::BackendOptions counting;
    counting.counters = true;
    ThreadedKernel& kernel = *kernels_.emplace_back(std::make_unique<ThreadedKernel>(*bvh_, device));
    kernel.load_rays(rays_);
    kernel.trace();
    check_distances("threaded BVH in our kernel on " + device, distances_of(kernel.hits()), truth_,
                    scene_size_);
    ThreadedKernel counted(*bvh_, device, counting);
    counted.load_rays(rays_);
    counted.trace();
    const render::Counters counts = counted.take_counters();
    entries_.push_back({"threaded BVH, kernel threaded", device, assembly_.triangles.size(),
                        [&kernel] { kernel.trace(); }, base, double(counts.node_visits) / rays,
                        double(counts.triangle_tests) / rays});
    for (const uint32_t resolution : choice_.resolutions) {
      for (const char* traversal : {"threaded", "auto"})
        add_geometry_image(device, resolution, traversal, base);
    }
  }

  void add_geometry_image(const std::string& device, uint32_t resolution, const std::string& traversal,
                          size_t base) {
    const ReadyScene& ready = image(resolution);
    render::BackendOptions counting;
    counting.counters = true;
    Contender& contender = *contenders_.emplace_back(
        std::make_unique<Contender>(ready, device, render::BackendOptions{}, traversal));
    contender.renderer().update(pose_);
    contender.renderer().load_rays(rays_);
    contender.renderer().trace_loaded();
    const std::vector<glm::vec3> texels = ready.texels(pose_);
    const QuadTriangles quads = quad_triangles(ready.atlas);
    check_distances(fmt::format("geometry image {} on {}", resolution, device),
                    distances_of(contender.renderer().hits()),
                    truth_of(EmbreeScene(texels, quads.texels, true)), scene_size_);
    Contender counted(ready, device, counting, traversal);
    counted.renderer().update(pose_);
    counted.take_passes();
    counted.renderer().load_rays(rays_);
    counted.renderer().trace_loaded();
    const render::Counters counts = counted.take_counters("trace");
    const double rays = double(truth_.size());
    entries_.push_back({fmt::format("geometry image {0} x {0}, {1}", resolution,
                                    to_string(contender.renderer().traversal())),
                        device, quads.texels.size(), [&contender] { contender.renderer().trace_loaded(); },
                        base, double(counts.node_visits) / rays, double(counts.triangle_tests) / rays});
  }

  const ReadyScene& image(uint32_t resolution) {
    auto& ready = images_[resolution];
    if (ready == nullptr) {
      geometry_image::AtlasSettings settings(geometry_image::AtlasKind::charts);
      settings.charts.texel_budget = uint64_t(resolution) * resolution;
      ready = std::make_unique<ReadyScene>(scene_, settings);
    }
    return *ready;
  }

  const Choice& choice_;
  scene::Scene scene_;
  scene::Assembly assembly_;
  scene::Pose pose_;
  float scene_size_ = 0;
  Rays rays_;
  std::unique_ptr<EmbreeScene> robust_, fast_;
  std::unique_ptr<ThreadedBvh> bvh_;
  std::unique_ptr<UniformGrid> grid_;
  Distances truth_;
  uint64_t hits_ = 0;
  std::vector<TriangleHit> plain_hits_;
  std::vector<EmbreeHit> embree_hits_;
  std::map<uint32_t, std::unique_ptr<ReadyScene>> images_;
  std::vector<std::unique_ptr<ThreadedKernel>> kernels_;
  std::vector<std::unique_ptr<Contender>> contenders_;
  std::vector<Entry> entries_;
};

std::string paper_table() {
  std::vector<TableRow> rows;
  for (const PaperRow& row : paper_rows) {
    rows.push_back({row.tracer, row.hardware, std::to_string(row.triangles), fmt::format("{:.0f}", row.ms),
                    fmt::format("{:.2f}", paper_bvh_ms / row.ms)});
  }
  return markdown_table({"the paper's", "on", "triangles", "ms", "times as fast as the threaded BVH"}, rows);
}

void bench(const Choice& choice) {
  Bench bench(choice);
  bench.run();
  fmt::print("{}\n{}", bench.rays_text(), bench.table());
  if (!choice.svg.empty()) write_file(choice.svg, bench.plot());
  if (choice.parts.empty()) return;
  const std::filesystem::path folder = choice.parts;
  write_file(folder / "bunny-paper.md", paper_table());
  write_file(folder / "bunny.md", bench.table());
  write_file(folder / "bunny-rays.md", bench.rays_text());
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  using namespace lodestone::test;
  Choice choice;
  CLI::App app("Figure 10 of the paper: the bunny through several tracers", "bunny_bench");
  app.add_option("--scene", choice.scene, "A file, also of the shared data folder, or builtin:NAME");
  app.add_option("--resolutions", choice.resolutions, "Geometry images of N x N texels")
      ->delimiter(',')
      ->check(CLI::Range(2, 32768));
  app.add_option("--size", choice.size, "The picture has N x N pixels, N a multiple of 8")
      ->check(CLI::Range(8, 4096));
  app.add_option("--rounds", choice.rounds, "Turns of each")->check(CLI::Range(1, 10000));
  app.add_option("--devices", choice.devices, "cpu, or a part of a device's name")->delimiter(',');
  app.add_option("--density", choice.density, "Cells of the uniform grid a triangle")
      ->check(CLI::Range(0.01, 1000.0));
  app.add_option("--parts", choice.parts, "Write tables of Markdown to this folder");
  app.add_option("--svg", choice.svg, "Write the plot to this file");
  return bench_main(app, argc, argv, [&] { bench(choice); });
}
