// SPDX-License-Identifier: MIT
// Whole frames of an animation: ours blend the vertices, rasterise, bound and trace the primary rays of a
// picture; beside them Embree on the input's triangles, the same vertices blended on as many threads
// (positions only), the tree refitted or rebuilt at low quality, the same rays traced by the fastest of its
// calls. Poses go through the first clip; all take turns at each. frame_bench [--scenes
// ict_face_sparse.glb,...] [--budgets 1] [--devices cpu,llvmpipe] [--rounds N]
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/scene/load.h"
#include "lodestone/test_support/bench_main.h"
#include "lodestone/test_support/charts_choice.h"
#include "lodestone/test_support/contender.h"
#include "lodestone/test_support/embree_scene.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/rays.h"
#include "lodestone/test_support/rounds.h"

namespace lodestone::test {
namespace {

using geometry_image::AtlasKind;

// Seconds of the stages of a frame, one a round; `bound`: refit, rebuild, or our bounds.
struct Stages {
  std::vector<double> blend, rasterise, bound, trace, frame;
};

class EmbreeFrame {
 public:
  EmbreeFrame(const ReadyScene& ready, const Rays& rays, EmbreeBuild build)
      : ready_(ready),
        rays_(rays),
        embree_(blended(ready.pose(0)), triangles(ready.assembly), false, build) {}

  void run(const scene::Pose& pose) {
    std::vector<glm::vec3> points;
    stages_.blend.push_back(seconds([&] { points = blended(pose); }));
    stages_.bound.push_back(seconds([&] { embree_.update(points); }));
    stages_.trace.push_back(seconds([&] { embree_.intersect(rays_, hits_, call_); }));
    stages_.frame.push_back(stages_.blend.back() + stages_.bound.back() + stages_.trace.back());
  }

  // The call that takes least in the best of three turns.
  void choose_call() {
    double least = std::numeric_limits<double>::max();
    for (const EmbreeCall call : {EmbreeCall::one, EmbreeCall::eight, EmbreeCall::stream}) {
      for (int turn = 0; turn < 3; ++turn) {
        const double took = seconds([&] { embree_.intersect(rays_, hits_, call); });
        if (took < least) call_ = call;
        least = std::min(least, took);
      }
    }
  }
  const char* call() const { return to_string(call_); }

  const Stages& stages() const { return stages_; }
  void forget() { stages_ = {}; }

 private:
  std::vector<glm::vec3> blended(const scene::Pose& pose) const {
    return scene::blended_positions(ready_.assembly,
                                    scene::frame_weights(ready_.scene, ready_.assembly, pose),
                                    scene::frame_matrices(ready_.scene, ready_.assembly, pose));
  }
  static std::vector<glm::uvec3> triangles(const scene::Assembly& assembly) {
    return {assembly.triangles.begin(), assembly.triangles.end()};
  }

  const ReadyScene& ready_;
  const Rays& rays_;
  EmbreeScene embree_;
  EmbreeCall call_ = EmbreeCall::one;
  std::vector<EmbreeHit> hits_;
  Stages stages_;
};

class OurFrame {
 public:
  OurFrame(std::string name, const ReadyScene& ready, const Rays& rays, const std::string& device)
      : name_(std::move(name)), contender_(ready, device) {
    contender_.renderer().load_rays(rays);
  }

  void run(const scene::Pose& pose) {
    contender_.take_passes();
    PassSeconds passes;
    stages_.frame.push_back(seconds([&] {
      contender_.renderer().update(pose);
      contender_.renderer().trace_loaded();
      passes = contender_.take_passes();
    }));
    stages_.blend.push_back(passes.at("blend"));
    stages_.rasterise.push_back(passes.at("rasterise"));
    stages_.bound.push_back(passes.at("bounds"));
    stages_.trace.push_back(passes.at("trace"));
  }

  const std::string& name() const { return name_; }
  const Stages& stages() const { return stages_; }
  void forget() { stages_ = {}; }

 private:
  std::string name_;
  Contender contender_;
  Stages stages_;
};

void print(const std::string& name, const Stages& stages, const std::string& times) {
  const auto ms = [](const std::vector<double>& values) {
    return values.empty() ? std::string("-") : fmt::format("{:.2f}", 1e3 * median(values));
  };
  fmt::print("{:<16} {:>8} {:>9} {:>8} {:>8} {:>8}  {}\n", name, ms(stages.blend), ms(stages.rasterise),
             ms(stages.bound), ms(stages.trace), ms(stages.frame), times);
}

// Against the faster of the two Embrees, round by round.
std::string times_as_fast(const EmbreeFrame& refit, const EmbreeFrame& rebuild, const Stages& ours) {
  Rounds rounds;
  for (size_t i = 0; i < ours.frame.size(); ++i)
    rounds.add(std::min(refit.stages().frame[i], rebuild.stages().frame[i]), ours.frame[i]);
  return spread(rounds.ratio);
}

void bench(const std::string& name, const ChartsChoice& choice) {
  const ReadyScene exact(data_file(name).value_or(name), AtlasKind::exact);
  if (exact.animation == scene::none) fail_input(name, "has no animation whose frames could be timed");
  std::vector<std::pair<std::string, ReadyScene>> charts;
  for (const double budget : choice.budgets)
    charts.emplace_back(fmt::format("charts {:g}", budget), with_charts(exact, budget));
  const scene::Pose first = exact.pose(0);
  const auto view = render::find_view(exact.scene, first, "", scene::pose_bounds(exact.scene, first),
                                      choice.size, choice.size);
  const Rays rays = primary_rays(view, choice.size);
  const float duration = exact.scene.animations[exact.animation].duration();
  for (const std::string& device : choice.devices) {
    EmbreeFrame refit(exact, rays, EmbreeBuild::dynamic_refit);
    EmbreeFrame rebuild(exact, rays, EmbreeBuild::dynamic_low_quality);
    std::vector<OurFrame> ours;
    ours.emplace_back("exact", exact, rays, device);
    for (const auto& [label, ready] : charts) ours.emplace_back(label, ready, rays, device);
    const auto turn = [&](float time) {
      const scene::Pose pose = exact.pose(time);
      refit.run(pose);
      rebuild.run(pose);
      for (OurFrame& frame : ours) frame.run(pose);
    };
    refit.choose_call();
    rebuild.choose_call();
    turn(0);  // first touches, and what a driver compiles
    refit.forget();
    rebuild.forget();
    for (OurFrame& frame : ours) frame.forget();
    for (int round = 0; round < choice.rounds; ++round)
      turn(duration * (float(round) + 0.5f) / float(choice.rounds));
    fmt::print("\n{}: {} triangles, {} vertices, {} x {} primary rays; ours on {}\n", name,
               exact.assembly.triangles.size(), exact.assembly.positions.size(), choice.size, choice.size,
               device);
    fmt::print("{:<16} {:>8} {:>9} {:>8} {:>8} {:>8}  {}\n", "ms", "blend", "rasterise", "bounds", "trace",
               "frame", "times as fast as the faster Embree: median (range)");
    print("Embree, refit", refit.stages(), fmt::format("rays by {}", refit.call()));
    print("Embree, rebuild", rebuild.stages(), fmt::format("rays by {}", rebuild.call()));
    for (const OurFrame& frame : ours)
      print(frame.name(), frame.stages(), times_as_fast(refit, rebuild, frame.stages()));
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  using namespace lodestone::test;
  ChartsChoice choice;
  choice.scenes = {"ict_face_sparse.glb", "ict_face_dense16.glb"};
  choice.budgets = {1};
  CLI::App app("Whole frames of an animation beside Embree", "frame_bench");
  choice.add_options(app);
  return bench_main(app, argc, argv, [&] {
    for (const std::string& name : choice.scenes) bench(name, choice);
  });
}
